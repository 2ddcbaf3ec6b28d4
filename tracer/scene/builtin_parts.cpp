// What several built-in scenes are put together from.
#include "tracer/scene/builtin_parts.h"

#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "tracer/error.h"
#include "tracer/scene/builtin.h"
#include "tracer/scene/load_image.h"

namespace tracer {

uint32_t add_asset_texture(Scene& scene, std::string_view file) {
  try {
    scene.textures.push_back(load_texture(asset_path(file)));
  } catch (const Error& error) {
    scene.warnings.push_back(fmt::format("{}; shown without this texture", error.what()));
    return none;
  }
  return static_cast<uint32_t>(scene.textures.size() - 1);
}

void add_daylight(Scene& scene) {
  try {
    scene.sky_image = load_sky(asset_path("sky.hdr"));
  } catch (const Error& error) {
    scene.warnings.push_back(fmt::format("{}; the sky is one flat colour", error.what()));
  }
}

uint32_t add_material(Scene& scene, const Material& material) {
  scene.materials.push_back(material);
  return static_cast<uint32_t>(scene.materials.size() - 1);
}

uint32_t add_matt(Scene& scene, const char* name, vec3 albedo) {
  Material material;
  material.name = name;
  material.albedo = albedo;
  return add_material(scene, material);
}

uint32_t add_bricks(Scene& scene) {
  Material brick;
  brick.name = "brick";
  brick.texture = add_asset_texture(scene, "bricks.png");
  brick.albedo = brick.texture == none ? vec3(0.5f) : vec3(1.0f);
  return add_material(scene, brick);
}

uint32_t add_mirror(Scene& scene) {
  Material mirror;
  mirror.name = "mirror";
  mirror.reflectivity = 1.0f;
  mirror.specular = vec3(0.95f);
  return add_material(scene, mirror);
}

void add_instance(Scene& scene) {
  Instance instance;
  instance.name = scene.meshes.back().name;
  instance.mesh = static_cast<uint32_t>(scene.meshes.size() - 1);
  scene.instances.push_back(instance);
}

uint32_t add_palette(Scene& scene) {
  const auto first = static_cast<uint32_t>(scene.materials.size());
  const auto add = [&](const char* name, vec3 albedo) {
    Material material;
    material.name = name;
    material.albedo = albedo;
    scene.materials.push_back(material);
  };
  add("brick red", {0.55f, 0.13f, 0.08f});
  add("orange", {0.80f, 0.36f, 0.08f});
  add("sand", {0.75f, 0.60f, 0.33f});
  add("leaf green", {0.20f, 0.42f, 0.12f});
  add("teal", {0.06f, 0.40f, 0.38f});
  add("blue", {0.09f, 0.22f, 0.55f});
  add("plum", {0.36f, 0.12f, 0.36f});
  add("chalk", {0.78f, 0.76f, 0.72f});
  return first;
}

Mesh make_sphere(uint32_t columns, uint32_t rows) {
  Mesh mesh;
  mesh.name = "sphere";
  for (uint32_t row = 0; row <= rows; row++) {
    const float v = static_cast<float>(row) / static_cast<float>(rows);
    const bool pole = row == 0 || row == rows;
    const float radius = pole ? 0.0f : std::sin(pi * v);
    const float y = row == 0 ? 1.0f : row == rows ? -1.0f : std::cos(pi * v);
    for (uint32_t column = 0; column <= columns; column++) {
      // The last column is the first one again, to the bit.
      const float u = static_cast<float>(column) / static_cast<float>(columns);
      const float angle = column == columns ? 0.0f : 2.0f * pi * u;
      const vec3 point(radius * std::cos(angle), y, -radius * std::sin(angle) + 0.0f);
      mesh.positions.push_back(point);
      mesh.normals.push_back(glm::normalize(point));
      mesh.uvs.emplace_back(u, 1.0f - v);
    }
  }
  for (uint32_t row = 0; row < rows; row++) {
    for (uint32_t column = 0; column < columns; column++) {
      const uint32_t here = row * (columns + 1) + column;
      const uint32_t below = here + columns + 1;
      if (row > 0) mesh.triangles.emplace_back(here, below, here + 1);
      if (row < rows - 1) mesh.triangles.emplace_back(here + 1, below, below + 1);
    }
  }
  mesh.materials.assign(mesh.triangles.size(), 0);
  return mesh;
}

void add_flat_triangle(Mesh& mesh, vec3 a, vec3 b, vec3 c, uint32_t material) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  const vec3 normal = glm::normalize(glm::cross(b - a, c - a));
  mesh.positions.insert(mesh.positions.end(), {a, b, c});
  mesh.normals.insert(mesh.normals.end(), {normal, normal, normal});
  mesh.uvs.insert(mesh.uvs.end(), {{0, 0}, {1, 0}, {0, 1}});
  mesh.triangles.emplace_back(first, first + 1, first + 2);
  mesh.materials.push_back(material);
}

void add_flat_quad(Mesh& mesh, vec3 a, vec3 b, vec3 c, vec3 d, uint32_t material) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  const vec3 normal = glm::normalize(glm::cross(c - a, d - b));
  mesh.positions.insert(mesh.positions.end(), {a, b, c, d});
  mesh.normals.insert(mesh.normals.end(), {normal, normal, normal, normal});
  mesh.uvs.insert(mesh.uvs.end(), {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  mesh.triangles.emplace_back(first, first + 1, first + 2);
  mesh.triangles.emplace_back(first, first + 2, first + 3);
  mesh.materials.insert(mesh.materials.end(), 2, material);
}

mat4 standing_on(vec3 point, vec3 normal, float turned, float size) {
  const vec3 helper = std::abs(normal.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0);
  const vec3 side = glm::normalize(glm::cross(helper, normal));
  const mat4 upright(vec4(side, 0), vec4(normal, 0), vec4(glm::cross(side, normal), 0),
                     vec4(point, 1));
  return upright * glm::rotate(mat4(1.0f), turned, vec3(0, 1, 0)) *
         glm::scale(mat4(1.0f), vec3(size));
}

void append(Mesh& mesh, const Mesh& part, const mat4& rigid_and_scale, uint32_t material) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  const mat3 linear(rigid_and_scale);
  for (const vec3& point : part.positions) {
    mesh.positions.emplace_back(rigid_and_scale * vec4(point, 1.0f));
  }
  for (const vec3& normal : part.normals)
    mesh.normals.push_back(glm::normalize(linear * normal));
  mesh.uvs.insert(mesh.uvs.end(), part.uvs.begin(), part.uvs.end());
  for (const uvec3& triangle : part.triangles)
    mesh.triangles.push_back(triangle + first);
  mesh.materials.insert(mesh.materials.end(), part.triangles.size(), material);
}

void fill_in_parallel(size_t count, const Job& job, float begin, float end, std::string_view what,
                      const std::function<void(size_t first, size_t last)>& fill) {
  constexpr size_t portions = 100;
  for (size_t portion = 0; portion < portions; portion++) {
    if (job.stopped()) throw Error(fmt::format("{}: stopped", what));
    const size_t first = count * portion / portions;
    const size_t last = count * (portion + 1) / portions;
    if (first == last) continue;
    tbb::parallel_for(
        tbb::blocked_range<size_t>(first, last),
        [&](const tbb::blocked_range<size_t>& items) { fill(items.begin(), items.end()); });
    const float done = static_cast<float>(portion + 1) / static_cast<float>(portions);
    job.progress(begin + (end - begin) * done, what);
  }
}

}  // namespace tracer
