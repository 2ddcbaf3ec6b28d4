// From linear radiance to what a display can show: tone maps and the sRGB curve.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "tracer/math/types.h"

namespace tracer {

struct ToneMapRow {
  std::string_view id, label, help;
  vec3 (*map)(vec3 linear);  // from 0 or more to 0..1; a table may hold it: each channel alone
};
std::span<const ToneMapRow> tone_maps();

// Exposure, tone map and sRGB curve of one channel in one table, made anew for every picture. The
// index is the float's own exponent and upper mantissa bits, so the steps are even in stops.
class DisplayCurve {
 public:
  // exposure in stops.
  DisplayCurve(const ToneMapRow& tone_map, float exposure);

  // Linear radiance to an opaque pixel, bytes R, G, B, A. NaN is red and infinity green, so that
  // faults of the renderer show.
  uint32_t operator()(const vec3& linear) const {
    const vec3 zero = linear - linear;  // NaN where the channel is NaN or infinite
    if (!(zero.x + zero.y + zero.z == 0.0f)) return fault(linear);
    return 0xff000000u | uint32_t(at(linear.z)) << 16 | uint32_t(at(linear.y)) << 8 | at(linear.x);
  }

 private:
  static constexpr int mantissa_bits = 7;                          // 128 steps a stop
  static constexpr uint32_t lowest = (127 - 20) << mantissa_bits;  // below 2^-20 all is black
  static constexpr uint32_t highest = (127 + 20) << mantissa_bits;

  uint8_t at(float value) const {
    if (!(value > 0.0f)) return table_[0];
    const uint32_t step = std::bit_cast<uint32_t>(value) >> (23 - mantissa_bits);
    return table_[step < lowest ? 0 : step > highest ? highest - lowest : step - lowest];
  }
  static uint32_t fault(const vec3& linear);

  std::vector<uint8_t> table_;
};

}  // namespace tracer
