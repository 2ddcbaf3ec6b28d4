// Long thin triangles that cross everywhere.
#include "tracer/math/rng.h"
#include "tracer/scene/builtin_makers.h"
#include "tracer/scene/builtin_parts.h"

namespace tracer {

Scene make_needles(std::span<const double> values, const Job& job) {
  const auto count = static_cast<size_t>(values[0]);
  const auto seed = static_cast<uint64_t>(values[1]);
  Scene scene;
  add_daylight(scene);
  add_palette(scene);

  Mesh& mesh = scene.meshes.emplace_back();
  mesh.name = "needles";
  mesh.positions.resize(3 * count);
  mesh.normals.resize(3 * count);
  mesh.triangles.resize(count);
  mesh.materials.resize(count);
  fill_in_parallel(count, job, 0.0f, 1.0f, "making needles", [&](size_t first, size_t last) {
    for (size_t i = first; i < last; i++) {
      Rng rng = make_rng(seed, i);
      const vec3 middle = std::cbrt(uniform(rng)) * direction_on_sphere(rng);
      const vec3 along = direction_on_sphere(rng);
      const vec3 helper = std::abs(along.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0);
      const vec3 across = glm::normalize(glm::cross(along, helper));
      const vec3 half = uniform(rng, 0.1f, 0.5f) * along;
      const vec3 width = uniform(rng, 0.001f, 0.004f) * across;
      const size_t corner = 3 * i;
      mesh.positions[corner] = middle - half - width;
      mesh.positions[corner + 1] = middle - half + width;
      mesh.positions[corner + 2] = middle + half;
      const vec3 normal = glm::normalize(glm::cross(across, along));
      for (size_t k = 0; k < 3; k++)
        mesh.normals[corner + k] = normal;
      mesh.triangles[i] = uvec3(corner, corner + 1, corner + 2);
      mesh.materials[i] = next(rng) % palette_size;
    }
  });

  add_instance(scene);
  scene.lights.push_back({"lamp", {2.0f, 4.0f, 3.0f}, {1.0f, 0.95f, 0.88f}, 28.0f, true});
  scene.ambient = vec3(0.2f, 0.21f, 0.25f);
  scene.camera.eye = {0.0f, 0.7f, 3.9f};
  scene.camera.target = vec3(0.0f);
  scene.camera.fov_degrees = 40.0f;
  return scene;
}

}  // namespace tracer
