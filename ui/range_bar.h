// The shown range on its colour map: histogram, gradient, and a handle at each end.
#pragma once

#include "tracer/render/colorize.h"

namespace ui {

// True in a frame in which a handle moves; `range` is then the new one.
bool range_bar(const char* label, tracer::ValueRange& range, const tracer::Picture& picture,
               const tracer::ViewOptions& options, const char* help);

}  // namespace ui
