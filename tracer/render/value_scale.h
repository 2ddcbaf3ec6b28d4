// Where a value lies in a shown range: linear or logarithmic.
#pragma once

#include <algorithm>
#include <cmath>

#include "tracer/settings.h"

namespace tracer {

// Logarithmic: counts go by log2(1 + x), so that 0 has a place; other values by log2(x), where
// everything below hi / 65536 is at the lower end.
class ValueScale {
 public:
  ValueScale(ValueRange range, bool logarithmic, bool counts)
      : range_(range), logarithmic_(logarithmic), offset_(counts ? 1.0f : 0.0f) {
    smallest_ = counts ? 0.0f : std::max(range.hi, 1e-30f) / 65536.0f;
    start_ = warped(range.lo);
    const float length = warped(range.hi) - start_;
    per_length_ = length > 0.0f ? 1.0f / length : 0.0f;
  }

  // 0 at the range's lower end, 1 at the upper; not clamped. A range without length: 0.
  float position(float value) const { return (warped(value) - start_) * per_length_; }

  // The inverse, 0 <= position <= 1.
  float value(float position) const {
    if (per_length_ == 0.0f) return range_.lo;
    const float warped_value = start_ + position / per_length_;
    return logarithmic_ ? std::exp2(warped_value) - offset_ : warped_value;
  }

 private:
  float warped(float value) const {
    return logarithmic_ ? std::log2(std::max(value, smallest_) + offset_) : value;
  }

  ValueRange range_;
  bool logarithmic_;
  float offset_;
  float smallest_ = 0.0f;
  float start_ = 0.0f;
  float per_length_ = 0.0f;
};

}  // namespace tracer
