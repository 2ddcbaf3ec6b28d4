#include "tracer/analyze/blend.h"

#include <cmath>
#include <set>
#include <utility>

namespace tracer {
namespace {

// Sums of products over the samples: S is SAH, E is EPO, y is measured.
struct Sums {
  double ss = 0.0, se = 0.0, ee = 0.0, sy = 0.0, ey = 0.0, yy = 0.0;
};

bool counts(const BlendSample& sample) {
  return sample.measured > 0.0 && std::isfinite(sample.sah + sample.epo + sample.measured);
}

Blend with_alpha(const Sums& sums, double alpha) {
  const double beta = 1.0 - alpha;
  const double xx = beta * beta * sums.ss + 2.0 * alpha * beta * sums.se + alpha * alpha * sums.ee;
  const double xy = beta * sums.sy + alpha * sums.ey;
  Blend blend;
  blend.alpha = alpha;
  if (xx <= 0.0) return blend;
  blend.scale = xy / xx;
  blend.correlation = xy / std::sqrt(xx * sums.yy);
  return blend;
}

// In the plane of S and E the correlation is the cosine of the angle to y, and largest for y's
// projection a S + b E; it falls to both sides of it. Outside 0..1 one of the ends is best.
Blend best(const Sums& sums) {
  const Blend sah = with_alpha(sums, 0.0);
  const Blend epo = with_alpha(sums, 1.0);
  const Blend end = epo.correlation > sah.correlation ? epo : sah;
  const double determinant = sums.ss * sums.ee - sums.se * sums.se;
  // Where SAH and EPO say the same, any alpha does: SAH alone.
  if (determinant <= 1e-12 * sums.ss * sums.ee) return end;
  const double a = (sums.sy * sums.ee - sums.ey * sums.se) / determinant;
  const double b = (sums.ey * sums.ss - sums.sy * sums.se) / determinant;
  return a >= 0.0 && b >= 0.0 && a + b > 0.0 ? with_alpha(sums, b / (a + b)) : end;
}

}  // namespace

double predicted_cost(const Blend& blend, double sah, double epo) {
  return blend.scale * ((1.0 - blend.alpha) * sah + blend.alpha * epo);
}

std::optional<Blend> fit_blend(std::span<const BlendSample> samples) {
  Sums sums;
  std::set<std::pair<double, double>> different;
  for (const BlendSample& sample : samples) {
    if (!counts(sample)) continue;
    different.emplace(sample.sah, sample.epo);
    sums.ss += sample.sah * sample.sah;
    sums.se += sample.sah * sample.epo;
    sums.ee += sample.epo * sample.epo;
    sums.sy += sample.sah * sample.measured;
    sums.ey += sample.epo * sample.measured;
    sums.yy += sample.measured * sample.measured;
  }
  if (different.size() < min_blend_samples) return {};
  Blend blend = best(sums);
  double errors = 0.0;
  size_t counted = 0;
  for (const BlendSample& sample : samples) {
    if (!counts(sample)) continue;
    errors +=
        std::abs(predicted_cost(blend, sample.sah, sample.epo) - sample.measured) / sample.measured;
    ++counted;
  }
  blend.mean_error = errors / double(counted);
  return blend;
}

}  // namespace tracer
