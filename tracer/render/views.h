// What a pixel means: every debug view is a pure function of the facts on the film.
#pragma once

#include <span>
#include <string_view>

#include "tracer/pipeline.h"

namespace tracer {

// kind: `radiance` is exposed and tone mapped; `color` is shown as it is; `value` goes through the
// range and the colour map and has a legend.
enum class ViewKind { radiance, color, value };

struct ViewPixel;  // views.cpp

struct ViewRow {
  std::string_view id, label, help, unit;
  ViewKind kind;
};
std::span<const ViewRow> views();

struct ToneMapRow {
  std::string_view id, label, help;
  vec3 (*map)(vec3 linear);
};
std::span<const ToneMapRow> tone_maps();

}  // namespace tracer
