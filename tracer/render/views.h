// What a pixel means: every debug view is a pure function of the facts on the film.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "tracer/pipeline.h"
#include "tracer/render/surface.h"

namespace tracer {

// kind: `radiance` is exposed and tone mapped; `color` is shown as it is; `value` goes through the
// range and the colour map and has a legend.
enum class ViewKind { radiance, color, value };

// What all pixels of a picture share.
struct ViewInput {
  const Snapshot& snapshot;
  CameraFrame camera;
  uint32_t Counters::*counter;
  int ray_class;                           // ray_class_count: all
  std::vector<std::vector<float>> growth;  // by mesh and triangle; only for views that ask for it
};
struct ViewRow;
ViewInput view_input(const Snapshot& snapshot, const ViewRow& view, const CounterRow& counter,
                     int ray_class);

// One sample of the film; x and y are the pixel through whose centre it was traced.
struct ViewPixel {
  const ViewInput& input;
  int x = 0;
  int y = 0;
  const Hit& hit;
  const ClassCounters& counters;
  int depth = 0;  // bounces
};

struct ViewRow {
  std::string_view id, label, help, unit;
  ViewKind kind;
  bool counts = false;                         // a value that is always a whole number >= 0
  bool by_ray_class = false;                   // depends on the chosen ray class
  vec3 (*color)(const ViewPixel&) = nullptr;   // sRGB 0..1; only asked where something was hit
  float (*value)(const ViewPixel&) = nullptr;  // NaN: none
  bool by_growth = false;                      // reads ViewInput::growth
};
std::span<const ViewRow> views();

}  // namespace tracer
