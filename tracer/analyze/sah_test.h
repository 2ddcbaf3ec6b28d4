// A test of builder, traversal and metric at once: random lines through the root's box that never
// stop must cost on average what SAH says.
#pragma once

#include "tracer/analyze/monte_carlo.h"
#include "tracer/bvh/bvh.h"

namespace tracer {

struct SahTest {
  double sah = 0.0;       // by areas
  double measured = 0.0;  // Ct an inner node, Ci a reference, a line
  double standard_error = 0.0;
  uint64_t lines = 0;  // 0: the root has no area, nothing to measure
};

// Within six standard errors; box tests that are wider by rounding may cost two in a thousand.
bool holds(const SahTest& test);

inline constexpr SampleLimits sah_test_limits = {.relative_error = 0.005, .max_samples = 1 << 15};

// The tree's depth is at most max_tree_depth. Deterministic for any number of threads.
SahTest sah_test(const Bvh& tree, float traversal_cost, float intersection_cost,
                 const SampleLimits& limits, const std::stop_token& stop);

}  // namespace tracer
