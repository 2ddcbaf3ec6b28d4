// Colour maps: a value 0..1 as a colour.
#pragma once

#include <span>
#include <string_view>

#include "tracer/math/types.h"

namespace tracer {

struct ColormapRow {
  std::string_view id, label, help;
  vec3 (*color)(float t);  // sRGB 0..1; t is clamped
};
std::span<const ColormapRow> colormaps();

}  // namespace tracer
