// The surface at a hit, with bounds for its rounding errors.
#include "tracer/render/surface.h"

#include <bit>
#include <cmath>

#include "tracer/math/columns.h"
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

vec3 weights(const Hit& hit) {
  return {1.0f - hit.u - hit.v, hit.u, hit.v};
}

const Mesh& mesh_of(const Scene& scene, const Hit& hit) {
  return scene.meshes[scene.instances[hit.instance].mesh];
}

float4 cross(float4 a, float4 b) {
  const auto yzx = [](float4 v) { return __builtin_shufflevector(v, v, 1, 2, 0, 3); };
  return yzx(a * yzx(b) - yzx(a) * b);
}

float max_of_three(float4 v) {
  return std::max(std::max(v[0], v[1]), v[2]);
}

vec3 geometric_normal(float4 a, float4 b, float4 c, const Columns& normal_to_world) {
  const float4 to_b = b - a;
  const float4 to_c = c - a;
  const float4 scale = broadcast(1.0f / max_of_three(max(abs(to_b), abs(to_c))));
  vec3 normal = xyz(cross(to_b * scale, to_c * scale));
  const vec3 up(0, 1, 0);  // of a triangle without area
  const bool is_sliver = !(glm::dot(normal, normal) > 1e-12f);
  if (is_sliver) normal = safe_normalize(normal, up);
  return safe_normalize(xyz(normal_to_world.turned(load3(normal))), up);
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

vec3 geometric_normal_at(const Scene& scene, const SceneBvh& bvh, const Hit& hit) {
  const Mesh& mesh = mesh_of(scene, hit);
  const uvec3 corners = mesh.triangles[hit.triangle];
  return geometric_normal(load3(mesh.positions[corners.x]), load3(mesh.positions[corners.y]),
                          load3(mesh.positions[corners.z]),
                          columns(bvh.instances[hit.instance].normal_to_world));
}

Surface surface_at(const Scene& scene, const SceneBvh& bvh, const vec3& direction, const Hit& hit) {
  const PlacedInstance& placed = bvh.instances[hit.instance];
  const Mesh& mesh = mesh_of(scene, hit);
  const uvec3 corners = mesh.triangles[hit.triangle];
  const float4 a = load3(mesh.positions[corners.x]);
  const float4 b = load3(mesh.positions[corners.y]);
  const float4 c = load3(mesh.positions[corners.z]);

  Surface surface;
  surface.triangle = hit.triangle;
  surface.instance = hit.instance;
  surface.barycentric = weights(hit);
  const float4 of_a = broadcast(surface.barycentric.x);
  const float4 of_b = broadcast(surface.barycentric.y);
  const float4 of_c = broadcast(surface.barycentric.z);
  surface.material = material_at(scene, hit);
  surface.uv = uv_at(scene, hit);

  const Columns to_world = columns(placed.to_world);
  const float4 object = of_a * a + of_b * b + of_c * c;
  surface.position = xyz(to_world.moved(object));

  // Of the interpolation, and of the test that a new ray from here makes against this triangle, in
  // object space ...
  const float4 sum = abs(of_a * a) + abs(of_b * b) + abs(of_c * c);
  const float size = max_of_three(max(abs(b - a), abs(c - a)));
  const Columns abs_to_world = to_world.absolute();
  const float4 world_sum = abs_to_world.moved(abs(object));
  const float4 back_sum = columns(placed.to_object).absolute().moved(world_sum);
  const float4 object_error =
      broadcast(gamma(8)) * sum + broadcast(gamma(16) * size) + broadcast(gamma(6)) * back_sum;
  // ... and of the way to the world (the way back is in object_error).
  surface.position_error = xyz(abs_to_world.turned(object_error) + broadcast(gamma(6)) * world_sum);

  const Columns normal_to_world = columns(placed.normal_to_world);
  surface.geometric_normal = geometric_normal(a, b, c, normal_to_world);
  const float4 normal = of_a * load3(mesh.normals[corners.x]) +
                        of_b * load3(mesh.normals[corners.y]) +
                        of_c * load3(mesh.normals[corners.z]);
  surface.shading_normal =
      safe_normalize(xyz(normal_to_world.turned(normal)), surface.geometric_normal);
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
