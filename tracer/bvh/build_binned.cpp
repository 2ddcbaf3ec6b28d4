// Binned SAH builder (I. Wald, On fast Construction of SAH-based Bounding Volume Hierarchies,
// 2007): see binning.h. A node whose centroids cannot be told apart is halved in its present order.
#include "tracer/bvh/binning.h"
#include "tracer/bvh/builders.h"
#include "tracer/bvh/top_down.h"

namespace tracer {

namespace {

class BinnedSplitter {
 public:
  using Side = BinnedSide;
  using Scratch = Histogram;

  explicit BinnedSplitter(const BuildOptions& options) : options_(options) {}

  Decision<Side> decide(const Range& range, std::span<const Reference> all,
                        Histogram& histogram) const {
    const uint32_t count = range.size();
    const Binning binning(range, bins_for(count, options_));
    fill(histogram, binning, range, all);
    const ObjectSplit best = best_split(histogram, binning.bins);
    const float area = half_area(range.box);
    if (count <= options_.max_leaf_size &&
        !(split_cost(options_, area, best.cost) < leaf_cost(options_, count, area))) {
      return {};
    }
    Decision<Side> decision;
    if (best.axis < 0) {
      if (count > options_.max_leaf_size) decision.kind = DecisionKind::halve;
      return decision;
    }
    decision.kind = DecisionKind::split;
    decision.side = {binning.offset, binning.scale, best.axis, static_cast<int>(best.plane)};
    return decision;
  }

 private:
  const BuildOptions& options_;
};

}  // namespace

Bvh build_binned(const BuildInput& input, const BuildOptions& options, BuildLog* log,
                 std::stop_token stop) {
  return TopDown(input, options, log, std::move(stop), BinnedSplitter(options)).build();
}

}  // namespace tracer
