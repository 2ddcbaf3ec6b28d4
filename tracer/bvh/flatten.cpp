// All instances of a scene as one mesh in the world.
#include "tracer/bvh/flatten.h"

#include <fmt/format.h>

#include "tracer/error.h"

namespace tracer {
namespace {

void check_size(const Scene& scene) {
  uint64_t triangles = 0, corners = 0;
  for (const Instance& instance : scene.instances) {
    triangles += scene.meshes[instance.mesh].triangles.size();
    corners += scene.meshes[instance.mesh].positions.size();
  }
  if (triangles <= max_flattened_triangles && corners < none) return;
  throw Error(fmt::format("{}: {} triangles as placed; at most {} can become one mesh", scene.name,
                          triangles, max_flattened_triangles));
}

vec3 unit(const vec3& normal) {
  const float length = glm::length(normal);
  return length > 0.0f ? normal / length : vec3(0.0f, 1.0f, 0.0f);
}

// Object space keeps its winding: a mirroring transform turns the faces, as it does when traced.
void append(Mesh& all, const Mesh& mesh, const Instance& instance, const PlacedInstance& placed,
            bool with_uvs) {
  const auto first = static_cast<uint32_t>(all.positions.size());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    all.positions.emplace_back(placed.to_world * vec4(mesh.positions[i], 1.0f));
    all.normals.push_back(unit(placed.normal_to_world * mesh.normals[i]));
    if (with_uvs) all.uvs.push_back(mesh.uvs.empty() ? vec2(0.0f) : mesh.uvs[i]);
  }
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    all.triangles.push_back(mesh.triangles[i] + first);
    all.materials.push_back(instance.material == none ? mesh.materials[i] : instance.material);
  }
}

}  // namespace

Scene flattened(const Scene& scene, std::span<const PlacedInstance> instances) {
  check_size(scene);
  Scene flat = scene;
  flat.meshes.assign(1, {});
  flat.meshes[0].name = scene.name;
  flat.instances.assign(1, {});
  flat.instances[0].name = scene.name;
  bool with_uvs = false;
  for (const Mesh& mesh : scene.meshes)
    with_uvs |= !mesh.uvs.empty();
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    append(flat.meshes[0], scene.meshes[instance.mesh], instance, instances[i], with_uvs);
  }
  return flat;
}

}  // namespace tracer
