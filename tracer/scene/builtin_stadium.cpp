// The "teapot in a stadium": much detail in a small part of a huge sparse scene. The name of the
// problem is E. Haines', Spline Surface Rendering, and What's Wrong With Octrees, 1988.
#include <array>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "tracer/scene/builtin_makers.h"
#include "tracer/scene/builtin_parts.h"
#include "tracer/scene/teapot.h"

namespace tracer {
namespace {

constexpr uint32_t sides = 64;

// Corner `side` of an oval ring; the last corner is the first one again, to the bit.
vec3 on_oval(uint32_t side, float radius, float height) {
  const float angle = 2.0f * pi * static_cast<float>(side % sides) / static_cast<float>(sides);
  return {1.4f * radius * std::cos(angle), height, radius * std::sin(angle)};
}

// Rows of seats in blocks of two colours: each step is a riser and a tread.
void add_stands(Mesh& mesh, uint32_t concrete, uint32_t seats) {
  constexpr int steps = 20;
  constexpr float first_radius = 45.0f, step_depth = 1.6f, step_height = 0.6f;
  for (uint32_t side = 0; side < sides; side++) {
    for (int step = 0; step < steps; step++) {
      const float inner = first_radius + step_depth * static_cast<float>(step);
      const float low = step_height * static_cast<float>(step), high = low + step_height;
      const float outer = inner + step_depth;
      add_flat_quad(mesh, on_oval(side, inner, low), on_oval(side + 1, inner, low),
                    on_oval(side + 1, inner, high), on_oval(side, inner, high),
                    seats + (side / 4 + static_cast<uint32_t>(step) / 7) % 2);
      add_flat_quad(mesh, on_oval(side, inner, high), on_oval(side + 1, inner, high),
                    on_oval(side + 1, outer, high), on_oval(side, outer, high), concrete);
    }
    const float outside = first_radius + step_depth * steps;
    const float top = step_height * steps;
    add_flat_quad(mesh, on_oval(side + 1, outside, 0), on_oval(side, outside, 0),
                  on_oval(side, outside, top), on_oval(side + 1, outside, top), concrete);
  }
}

}  // namespace

Scene make_stadium(std::span<const double> values, const Job&) {
  const auto detail = static_cast<uint32_t>(values[0]);
  Scene scene;
  add_daylight(scene);
  const uint32_t grass = add_matt(scene, "grass", {0.08f, 0.19f, 0.05f});
  const uint32_t sand = add_matt(scene, "sand", {0.55f, 0.46f, 0.32f});
  const uint32_t concrete = add_matt(scene, "concrete", {0.45f, 0.44f, 0.42f});
  const uint32_t seats = add_matt(scene, "blue seats", {0.10f, 0.20f, 0.45f});
  add_matt(scene, "white seats", {0.70f, 0.70f, 0.68f});
  const uint32_t porcelain = add_matt(scene, "porcelain", {0.80f, 0.78f, 0.74f});
  scene.materials[porcelain].reflectivity = 0.1f;

  // All in one mesh: the lesson is about one tree.
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.name = "stadium";
  constexpr float far = 1000.0f, pitch_x = 40.0f, pitch_z = 26.0f, pitch_y = 0.02f;
  add_flat_quad(mesh, {-far, 0, far}, {far, 0, far}, {far, 0, -far}, {-far, 0, -far}, sand);
  add_flat_quad(mesh, {-pitch_x, pitch_y, pitch_z}, {pitch_x, pitch_y, pitch_z},
                {pitch_x, pitch_y, -pitch_z}, {-pitch_x, pitch_y, -pitch_z}, grass);
  add_stands(mesh, concrete, seats);
  append(mesh, make_teapot(detail), glm::translate(mat4(1.0f), vec3(0, pitch_y, 0)), porcelain);

  add_instance(scene);
  constexpr std::array towers = {vec2(-1, -1), vec2(1, -1), vec2(-1, 1), vec2(1, 1)};
  for (const vec2& tower : towers) {
    scene.lights.push_back({"floodlight " + std::to_string(scene.lights.size() + 1),
                            {75.0f * tower.x, 45.0f, 55.0f * tower.y},
                            {1.0f, 0.97f, 0.90f},
                            2900.0f,
                            true});
  }
  scene.ambient = {0.2f, 0.22f, 0.27f};
  scene.camera.eye = {1.7f, 1.9f, 3.6f};
  scene.camera.target = {0.1f, 1.05f, 0.0f};
  scene.camera.fov_degrees = 45.0f;
  return scene;
}

}  // namespace tracer
