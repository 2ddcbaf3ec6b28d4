// Parts of surfaces, and where rays leave them.
#include "tracer/render/surface.h"

#include <bit>
#include <cmath>

namespace tracer {

namespace {

// The next larger number, as std::nextafter, which is a call; infinity and NaN stay.
float next_up(float x) {
  if (!std::isfinite(x)) return x;
  const auto bits = std::bit_cast<int32_t>(x + 0.0f);  // -0 becomes 0
  return std::bit_cast<float>(bits + (bits >= 0 ? 1 : -1));
}

vec3 weights(const Hit& hit) {
  return {1.0f - hit.u - hit.v, hit.u, hit.v};
}

const Mesh& mesh_of(const Scene& scene, const Hit& hit) {
  return scene.meshes[scene.instances[hit.instance].mesh];
}

bool is_textured(const Scene& scene, const Material& material) {
  return material.use_texture && material.texture < scene.textures.size();
}

}  // namespace

void prefetch_indices(const Scene& scene, const Hit& hit) {
  const Mesh& mesh = mesh_of(scene, hit);
  __builtin_prefetch(&mesh.triangles[hit.triangle]);
  __builtin_prefetch(&mesh.materials[hit.triangle]);
}

void prefetch_corners(const Scene& scene, const Hit& hit) {
  const Mesh& mesh = mesh_of(scene, hit);
  const uvec3& corners = mesh.triangles[hit.triangle];
  for (int i = 0; i < 3; ++i) {
    __builtin_prefetch(&mesh.positions[corners[i]]);
    __builtin_prefetch(&mesh.normals[corners[i]]);
    if (!mesh.uvs.empty()) __builtin_prefetch(&mesh.uvs[corners[i]]);
  }
}

uint32_t material_at(const Scene& scene, const Hit& hit) {
  const uint32_t replaced = scene.instances[hit.instance].material;
  return replaced != none ? replaced : mesh_of(scene, hit).materials[hit.triangle];
}

vec2 uv_at(const Scene& scene, const Hit& hit) {
  const Mesh& mesh = mesh_of(scene, hit);
  if (mesh.uvs.empty()) return vec2(0.0f);
  const uvec3 corners = mesh.triangles[hit.triangle];
  const vec3 weight = weights(hit);
  return weight.x * mesh.uvs[corners.x] + weight.y * mesh.uvs[corners.y] +
         weight.z * mesh.uvs[corners.z];
}

vec3 spawn_point(const Surface& surface, const vec3& direction) {
  const float distance = glm::dot(glm::abs(surface.geometric_normal), surface.position_error);
  const float side = glm::dot(direction, surface.geometric_normal) >= 0.0f ? 1.0f : -1.0f;
  const vec3 offset = side * distance * surface.geometric_normal;
  vec3 origin = surface.position + offset;
  // Rounded away from the surface.
  for (int axis = 0; axis < 3; ++axis) {
    if (offset[axis] > 0.0f) origin[axis] = next_up(origin[axis]);
    if (offset[axis] < 0.0f) origin[axis] = -next_up(-origin[axis]);
  }
  return origin;
}

vec3 albedo_at(const Scene& scene, const Material& material, vec2 uv) {
  return albedo_at(scene, material, fetch_albedo(scene, material, uv));
}

TexturePlace fetch_albedo(const Scene& scene, const Material& material, vec2 uv) {
  return is_textured(scene, material) ? fetch(scene.textures[material.texture], uv)
                                      : TexturePlace();
}

vec3 albedo_at(const Scene& scene, const Material& material, const TexturePlace& place) {
  if (!is_textured(scene, material)) return material.albedo;
  return material.albedo * sample_fetched(scene.textures[material.texture], place);
}

}  // namespace tracer
