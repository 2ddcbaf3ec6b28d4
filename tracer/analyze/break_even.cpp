// Compares the frame times of refit and rebuild.
#include "tracer/analyze/break_even.h"

#include <algorithm>

#include <fmt/format.h>

namespace tracer {
namespace {

const TimelineCurve* curve_of(const Timeline& timeline, std::string_view strategy) {
  for (const TimelineCurve& curve : timeline.curves) {
    if (curve.strategy == strategy) return &curve;
  }
  return nullptr;
}

std::string moment(const TimelineSample& sample) {
  return fmt::format("frame {} ({:.2f} s)", sample.frame, sample.time);
}

}  // namespace

BreakEven break_even(const Timeline& timeline) {
  BreakEven result;
  const TimelineCurve* refit = curve_of(timeline, "refit");
  const TimelineCurve* rebuild = curve_of(timeline, "rebuild");
  if (refit == nullptr || rebuild == nullptr) return result;
  const size_t count = std::min(refit->samples.size(), rebuild->samples.size());
  double refit_sum = 0.0;
  double rebuild_sum = 0.0;
  const auto shorter = [&](size_t i) {
    return rebuild->samples[i].frame_ms() < refit->samples[i].frame_ms();
  };
  for (size_t i = 0; i < count; ++i) {
    refit_sum += refit->samples[i].frame_ms();
    rebuild_sum += rebuild->samples[i].frame_ms();
    if (!result.total && rebuild_sum < refit_sum) result.total = i;
    const bool lasts = i + 1 == count || shorter(i + 1);
    if (!result.single && shorter(i) && lasts) result.single = i;
  }
  return result;
}

std::string break_even_text(const Timeline& timeline) {
  const TimelineCurve* refit = curve_of(timeline, "refit");
  const TimelineCurve* rebuild = curve_of(timeline, "rebuild");
  if (refit == nullptr || rebuild == nullptr || refit->samples.empty() ||
      rebuild->samples.empty()) {
    return "Whether rebuilding pays shows once refit and rebuild have both been measured.";
  }
  const BreakEven even = break_even(timeline);
  double sums[2] = {0.0, 0.0};
  const size_t last = even.total ? *even.total : refit->samples.size() - 1;
  for (size_t i = 0; i <= last; ++i) {
    sums[0] += refit->samples[i].frame_ms();
    sums[1] += rebuild->samples[i].frame_ms();
  }
  std::string text;
  if (even.single) {
    text = fmt::format(
        "A single frame is shorter with a rebuild from {} on: {:.2f} ms against {:.2f} ms with a "
        "refit.",
        moment(refit->samples[*even.single]), rebuild->samples[*even.single].frame_ms(),
        refit->samples[*even.single].frame_ms());
  } else {
    text = "No single frame is shorter with a rebuild.";
  }
  if (even.total) {
    text += fmt::format(
        " All frames together pay from {} on: {:.0f} ms with rebuilds, {:.0f} ms with refits.",
        moment(refit->samples[last]), sums[1], sums[0]);
  } else {
    text += fmt::format(
        " All frames together do not pay up to {}: {:.0f} ms with rebuilds, {:.0f} ms with refits.",
        moment(refit->samples[last]), sums[1], sums[0]);
  }
  return text;
}

}  // namespace tracer
