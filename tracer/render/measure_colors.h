// The colours of a measure of nodes: the same in boxes, icicle and tables.
#pragma once

#include <array>
#include <cstdint>

#include "tracer/analyze/node_measures.h"
#include "tracer/render/value_scale.h"

namespace tracer {

inline constexpr uint32_t no_value_color = 0xff8a8a8au;

// sRGB 0..1, of a place 0..1 in the range.
vec3 measure_color(MeasureScale scale, float position);

class MeasureColors {
 public:
  MeasureColors(MeasureScale scale, ValueRange range, bool logarithmic, bool counts);

  // Bytes R, G, B, A; values outside the range have the colour of its end.
  uint32_t operator()(float value) const;

 private:
  ValueScale scale_;
  std::array<uint32_t, 256> colors_;
};

// Whether the measure's values are whole numbers.
bool counts(const NodeMeasureRow& measure);

}  // namespace tracer
