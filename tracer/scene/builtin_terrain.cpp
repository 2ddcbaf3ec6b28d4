// A fractal height field with lakes.
// K. Perlin, Improving Noise, 2002; F. K. Musgrave, The Synthesis and Rendering of Eroded Fractal
// Terrains, 1989 (ridges).
#include <cmath>

#include "tracer/math/rng.h"
#include "tracer/scene/builtin_makers.h"
#include "tracer/scene/builtin_parts.h"

namespace tracer {
namespace {

constexpr float terrain_side = 20.0f;

enum TerrainMaterial : uint32_t { water, sand, grass, rock, snow };

// How many quads along x and z give the number of triangles asked for, best of the nearly square.
struct GridSize {
  uint32_t columns, rows;
};
GridSize grid_for(double triangles) {
  const double side = std::sqrt(triangles / 2.0);
  GridSize best{};
  double best_error = triangles;
  const auto most = static_cast<uint32_t>(1.25 * side + 1);
  for (auto columns = static_cast<uint32_t>(std::ceil(side)); columns <= most; columns++) {
    const double rows = std::max(1.0, std::round(triangles / (2.0 * columns)));
    const double error = std::abs(2.0 * columns * rows - triangles);
    if (error >= best_error) continue;
    best_error = error;
    best = {columns, static_cast<uint32_t>(rows)};
  }
  return best;
}

// Gradient noise, about -1..1.
float noise(vec2 point, uint32_t seed) {
  const vec2 cell = glm::floor(point);
  const vec2 f = point - cell;
  const auto x = static_cast<uint32_t>(static_cast<int32_t>(cell.x));
  const auto y = static_cast<uint32_t>(static_cast<int32_t>(cell.y));
  const auto gradient = [&](uint32_t i, uint32_t j) {
    // One of 16 directions; sines would make up most of the time.
    constexpr float table[16] = {1.0f,      0.92388f,  0.70711f, 0.38268f,  0.0f,      -0.38268f,
                                 -0.70711f, -0.92388f, -1.0f,    -0.92388f, -0.70711f, -0.38268f,
                                 0.0f,      0.38268f,  0.70711f, 0.92388f};
    const uint32_t direction = hash(x + i, hash(y + j, seed)) >> 28;
    return table[direction] * (f.x - static_cast<float>(i)) +
           table[(direction + 12) & 15] * (f.y - static_cast<float>(j));
  };
  const vec2 s = f * f * f * (f * (f * 6.0f - 15.0f) + 10.0f);
  return 1.5f * glm::mix(glm::mix(gradient(0, 0), gradient(1, 0), s.x),
                         glm::mix(gradient(0, 1), gradient(1, 1), s.x), s.y);
}

// Below the water it is flat, at height 0.
float height_at(vec2 point, uint32_t seed) {
  const float lowland = noise(0.11f * point, seed) + 0.4f * noise(0.23f * point, seed + 1);
  const float mountains = glm::smoothstep(-0.1f, 0.7f, lowland);
  float ridges = 0.0f, hills = 0.0f;
  float amplitude = 0.5f, frequency = 0.17f, crest = 1.0f;
  for (uint32_t octave = 0; octave < 9; octave++) {
    const float value = noise(frequency * point, seed + 2 + octave);
    const float ridge = (1.0f - std::abs(value)) * (1.0f - std::abs(value));
    ridges += amplitude * ridge * crest;  // detail on the ridges, valleys stay smooth
    hills += amplitude * value;
    crest = glm::clamp(1.3f * ridge, 0.0f, 1.0f);
    amplitude *= 0.5f;
    frequency *= 2.03f;
  }
  const float height = 0.45f * lowland + 0.3f * hills * (0.3f + mountains) + 0.16f +
                       2.6f * mountains * ridges * ridges;
  return std::max(0.0f, height);
}

TerrainMaterial material_of(vec3 a, vec3 b, vec3 c) {
  const float height = (a.y + b.y + c.y) / 3.0f;
  const float up = glm::normalize(glm::cross(b - a, c - a)).y;
  if (height == 0.0f) return water;
  if (height < 0.05f) return sand;
  if (height > 1.45f && up > 0.62f) return snow;
  if (up < 0.72f || height > 1.2f) return rock;
  return grass;
}

}  // namespace

Scene make_terrain(std::span<const double> values, const Job& job) {
  const GridSize grid = grid_for(values[0]);
  const uint32_t seed = hash(static_cast<uint32_t>(values[1]));
  Scene scene;
  add_daylight(scene);
  const auto add = [&](const char* name, vec3 albedo) {
    Material material;
    material.name = name;
    material.albedo = albedo;
    add_material(scene, material);
  };
  add("water", {0.02f, 0.06f, 0.08f});
  add("sand", {0.55f, 0.47f, 0.32f});
  add("grass", {0.13f, 0.22f, 0.06f});
  add("rock", {0.28f, 0.25f, 0.22f});
  add("snow", {0.85f, 0.87f, 0.90f});
  scene.materials[water].reflectivity = 0.5f;

  Mesh& mesh = scene.meshes.emplace_back();
  mesh.name = "terrain";
  const size_t row_corners = grid.columns + 1;
  const size_t corners = row_corners * (grid.rows + 1);
  mesh.positions.resize(corners);
  mesh.normals.resize(corners);
  mesh.uvs.resize(corners);
  const vec2 cell(terrain_side / static_cast<float>(grid.columns),
                  terrain_side / static_cast<float>(grid.rows));
  fill_in_parallel(
      grid.rows + 1, job, 0.0f, 0.7f, "raising mountains", [&](size_t first, size_t last) {
        for (size_t row = first; row < last; row++) {
          for (size_t column = 0; column < row_corners; column++) {
            const vec2 uv(static_cast<float>(column) / static_cast<float>(grid.columns),
                          static_cast<float>(row) / static_cast<float>(grid.rows));
            const vec2 ground = terrain_side * (uv - 0.5f);
            const size_t corner = row * row_corners + column;
            mesh.positions[corner] = {ground.x, height_at(ground, seed), ground.y};
            mesh.uvs[corner] = {uv.x, 1.0f - uv.y};
          }
        }
      });

  const size_t triangles = size_t{2} * grid.columns * grid.rows;
  mesh.triangles.resize(triangles);
  mesh.materials.resize(triangles);
  fill_in_parallel(
      grid.rows + 1, job, 0.7f, 1.0f, "joining triangles", [&](size_t first, size_t last) {
        const auto& p = mesh.positions;
        for (size_t row = first; row < last; row++) {
          // Normals from the neighbours' heights, one-sided at the border.
          const size_t before = row > 0 ? row - 1 : 0;
          const size_t after = std::min<size_t>(row + 1, grid.rows);
          for (size_t column = 0; column < row_corners; column++) {
            const size_t left = column > 0 ? column - 1 : 0;
            const size_t right = std::min<size_t>(column + 1, grid.columns);
            const float rise_x = p[row * row_corners + right].y - p[row * row_corners + left].y;
            const float rise_z =
                p[after * row_corners + column].y - p[before * row_corners + column].y;
            mesh.normals[row * row_corners + column] =
                glm::normalize(vec3(-rise_x / (cell.x * static_cast<float>(right - left)), 1.0f,
                                    -rise_z / (cell.y * static_cast<float>(after - before))));
          }
          if (row == grid.rows) continue;
          for (size_t column = 0; column < grid.columns; column++) {
            const size_t a = row * row_corners + column, b = a + row_corners;
            const size_t triangle = 2 * (row * grid.columns + column);
            mesh.triangles[triangle] = uvec3(a, b, a + 1);
            mesh.triangles[triangle + 1] = uvec3(a + 1, b, b + 1);
            mesh.materials[triangle] = material_of(p[a], p[b], p[a + 1]);
            mesh.materials[triangle + 1] = material_of(p[a + 1], p[b], p[b + 1]);
          }
        }
      });

  add_instance(scene);
  scene.lights.push_back({"sun", {40.0f, 45.0f, 25.0f}, {1.0f, 0.93f, 0.82f}, 4200.0f, true});
  scene.ambient = {0.18f, 0.21f, 0.28f};
  scene.camera.eye = {-7.5f, 3.2f, 11.0f};
  scene.camera.target = {1.5f, 0.9f, 0.0f};
  scene.camera.fov_degrees = 45.0f;
  return scene;
}

}  // namespace tracer
