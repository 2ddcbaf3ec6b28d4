// Instances of one long stick that stand askew and cross each other's boxes.
#include <cmath>

#include "tracer/math/rng.h"
#include "tracer/scene/builtin_makers.h"
#include "tracer/scene/builtin_parts.h"

namespace tracer {
namespace {

// Along the y axis from -1 to 1, thickest in the middle.
Mesh make_stick(uint32_t rings) {
  constexpr float thickness = 0.015f;  // of its length
  Mesh mesh = make_sphere(8, rings);
  mesh.name = "stick";
  for (vec3& position : mesh.positions)
    position *= vec3(2.0f * thickness, 1.0f, 2.0f * thickness);
  for (vec3& normal : mesh.normals)
    normal = glm::normalize(normal * vec3(1.0f, 2.0f * thickness, 1.0f));
  return mesh;
}

}  // namespace

Scene make_sticks(std::span<const double> values, const Job& job) {
  const auto count = static_cast<size_t>(values[0]);
  const auto rings = static_cast<uint32_t>(values[1]);
  const auto seed = static_cast<uint64_t>(values[2]);
  Scene scene;
  add_daylight(scene);
  add_palette(scene);
  scene.meshes.push_back(make_stick(rings));
  scene.instances.resize(count);
  fill_in_parallel(count, job, 0.0f, 1.0f, "placing sticks", [&](size_t first, size_t last) {
    for (size_t i = first; i < last; i++) {
      Rng rng = make_rng(seed, i);
      Instance& instance = scene.instances[i];
      instance.name = "stick " + std::to_string(i + 1);
      const vec3 middle = std::cbrt(uniform(rng)) * direction_on_sphere(rng);
      const vec3 along = direction_on_sphere(rng);
      const float turned = uniform(rng, 0.0f, 2.0f * pi);
      instance.transform = standing_on(middle, along, turned, uniform(rng, 0.5f, 1.0f));
      instance.material = next(rng) % palette_size;
      instance.motion.spin = uniform(rng, -1.0f, 1.0f);
    }
  });

  scene.lights.push_back({"lamp", {2.0f, 4.0f, 3.0f}, {1.0f, 0.95f, 0.88f}, 28.0f, true});
  scene.ambient = vec3(0.2f, 0.21f, 0.25f);
  scene.camera.eye = {0.0f, 0.9f, 4.9f};
  scene.camera.target = vec3(0.0f);
  scene.camera.fov_degrees = 40.0f;
  return scene;
}

}  // namespace tracer
