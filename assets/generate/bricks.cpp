// A brick wall: running bond, worn edges, a colour for each brick, grain from periodic noise.
#include <algorithm>
#include <cmath>

#include "assets/generate/generate.h"
#include "tracer/math/rng.h"
#include "tracer/scene/texture.h"

namespace assets {
namespace {

using tracer::hash;
using tracer::vec2;
using tracer::vec3;

constexpr int courses = 8, bricks_a_course = 4;

float random_at(int x, int y, uint32_t seed) {
  return static_cast<float>(hash(static_cast<uint32_t>(x), hash(static_cast<uint32_t>(y), seed))) *
         0x1p-32f;
}

// Value noise 0..1 on a lattice of period x period cells over the picture.
float noise(vec2 uv, int period, uint32_t seed) {
  const vec2 point = uv * static_cast<float>(period);
  const vec2 cell = glm::floor(point);
  const vec2 f = glm::smoothstep(vec2(0.0f), vec2(1.0f), point - cell);
  const int x = static_cast<int>(cell.x), y = static_cast<int>(cell.y);
  const auto corner = [&](int i, int j) {
    return random_at((x + i) % period, (y + j) % period, seed);
  };
  return glm::mix(glm::mix(corner(0, 0), corner(1, 0), f.x),
                  glm::mix(corner(0, 1), corner(1, 1), f.x), f.y);
}
float fractal(vec2 uv, int period, uint32_t seed) {
  return (8 * noise(uv, period, seed) + 4 * noise(uv, 2 * period, seed + 1) +
          2 * noise(uv, 4 * period, seed + 2) + noise(uv, 8 * period, seed + 3)) /
         15.0f;
}

struct Wall {
  float height;  // 0 mortar .. 1 face of a brick
  int brick, course;
};

Wall wall_at(vec2 uv) {
  const vec2 wobble(fractal(uv, 16, 11) - 0.5f, fractal(uv, 16, 21) - 0.5f);
  const vec2 point = uv + 0.012f * wobble + 1.0f;  // + 1: positive, the pattern has period 1
  const float y = point.y * courses;
  const int course = static_cast<int>(std::floor(y));
  const float shift = (course & 1) == 1 ? 0.5f : 0.0f;
  const float x = point.x * bricks_a_course + shift;
  const int brick = static_cast<int>(std::floor(x));
  // Distance to the edge of the brick, in heights of a course; a brick is twice as long as high.
  const float edge_x = 2.0f * (0.5f - std::abs(x - std::floor(x) - 0.5f));
  const float edge_y = 0.5f - std::abs(y - std::floor(y) - 0.5f);
  // Rounded corners: the two distances from where the brick begins add up like a radius.
  const float joint = 0.06f, round = 0.12f;
  const vec2 inside(std::min(edge_x - joint - round, 0.0f), std::min(edge_y - joint - round, 0.0f));
  const float edge = round - glm::length(inside);
  const float worn = edge + 0.05f * (fractal(uv, 64, 31) - 0.5f);
  return {glm::smoothstep(0.0f, 0.07f, worn), brick % bricks_a_course, course % courses};
}

vec3 color_at(vec2 uv, const Wall& wall) {
  const float tone = random_at(wall.brick, wall.course, 1);
  const float burnt = random_at(wall.brick, wall.course, 2);
  vec3 brick = glm::mix(vec3(0.30f, 0.075f, 0.040f), vec3(0.48f, 0.155f, 0.075f), tone);
  if (burnt > 0.85f) brick *= vec3(0.55f, 0.6f, 0.75f);
  const float stains = fractal(uv, 12, 41), grain = fractal(uv, 100, 51);
  brick *= 0.72f + 0.56f * stains;
  brick *= 0.75f + 0.5f * grain;
  const vec3 mortar = vec3(0.42f, 0.39f, 0.34f) * (0.7f + 0.6f * fractal(uv, 80, 61));
  return glm::mix(mortar, brick, wall.height);
}

}  // namespace

std::vector<uint8_t> make_bricks() {
  std::vector<uint8_t> bytes;
  for (int y = 0; y < bricks_size; y++) {
    for (int x = 0; x < bricks_size; x++) {
      const float pixel = 1.0f / static_cast<float>(bricks_size);
      const vec2 uv = (vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f) * pixel;
      const Wall wall = wall_at(uv);
      // Light from the upper left on the slopes at the joints.
      const float toward_light = wall_at(uv - 1.5f * pixel).height;
      const float relief = 1.0f + 0.45f * (wall.height - toward_light);
      const vec3 color = color_at(uv, wall) * relief * (0.75f + 0.25f * wall.height);
      for (int channel = 0; channel < 3; channel++) {
        const float value = glm::clamp(color[channel], 0.0f, 1.0f);
        bytes.push_back(
            static_cast<uint8_t>(std::lround(tracer::srgb_from_linear(value) * 255.0f)));
      }
    }
  }
  return bytes;
}

}  // namespace assets
