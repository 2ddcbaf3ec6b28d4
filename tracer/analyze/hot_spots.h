// The nodes and triangles that cost most beyond their prediction, and why, in words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tracer/analyze/inspection.h"

namespace tracer {

// What is wrong with a node. view: nothing, rays just come by more often than random lines would.
enum class HotCause { large_triangle, overlap, empty_space, full_leaf, instances, view };
std::string_view name(HotCause cause);

struct HotSpot {
  uint32_t mesh = none;  // whose BLAS; none: the TLAS
  uint32_t node = 0;
  uint32_t triangle = none;  // that makes the node what it is, if one does; in the TLAS an instance
  HotCause cause = HotCause::view;
  double visits = 0.0;
  double predicted = 0.0;  // visits(root) * A(node) / A(root); leaf: by the area of its triangles
  double excess = 0.0;     // cost of the visits beyond the prediction, as a share of the frame's
  std::string text;        // one sentence: what, why, what to do
};

struct HotSpots {
  std::shared_ptr<const Inspection> inspection;  // of these trees
  std::shared_ptr<const CountedVisits> counted;
  int ray_class = ray_class_count;
  double cost = 0.0;           // of the frame: Ct an inner node, Ci a triangle test
  std::vector<HotSpot> spots;  // the largest excess first
};

// Of all trees: at most `most` that have a cause, and as many where only the view has one. A node's
// cost is its visits times Ct, or times count * Ci for a leaf. The leaves of one large triangle are
// one spot. Empty if the visits are of other trees.
HotSpots hot_spots(const Scene& scene, const std::shared_ptr<const Inspection>& inspection,
                   const std::shared_ptr<const CountedVisits>& counted, int ray_class, size_t most,
                   const Job& job);

}  // namespace tracer
