// Binned SAH builder (I. Wald, On fast Construction of SAH-based Bounding Volume Hierarchies,
// 2007). Where we differ: the number of bins shrinks with the node (4 + n/20, as Embree does), all
// three axes are tried, and a node whose centroids cannot be told apart is halved in its present
// order.
#include <array>
#include <cmath>

#include "tracer/bvh/builders.h"
#include "tracer/bvh/top_down.h"

namespace tracer {

namespace {

// Maps a centroid to its bin on each axis.
struct Binning {
  float4 offset, scale;
  uint32_t bins;

  Binning(const Range& range, uint32_t bin_count) : offset(range.centroids.lo), bins(bin_count) {
    const float4 size = range.centroids.hi - range.centroids.lo;
    for (int axis = 0; axis < 3; ++axis) {
      const float s = static_cast<float>(bins) * 0.99999f / size[axis];
      scale[axis] = std::isfinite(s) ? s : 0.0f;  // flat axis: everything in bin 0
    }
    // The index in the fourth lane may be a denormal, which is slow to multiply: make it -1.
    offset[3] = 1.0f;
    scale[3] = 0.0f;
  }
  int4 bins_of(const Reference& reference) const {
    return __builtin_convertvector((centroid2(reference) - offset) * scale, int4);
  }
};

struct Bin {
  Bounds box;
  uint32_t count = 0;
};
struct Histogram {
  std::array<std::array<Bin, max_bins>, 3> axes;

  void clear(uint32_t bins) {
    for (auto& axis : axes)
      std::fill_n(axis.begin(), bins, Bin{});
  }
  void add(const Binning& binning, std::span<const Reference> references) {
    for (const Reference& reference : references) {
      const int4 index = binning.bins_of(reference);
      for (int axis = 0; axis < 3; ++axis) {
        Bin& bin = axes[axis][index[axis]];
        bin.box.grow(reference.lo, reference.hi);
        ++bin.count;
      }
    }
  }
  void add(const Histogram& other, uint32_t bins) {
    for (int axis = 0; axis < 3; ++axis) {
      for (uint32_t i = 0; i < bins; ++i) {
        axes[axis][i].box.grow(other.axes[axis][i].box);
        axes[axis][i].count += other.axes[axis][i].count;
      }
    }
  }
};

struct Split {
  int axis = -1;          // -1: no plane has references on both sides
  uint32_t plane = 0;     // bins below it go left
  float cost = infinity;  // sum of area * count of both sides
};

Split best_split(const Histogram& histogram, uint32_t bins) {
  Split best;
  std::array<float, max_bins> right_cost;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& row = histogram.axes[axis];
    Bounds box;
    uint32_t count = 0;
    for (uint32_t i = bins - 1; i > 0; --i) {
      box.grow(row[i].box);
      count += row[i].count;
      right_cost[i] = count > 0 ? half_area(box) * static_cast<float>(count) : infinity;
    }
    box = {};
    count = 0;
    for (uint32_t i = 1; i < bins; ++i) {
      box.grow(row[i - 1].box);
      count += row[i - 1].count;
      if (count == 0) continue;
      const float cost = half_area(box) * static_cast<float>(count) + right_cost[i];
      if (cost < best.cost) best = {axis, i, cost};
    }
  }
  return best;
}

class BinnedSplitter {
 public:
  struct Side {
    float4 offset, scale;
    int axis, plane;
    bool operator()(const Reference& reference) const {
      const float bin = ((centroid2(reference) - offset) * scale)[axis];
      return static_cast<int>(bin) < plane;
    }
  };
  using Scratch = Histogram;

  explicit BinnedSplitter(const BuildOptions& options) : options_(options) {}

  Decision<Side> decide(const Range& range, std::span<const Reference> all,
                        Histogram& histogram) const {
    const uint32_t count = range.size();
    const Binning binning(range, std::min(options_.bins, 4 + count / 20));
    fill(histogram, binning, range, all);
    const Split best = best_split(histogram, binning.bins);
    const float area = half_area(range.box);
    const float leaf_cost = options_.intersection_cost * static_cast<float>(count) * area;
    const float split_cost =
        options_.traversal_cost * area + options_.intersection_cost * best.cost;
    if (count <= options_.max_leaf_size && !(split_cost < leaf_cost)) return {};
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
  static void fill(Histogram& histogram, const Binning& binning, const Range& range,
                   std::span<const Reference> all) {
    histogram.clear(binning.bins);
    if (range.size() < min_parallel) {
      histogram.add(binning, all.subspan(range.begin, range.size()));
      return;
    }
    std::vector<Histogram> pieces((range.size() + chunk_size - 1) / chunk_size);
    for_chunks(range.begin, range.end, [&](size_t chunk, uint32_t begin, uint32_t end) {
      pieces[chunk].clear(binning.bins);
      pieces[chunk].add(binning, all.subspan(begin, end - begin));
    });
    for (const Histogram& piece : pieces)
      histogram.add(piece, binning.bins);
  }

  const BuildOptions& options_;
};

}  // namespace

Bvh build_binned(const BuildInput& input, const BuildOptions& options, BuildLog* log,
                 std::stop_token stop) {
  return TopDown(input, options, log, std::move(stop), BinnedSplitter(options)).build();
}

}  // namespace tracer
