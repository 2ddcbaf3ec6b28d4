// The rays that a benchmark traces: by class, and from two views, the scene's own camera and one
// inside the scene.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tracer/bvh/scene_bvh.h"
#include "tracer/math/ray.h"

namespace tracer {

// Where rays start from: primary rays of a view, and what they hit.
struct RayStart {
  const Scene& scene;
  const SceneBvh& bvh;
  std::span<const Light> lights;
  std::span<const Ray> primary;  // tiles of 8 x 8 pixels
  std::span<const Hit> hits;     // of these
  Box bounds;
};

struct RaySetRow {
  std::string_view id, label, help;
  bool any_hit = false;   // asks only whether something is hit
  bool coherent = false;  // neighbours in the set begin and go alike
  bool of_view = true;    // else of the scene as a whole
  std::vector<Ray> (*make)(const RayStart& start) = nullptr;
};
std::span<const RaySetRow> ray_set_rows();

struct RaySet {
  std::string id;    // of the row, or "file"
  std::string view;  // "camera", "inside"; "" where there is none
  bool any_hit = false, coherent = false;
  std::vector<Ray> rays;
};

struct RaySetOptions {
  Camera camera;
  int width = 1280, height = 720;    // pixels of both views
  std::vector<std::string> classes;  // ids of RaySetRows; none: all
};

// In the order of the rows, the camera's view first; sets without rays are left out. The same for
// any number of threads, builder and layout. Stopped: those that are done.
std::vector<RaySet> make_ray_sets(const Scene& scene, const SceneBvh& bvh,
                                  std::span<const Light> lights, const RaySetOptions& options,
                                  const std::stop_token& stop);

// In the middle of the scene, looking where most is hit (the camera's direction, else along an
// axis), 90 degrees wide.
Camera inside_camera(const SceneBvh& bvh, const Camera& camera);

// Rays with finite numbers and a direction; others are left out and counted.
struct RayFile {
  std::vector<Ray> rays;
  uint64_t left_out = 0;
};
inline constexpr uint64_t max_file_rays = 50'000'000;

// Little-endian floats, eight a ray: origin, t_min, direction of any length, t_max. A negative
// t_min counts as 0. Throws Error for what is not such a file.
RayFile read_rays(const std::filesystem::path& file);

}  // namespace tracer
