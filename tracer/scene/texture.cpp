// Texture sampling.
#include "tracer/scene/texture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tracer/math/simd.h"

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

float4 linear(uint32_t texel) {
  return float4{linear_table[texel & 0xff], linear_table[texel >> 8 & 0xff],
                linear_table[texel >> 16 & 0xff], 0.0f};
}

float4 mix(float4 a, float4 b, float weight) {
  return a * broadcast(1.0f - weight) + b * broadcast(weight);
}

// Two neighbouring texels, and the second's weight.
struct Taps {
  uint32_t first;
  uint32_t second;
  float weight;
};

// Across and down the repeating texture.
std::array<Taps, 2> taps(vec2 place, const Texture& texture) {
  const float4 at = {place.x, place.y, 0.0f, 0.0f};
  const float4 part = at - floor(at);
  // 0 where rounded up to 1, too large or not finite.
  const float4 turn = ((part >= float4{}) & (part < broadcast(1.0f))) ? part : float4{};
  const float4 texel =
      turn * float4{float(texture.width), float(texture.height), 0.0f, 0.0f} - broadcast(0.5f);
  const float4 low = floor(texel);
  const float4 weight = texel - low;
  const auto taps = [&](int axis, uint32_t size) -> Taps {
    const auto first = int32_t(low[axis]);
    const uint32_t a = first < 0 ? size - 1 : uint32_t(first);
    return {a, a + 1 == size ? 0 : a + 1, weight[axis]};
  };
  return {taps(0, texture.width), taps(1, texture.height)};
}

}  // namespace

TexturePlace fetch(const Texture& texture, vec2 uv) {
  if (texture.texels.empty()) return {};
  const auto [x, y] = taps({uv.x, 1.0f - uv.y}, texture);  // row 0 is the upper one
  const uint32_t upper = y.first * texture.width, lower = y.second * texture.width;
  const uint32_t* const texels = texture.texels.data();
  __builtin_prefetch(texels + upper + x.first);
  __builtin_prefetch(texels + lower + x.first);
  return {upper + x.first, upper + x.second, lower + x.first, lower + x.second, x.weight, y.weight};
}

vec3 sample_fetched(const Texture& texture, const TexturePlace& place) {
  if (texture.texels.empty()) return vec3(0.5f);
  const uint32_t* const texels = texture.texels.data();
  const auto between = [&](uint32_t left, uint32_t right) {
    return mix(linear(texels[left]), linear(texels[right]), place.across);
  };
  return xyz(mix(between(place.upper_left, place.upper_right),
                 between(place.lower_left, place.lower_right), place.down));
}

vec3 sample(const Texture& texture, vec2 uv) {
  return sample_fetched(texture, fetch(texture, uv));
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
