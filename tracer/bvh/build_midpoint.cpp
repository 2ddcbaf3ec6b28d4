// Midpoint split: in the middle of the longest axis of the centroids' box (J. Bikker, How to build
// a BVH, part 1, 2022, who splits the nodes' box: there more splits leave one side empty).
#include "tracer/bvh/builders.h"
#include "tracer/bvh/top_down.h"

namespace tracer {

namespace {

struct MidpointSplitter {
  struct Side {
    int axis;
    float plane;  // twice the coordinate
    bool operator()(const Reference& reference) const { return centroid2(reference)[axis] < plane; }
  };
  struct Scratch {};
  uint32_t max_leaf_size;

  Decision<Side> decide(const Range& range, std::span<const Reference>, Scratch&) const {
    if (range.size() <= max_leaf_size) return {};
    const int axis = longest_axis(range.centroids);
    const float lo = range.centroids.lo[axis], hi = range.centroids.hi[axis];
    return {DecisionKind::split, {axis, lo + 0.5f * (hi - lo)}, axis};
  }
};

}  // namespace

Bvh build_midpoint(const BuildInput& input, const BuildOptions& options, BuildLog* log,
                   std::stop_token stop) {
  return TopDown(input, options, log, std::move(stop), MidpointSplitter{options.max_leaf_size})
      .build();
}

}  // namespace tracer
