// Whitted-style ray tracing (T. Whitted, An Improved Illumination Model for Shaded Display, 1980):
// direct light from points, recursive mirrors and glass, a sky where nothing is hit.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "tracer/bvh/counters.h"
#include "tracer/bvh/probe.h"
#include "tracer/bvh/scene_bvh.h"
#include "tracer/render/surface.h"
#include "tracer/settings.h"
#include "tracer/untouched.h"

namespace tracer {

// Everything that light transport reads. The referenced objects outlive it.
struct World {
  const Scene& scene;
  const SceneBvh& bvh;
  const Look& look;
  const RenderOptions& options;
};

// How many rays of a class were cast, and how long that took one thread, without shading.
struct RayRate {
  uint64_t rays = 0;
  double seconds = 0.0;
  uint64_t in_packets = 0;  // of the rays
  uint64_t in_streams = 0;  // the others were traced one by one

  RayRate& operator+=(const RayRate& other) {
    rays += other.rays;
    seconds += other.seconds;
    in_packets += other.in_packets;
    in_streams += other.in_streams;
    return *this;
  }
};
using RayRates = std::array<RayRate, ray_class_count>;  // by RayClass

// The kernel that the options name for rays of a class; automatic_kernel where the layout lacks it.
std::string_view kernel_of(const RenderOptions& options, std::string_view layout,
                           RayClass ray_class);

// Which of two kernels is the faster one for rays that are not alike, by what they took so far.
class KernelChoice {
 public:
  // "single" or "stream". The slower one gets a turn now and then.
  std::string_view next(size_t rays);
  void took(std::string_view kernel, size_t rays, double seconds);

 private:
  static constexpr size_t few_ = 64;  // rays, which a stream is hardly filled by
  struct Taken {
    double rays = 0.0, seconds = 0.0;
  };
  Taken single_, stream_;
  uint32_t turns_ = 0;
};

// How often each node was entered, by RayClass.
using ClassVisits = std::array<Visits, ray_class_count>;

// A ray of a sample, and the one it was cast from.
struct CastRay {
  Ray ray;
  RayClass ray_class = RayClass::primary;
  uint32_t sample = 0;
  uint32_t parent = none;  // index; of a primary ray: none
  int bounce = 0;          // a shadow ray has that of the ray whose hit it lights
  Hit hit;                 // of a shadow ray: what it met first
};

// Traces a batch of points of the image, bounce by bounce: all rays of one class and bounce, then
// their shading, which casts the next ones. Owned by one thread; its buffers are used again.
class Whitted {
 public:
  Whitted();

  // One sample for each point, in pixels. `counting` fills counters, and costs time; without it
  // counters() is empty and rates() grows.
  void trace(const World& world, const CameraFrame& camera, std::span<const vec2> points,
             bool counting);

  // The same rays, counting the nodes they enter; visits have a place for each node.
  void trace_visits(const World& world, const CameraFrame& camera, std::span<const vec2> points,
                    ClassVisits& visits);

  // The same rays, watching for one node; sets bit RayClass of a sample when such a ray enters it.
  void trace_watching(const World& world, const CameraFrame& camera, std::span<const vec2> points,
                      const Watched& node, std::span<uint8_t> entered);

  // The same rays, one by one; a ray comes after the one it was cast from.
  std::vector<CastRay> trace_rays(const World& world, const CameraFrame& camera,
                                  std::span<const vec2> points);

  std::span<const Hit> hits() const { return hits_; }  // of the primary rays
  std::span<const vec3> radiance() const { return radiance_; }
  std::span<const ClassCounters> counters() const { return counters_; }
  std::span<const uint8_t> depth() const { return depth_; }  // bounces of the deepest ray
  const RayRates& rates() const { return rates_; }           // since it was made

 private:
  // What a ray is traced for: `weight` of what it finds goes to a sample.
  struct Path {
    vec3 weight;
    uint32_t sample;
  };

  // A hit that is to be shaded.
  struct Shaded {
    const Path& path;
    const vec3& direction;  // of the ray
    uint32_t serial;        // of its CastRay, if those are kept
    const Surface& surface;
    const TexturePlace& texture;  // of its material
  };

  // Rays of one class, side by side for a kernel, and a path for each.
  struct Batch {
    RayClass ray_class = RayClass::shadow;
    UntouchedVector<Ray> rays;
    UntouchedVector<Path> paths;
    UntouchedVector<Hit> hits;
    std::vector<uint8_t> blocked;   // of shadow rays
    std::vector<uint32_t> serials;  // indices of their CastRays, if those are kept

    void clear();
  };
  using Batches = std::array<Batch, ray_class_count>;  // by RayClass, without shadow rays

  // A tracer finds hits and records something of it; see the cpp file for those there are.
  template <class Tracer>
  void trace_bounces(const World& world, const CameraFrame& camera, std::span<const vec2> points,
                     Tracer&& tracer);
  template <class Tracer>
  void trace_shadows(const World& world, Tracer& tracer);
  void add_primary(const CameraFrame& camera, std::span<const vec2> points);
  void add(Batch& batch, const Ray& ray, const Path& path, uint32_t parent);
  void keep(Batch& batch, const Ray& ray, uint32_t sample, uint32_t parent);
  void shade_all(const World& world, const Batch& batch, int bounce);
  void shade_some(const World& world, const Batch& batch, size_t first, size_t end, int bounce);
  void add_sky(const World& world, const Batch& batch);
  void shade(const World& world, const Shaded& at, bool may_bounce);
  void add_direct_light(const World& world, const Shaded& at, const vec3& normal,
                        const vec3& diffuse);
  void enter_glass(const Shaded& at, const vec3& normal, const Material& material);
  void cast(const Shaded& from, const vec3& direction, const vec3& weight, RayClass ray_class);

  UntouchedVector<Hit> hits_;
  std::vector<vec3> radiance_;
  std::vector<ClassCounters> counters_;
  std::vector<uint8_t> depth_;
  RayRates rates_{};
  std::array<KernelChoice, ray_class_count> choices_;  // by RayClass

  Batches batches_, next_;      // of this bounce, and of the one after it
  std::vector<Batch> shadows_;  // by light: neighbours that go to the same one are alike
  static constexpr size_t shaded_at_once_ = 64;
  struct {
    std::array<Hit, shaded_at_once_> hits;
    std::array<vec3, shaded_at_once_> directions;
    std::array<Surface, shaded_at_once_> surfaces;
    std::array<TexturePlace, shaded_at_once_> textures;
  } shaded_;
  UntouchedVector<uint32_t> to_surface_, to_sky_;  // rays of a batch that hit something, or nothing
  static constexpr size_t skies_at_once_ = 256;
  struct {
    std::array<vec3, skies_at_once_> directions, radiance;
  } sky_;
  bool sees_sky_ = true;                  // or only the rays are wanted
  std::vector<CastRay>* cast_ = nullptr;  // where rays are kept, if they are
};

}  // namespace tracer
