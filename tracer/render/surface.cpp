// The surface at a hit, with bounds for its rounding errors.
#include "tracer/render/surface.h"

#include <bit>
#include <cmath>

#include "tracer/math/normalize.h"

namespace tracer {

namespace {

// n rounding errors in a row: n e / (1 - n e).
constexpr float gamma(int n) {
  constexpr float e = 0.5f * std::numeric_limits<float>::epsilon();
  return static_cast<float>(n) * e / (1.0f - static_cast<float>(n) * e);
}

// The next larger number, as std::nextafter, which is a call; infinity and NaN stay.
float next_up(float x) {
  if (!std::isfinite(x)) return x;
  const auto bits = std::bit_cast<int32_t>(x + 0.0f);  // -0 becomes 0
  return std::bit_cast<float>(bits + (bits >= 0 ? 1 : -1));
}

mat3 absolute(const mat3& m) {
  return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])};
}

vec3 weights(const Hit& hit) {
  return {1.0f - hit.u - hit.v, hit.u, hit.v};
}

const Mesh& mesh_of(const Scene& scene, const Hit& hit) {
  return scene.meshes[scene.instances[hit.instance].mesh];
}

vec3 geometric_normal(const vec3& a, const vec3& b, const vec3& c, const mat3& normal_to_world) {
  const float scale = 1.0f / max_component(glm::max(glm::abs(b - a), glm::abs(c - a)));
  const vec3 normal = glm::cross((b - a) * scale, (c - a) * scale);
  const vec3 up(0, 1, 0);  // of a triangle without area
  return safe_normalize(normal_to_world * safe_normalize(normal, up), up);
}

}  // namespace

void prefetch_indices(const Scene& scene, const Hit& hit) {
  if (!is_hit(hit)) return;
  const Mesh& mesh = mesh_of(scene, hit);
  __builtin_prefetch(&mesh.triangles[hit.triangle]);
  __builtin_prefetch(&mesh.materials[hit.triangle]);
}

void prefetch_corners(const Scene& scene, const Hit& hit) {
  if (!is_hit(hit)) return;
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

vec3 geometric_normal_at(const Scene& scene, const SceneBvh& bvh, const Hit& hit) {
  const Mesh& mesh = mesh_of(scene, hit);
  const uvec3 corners = mesh.triangles[hit.triangle];
  return geometric_normal(mesh.positions[corners.x], mesh.positions[corners.y],
                          mesh.positions[corners.z], bvh.instances[hit.instance].normal_to_world);
}

Surface surface_at(const Scene& scene, const SceneBvh& bvh, const vec3& direction, const Hit& hit) {
  const PlacedInstance& placed = bvh.instances[hit.instance];
  const Mesh& mesh = mesh_of(scene, hit);
  const uvec3 corners = mesh.triangles[hit.triangle];
  const vec3& a = mesh.positions[corners.x];
  const vec3& b = mesh.positions[corners.y];
  const vec3& c = mesh.positions[corners.z];

  Surface surface;
  surface.triangle = hit.triangle;
  surface.instance = hit.instance;
  surface.barycentric = weights(hit);
  const vec3& weight = surface.barycentric;
  surface.material = material_at(scene, hit);
  surface.uv = uv_at(scene, hit);

  const vec3 object = weight.x * a + weight.y * b + weight.z * c;
  surface.position = vec3(placed.to_world * vec4(object, 1.0f));

  // Of the interpolation, and of the test that a new ray from here makes against this triangle, in
  // object space ...
  const vec3 sum = glm::abs(weight.x * a) + glm::abs(weight.y * b) + glm::abs(weight.z * c);
  const float size = max_component(glm::max(glm::abs(b - a), glm::abs(c - a)));
  const mat3 to_world = absolute(mat3(placed.to_world));
  const mat3 to_object = absolute(mat3(placed.to_object));
  const vec3 world_sum = to_world * glm::abs(object) + glm::abs(vec3(placed.to_world[3]));
  const vec3 back_sum = to_object * world_sum + glm::abs(vec3(placed.to_object[3]));
  const vec3 object_error = gamma(8) * sum + vec3(gamma(16) * size) + gamma(6) * back_sum;
  // ... and of the way to the world (the way back is in object_error).
  surface.position_error = to_world * object_error + gamma(6) * world_sum;

  surface.geometric_normal = geometric_normal(a, b, c, placed.normal_to_world);
  const vec3 normal = weight.x * mesh.normals[corners.x] + weight.y * mesh.normals[corners.y] +
                      weight.z * mesh.normals[corners.z];
  surface.shading_normal =
      safe_normalize(placed.normal_to_world * normal, surface.geometric_normal);
  if (glm::dot(surface.shading_normal, surface.geometric_normal) < 0.0f) {
    surface.shading_normal = -surface.shading_normal;
  }
  surface.front = glm::dot(surface.geometric_normal, direction) <= 0.0f;
  return surface;
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
  if (!material.use_texture || material.texture >= scene.textures.size()) return material.albedo;
  return material.albedo * sample(scene.textures[material.texture], uv);
}

}  // namespace tracer
