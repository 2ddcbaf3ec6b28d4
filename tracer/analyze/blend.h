// SAH-EPO: what a ray really costs, from both metrics. Based on: D. Wodniok, M. Goesele,
// Construction of bounding volume hierarchies with SAH cost approximation on temporary subtrees,
// 2017, after T. Aila et al. 2013.
//   cost = scale ((1 - alpha) SAH + alpha EPO)
// alpha is no constant of nature: it is fitted to measured costs, scene by scene.
#pragma once

#include <optional>
#include <span>

namespace tracer {

// One build: its metrics, and the measured cost of a primary ray, nodes Ct + triangle tests Ci.
struct BlendSample {
  double sah = 0.0, epo = 0.0;
  double measured = 0.0;
};

struct Blend {
  double alpha = 0.0;        // 0..1: the share of EPO
  double scale = 0.0;        // least squares, with that alpha
  double correlation = 0.0;  // uncentered Pearson: sum x y / sqrt(sum x^2 sum y^2)
  double mean_error = 0.0;   // mean of |predicted - measured| / measured
};

inline constexpr size_t min_blend_samples = 3;  // that differ in SAH or EPO

// The alpha with the largest uncentered correlation: the prediction has to be proportional to the
// cost, without an offset. Nothing if fewer than three samples differ, or none costs anything.
std::optional<Blend> fit_blend(std::span<const BlendSample> samples);

double predicted_cost(const Blend& blend, double sah, double epo);

}  // namespace tracer
