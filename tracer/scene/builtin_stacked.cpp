// What no split can separate: copies of one triangle (left), and triangles of different sizes whose
// boxes have the same centre to the bit (right).
#include <cmath>

#include "tracer/scene/builtin_makers.h"
#include "tracer/scene/builtin_parts.h"

namespace tracer {

Scene make_stacked(std::span<const double> values, const Job& job) {
  const auto copies = static_cast<uint32_t>(values[0]);
  const auto concentric = static_cast<uint32_t>(values[1]);
  Scene scene;
  add_daylight(scene);
  add_palette(scene);

  Mesh& mesh = scene.meshes.emplace_back();
  mesh.name = "stacked triangles";
  for (uint32_t i = 0; i < copies; i++) {
    add_flat_triangle(mesh, {-3, -1, 0}, {-1, -1, 0}, {-2, 1, 0}, i % palette_size);
  }
  job.progress(0.5f, "stacking triangles");
  // A fan about the y axis: corners at (-p, -s), (p, -s) and (0, s) have a box around the origin.
  for (uint32_t i = 0; i < concentric; i++) {
    const float part = static_cast<float>(i) / static_cast<float>(concentric);
    const float size = 1.4f - 1.2f * part;
    const float angle = pi * part;
    const float x = size * std::cos(angle), z = size * std::sin(angle);
    add_flat_triangle(mesh, {-x, -size, -z}, {x, -size, z}, {0, size, 0}, i % palette_size);
  }

  add_instance(scene);
  scene.lights.push_back({"lamp", {1.0f, 4.0f, 5.0f}, {1.0f, 0.96f, 0.9f}, 32.0f, true});
  scene.ambient = vec3(0.25f);
  scene.camera.eye = {0.2f, 1.6f, 6.6f};
  scene.camera.target = {-0.85f, -0.05f, 0.0f};
  scene.camera.fov_degrees = 36.0f;
  return scene;
}

}  // namespace tracer
