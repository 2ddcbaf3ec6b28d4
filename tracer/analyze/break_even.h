// From which frame of a timeline rebuilding pays.
#pragma once

#include <optional>

#include "tracer/analyze/timeline.h"

namespace tracer {

// From which frame rebuilding in each frame pays against refitting alone. Nothing: in no frame that
// was measured.
struct BreakEven {
  // The first of two measured frames in a row (or the last one) that are shorter with rebuild.
  std::optional<size_t> single;  // index of the sample
  // The first at which the sum over the measured frames up to it is smaller with rebuild.
  std::optional<size_t> total;
};
BreakEven break_even(const Timeline& timeline);
// In words, with the figures.
std::string break_even_text(const Timeline& timeline);

}  // namespace tracer
