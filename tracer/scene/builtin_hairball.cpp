// Thin curved hairs that grow from a sphere. The idea is S. Laine's "hairball" test scene.
#include "tracer/math/rng.h"
#include "tracer/scene/builtin_makers.h"
#include "tracer/scene/builtin_parts.h"

namespace tracer {
namespace {

constexpr uint32_t sides = 3;  // of a hair's cross-section
constexpr float scalp_radius = 0.35f;

// Ring `ring` of a hair: one corner more than sides, since the last is the first with another u.
void write_ring(Mesh& mesh, size_t corner, vec3 center, vec3 x, vec3 y, float radius, float v) {
  for (uint32_t side = 0; side <= sides; side++) {
    const float angle = 2.0f * pi * static_cast<float>(side % sides) / static_cast<float>(sides);
    const vec3 out = std::cos(angle) * x + std::sin(angle) * y;
    mesh.positions[corner + side] = center + radius * out;
    mesh.normals[corner + side] = glm::normalize(out);
    mesh.uvs[corner + side] = {static_cast<float>(side) / static_cast<float>(sides), v};
  }
}

// A random walk that keeps turning about an axis of its own, so that each hair curls.
void write_hair(Mesh& mesh, size_t hair, size_t first_corner, uint32_t segments, uint64_t seed) {
  Rng rng = make_rng(seed, hair);
  vec3 direction = direction_on_sphere(rng);
  vec3 point = scalp_radius * direction;
  const vec3 axis = direction_on_sphere(rng);
  const float length = uniform(rng, 0.9f, 1.6f);
  const float curl = uniform(rng, 1.0f, 4.0f);
  const float step = length / static_cast<float>(segments);
  const vec3 helper = std::abs(direction.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0);
  vec3 side = glm::normalize(glm::cross(direction, helper));

  const size_t hair_corners = (segments + 1) * (sides + 1);
  size_t corner = first_corner + hair * hair_corners;
  for (uint32_t ring = 0; ring <= segments; ring++) {
    const float along = static_cast<float>(ring) / static_cast<float>(segments);
    // The frame is carried along, so that the tube does not twist.
    side = glm::normalize(side - glm::dot(side, direction) * direction);
    write_ring(mesh, corner, point, side, glm::cross(direction, side),
               0.004f * (1.0f - 0.8f * along), along);
    corner += sides + 1;
    point += step * direction;
    const vec3 jitter = 0.35f * std::sqrt(step) * direction_on_sphere(rng);
    const vec3 inwards = -0.6f * step * point;  // keeps the ball together
    direction =
        glm::normalize(direction + curl * step * glm::cross(axis, direction) + jitter + inwards);
  }
}

}  // namespace

Scene make_hairball(std::span<const double> values, const Job& job) {
  const auto strands = static_cast<size_t>(values[0]);
  const auto segments = static_cast<uint32_t>(values[1]);
  const auto seed = static_cast<uint64_t>(values[2]);
  Scene scene;
  add_daylight(scene);
  const uint32_t scalp = add_matt(scene, "scalp", {0.30f, 0.16f, 0.10f});
  const uint32_t first_hair = add_matt(scene, "chestnut hair", {0.42f, 0.20f, 0.09f});
  add_matt(scene, "auburn hair", {0.52f, 0.25f, 0.10f});
  add_matt(scene, "dark hair", {0.22f, 0.11f, 0.06f});
  add_matt(scene, "golden hair", {0.66f, 0.42f, 0.18f});
  constexpr uint32_t hair_materials = 4;

  Mesh& mesh = scene.meshes.emplace_back();
  mesh.name = "hairball";
  Mesh ball = make_sphere(48, 24);
  mat4 shrink(scalp_radius);
  shrink[3][3] = 1.0f;
  append(mesh, ball, shrink, scalp);

  const size_t first_corner = mesh.positions.size();
  const size_t first_triangle = mesh.triangles.size();
  const size_t ring_corners = sides + 1;
  const size_t hair_corners = (segments + 1) * ring_corners;
  const size_t hair_triangles = static_cast<size_t>(segments) * sides * 2;
  mesh.positions.resize(first_corner + strands * hair_corners);
  mesh.normals.resize(mesh.positions.size());
  mesh.uvs.resize(mesh.positions.size());
  mesh.triangles.resize(first_triangle + strands * hair_triangles);
  mesh.materials.resize(mesh.triangles.size());
  fill_in_parallel(strands, job, 0.0f, 1.0f, "growing hair", [&](size_t first, size_t last) {
    for (size_t hair = first; hair < last; hair++) {
      write_hair(mesh, hair, first_corner, segments, seed);
      const uint32_t material = first_hair + hash(static_cast<uint32_t>(hair)) % hair_materials;
      size_t triangle = first_triangle + hair * hair_triangles;
      for (uint32_t segment = 0; segment < segments; segment++) {
        for (uint32_t side = 0; side < sides; side++) {
          const size_t here = first_corner + hair * hair_corners + segment * ring_corners + side;
          const size_t next_ring = here + ring_corners;
          mesh.materials[triangle] = material;
          mesh.triangles[triangle++] = uvec3(here, here + 1, next_ring);
          mesh.materials[triangle] = material;
          mesh.triangles[triangle++] = uvec3(here + 1, next_ring + 1, next_ring);
        }
      }
    }
  });

  add_instance(scene);
  scene.lights.push_back({"lamp", {2.5f, 4.5f, 4.0f}, {1.0f, 0.95f, 0.88f}, 42.0f, true});
  scene.ambient = vec3(0.3f, 0.31f, 0.35f);
  scene.camera.eye = {0.0f, 0.6f, 4.2f};
  scene.camera.target = vec3(0.0f);
  scene.camera.fov_degrees = 40.0f;
  return scene;
}

}  // namespace tracer
