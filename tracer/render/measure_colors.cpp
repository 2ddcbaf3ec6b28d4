#include "tracer/render/measure_colors.h"

#include <cmath>

#include "tracer/choice.h"
#include "tracer/render/colormap.h"

namespace tracer {

vec3 measure_color(MeasureScale scale, float position) {
  if (scale == MeasureScale::category) {
    return position < 0.5f ? vec3(0.36f, 0.62f, 0.96f) : vec3(0.98f, 0.66f, 0.22f);
  }
  if (scale == MeasureScale::diverging) {
    return find_row(colormaps(), "temperature")->color(position);
  }
  // Without the darkest ends: lines have to be seen on dark surfaces.
  return find_row(colormaps(), "turbo")->color(0.08f + 0.86f * glm::clamp(position, 0.0f, 1.0f));
}

MeasureColors::MeasureColors(MeasureScale scale, ValueRange range, bool logarithmic, bool counts)
    : scale_(range, logarithmic && scale == MeasureScale::sequential, counts) {
  for (size_t i = 0; i < colors_.size(); ++i) {
    const vec3 color = measure_color(scale, float(i) / float(colors_.size() - 1)) * 255.0f + 0.5f;
    colors_[i] = 0xff000000u | uint32_t(color.z) << 16 | uint32_t(color.y) << 8 | uint32_t(color.x);
  }
}

uint32_t MeasureColors::operator()(float value) const {
  if (std::isnan(value)) return no_value_color;
  const float position = std::clamp(scale_.position(value), 0.0f, 1.0f);
  return colors_[size_t(position * float(colors_.size() - 1) + 0.5f)];
}

bool counts(const NodeMeasureRow& measure) {
  return measure.digits == 0;
}

}  // namespace tracer
