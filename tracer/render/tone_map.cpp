// Tone maps. reinhard: E. Reinhard et al., Photographic Tone Reproduction for Digital Images, 2002,
// equation 3, applied to each channel. aces: K. Narkowicz, ACES Filmic Tone Mapping Curve, 2015.
#include "tracer/render/tone_map.h"

#include <cmath>

#include "tracer/scene/texture.h"

namespace tracer {
namespace {

vec3 clamped(vec3 x) {
  return glm::clamp(x, vec3(0.0f), vec3(1.0f));
}

vec3 reinhard(vec3 x) {
  return x / (1.0f + x);
}

vec3 aces(vec3 x) {
  return clamped(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f));
}

constexpr ToneMapRow rows[] = {
    {"none", "None", "Clips at 1; exact for measuring", clamped},
    {"reinhard", "Reinhard", "x / (1 + x): soft, never clips", reinhard},
    {"aces", "ACES", "Filmic curve with contrast (Narkowicz's fit)", aces},
};

}  // namespace

std::span<const ToneMapRow> tone_maps() {
  return rows;
}

DisplayCurve::DisplayCurve(const ToneMapRow& tone_map, float exposure)
    : table_(highest - lowest + 1) {
  const float scale = std::exp2(exposure);
  for (uint32_t i = 1; i < table_.size(); ++i) {
    // The middle of the values that share this step.
    const uint32_t bits = ((i + lowest) << (23 - mantissa_bits)) + (1u << (22 - mantissa_bits));
    const float shown = tone_map.map(vec3(std::bit_cast<float>(bits) * scale)).x;
    table_[i] = uint8_t(std::lround(255.0f * srgb_from_linear(shown)));
  }
}

uint32_t DisplayCurve::fault(const vec3& linear) {
  const bool nan = std::isnan(linear.x) || std::isnan(linear.y) || std::isnan(linear.z);
  return nan ? 0xff0000ffu : 0xff00ff00u;
}

}  // namespace tracer
