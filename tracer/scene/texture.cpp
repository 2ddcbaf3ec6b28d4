// Texture sampling.
#include "tracer/scene/texture.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tracer {
namespace {

float decoded(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

std::array<float, 256> make_linear_table() {
  std::array<float, 256> table{};
  for (size_t i = 0; i < table.size(); ++i)
    table[i] = decoded(float(i) / 255.0f);
  return table;
}

const std::array<float, 256> linear_table = make_linear_table();

vec3 linear(uint32_t texel) {
  return vec3(linear_table[texel & 0xff], linear_table[texel >> 8 & 0xff],
              linear_table[texel >> 16 & 0xff]);
}

// A coordinate of the repeating texture, 0..1, as two neighbouring texels and the second's weight.
struct Taps {
  uint32_t first;
  uint32_t second;
  float weight;
};
Taps taps(float coordinate, uint32_t size) {
  float turn = coordinate - std::floor(coordinate);
  if (!(turn < 1.0f)) turn = 0.0f;  // rounded up to 1, or not finite
  const float at = turn * float(size) - 0.5f;
  const float low = std::floor(at);
  const int32_t first = int32_t(low);
  const uint32_t a = first < 0 ? size - 1 : uint32_t(first);
  return {a, a + 1 == size ? 0 : a + 1, at - low};
}

}  // namespace

vec3 sample(const Texture& texture, vec2 uv) {
  if (texture.texels.empty()) return vec3(0.5f);
  const Taps x = taps(uv.x, texture.width);
  const Taps y = taps(1.0f - uv.y, texture.height);  // row 0 is the upper one
  const uint32_t* const upper = texture.texels.data() + size_t(y.first) * texture.width;
  const uint32_t* const lower = texture.texels.data() + size_t(y.second) * texture.width;
  const vec3 above = glm::mix(linear(upper[x.first]), linear(upper[x.second]), x.weight);
  const vec3 below = glm::mix(linear(lower[x.first]), linear(lower[x.second]), x.weight);
  return glm::mix(above, below, y.weight);
}

float linear_from_srgb(uint8_t value) {
  return linear_table[value];
}

float srgb_from_linear(float value) {
  if (!(value > 0.0f)) return 0.0f;
  if (value <= 0.0031308f) return 12.92f * value;
  return std::min(1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f, 1.0f);
}

}  // namespace tracer
