// A scene in Embree: one Embree scene a mesh and an instance each; what stands where it was
// modelled goes into the top scene directly.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#if BVHSCOPE_EMBREE == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "tracer/bvh/scene_bvh.h"
#include "tracer/math/ray.h"

namespace app {

RTCRay embree_ray(const tracer::Ray& ray);

class EmbreeScene {
 public:
  // The instances are posed as in `instances`; nothing of what is passed in is kept.
  EmbreeScene(const tracer::Scene& scene, std::span<const tracer::PlacedInstance> instances,
              bool robust = true, RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  // Builds the trees of all meshes again, from scratch.
  void rebuild();

  // One ray; the instance's and triangle's number are those of our scene.
  tracer::Hit intersect(const tracer::Ray& ray) const;
  bool occluded(const tracer::Ray& ray) const;

  bool has_instances() const;  // that did not go into the top scene directly
  RTCScene top() const { return top_; }
  uint64_t bytes() const { return uint64_t(*bytes_); }  // that Embree holds for it

 private:
  RTCScene new_scene(bool robust) const;
  RTCGeometry new_geometry(const tracer::Mesh& mesh) const;
  void attach(RTCGeometry geometry, RTCScene scene, unsigned id);

  // Embree calls back until the device is gone.
  std::unique_ptr<std::atomic<int64_t>> bytes_;
  RTCDevice device_;
  RTCBuildQuality quality_;
  RTCScene top_;
  std::vector<RTCScene> bottoms_;        // of meshes that are instanced
  std::vector<RTCGeometry> geometries_;  // of triangles
  bool top_has_triangles_ = false;
};

}  // namespace app
