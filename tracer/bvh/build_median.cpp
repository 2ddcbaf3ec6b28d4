// Object median: half of the primitives to each side, by their centroids on the longest axis of the
// centroids' box (T. Kay, J. Kajiya, Ray Tracing Complex Scenes, 1986).
#include "tracer/bvh/builders.h"
#include "tracer/bvh/top_down.h"

namespace tracer {

namespace {

struct MedianSplitter {
  struct Side {
    bool operator()(const Reference&) const { return true; }
  };
  struct Scratch {};
  uint32_t max_leaf_size;

  Decision<Side> decide(const Range& range, std::span<const Reference>, Scratch&) const {
    if (range.size() <= max_leaf_size) return {};
    return {DecisionKind::halve, {}, longest_axis(range.centroids)};
  }
};

}  // namespace

Bvh build_median(const BuildInput& input, const BuildOptions& options, BuildLog* log,
                 std::stop_token stop) {
  return TopDown(input, options, log, std::move(stop), MedianSplitter{options.max_leaf_size})
      .build();
}

}  // namespace tracer
