// Centroids in bins on each axis, and the plane between two bins with the lowest SAH cost
// (I. Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, 2007). Where we differ:
// the number of bins shrinks with the node (4 + n/20, as Embree does) and all three axes are tried.
#pragma once

#include <array>
#include <cmath>
#include <span>

#include "tracer/bvh/build_parts.h"

namespace tracer {

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

struct ObjectSplit {
  int axis = -1;          // -1: no plane has references on both sides
  uint32_t plane = 0;     // bins below it go left
  float cost = infinity;  // sum of area * count of both sides
};

inline ObjectSplit best_split(const Histogram& histogram, uint32_t bins) {
  ObjectSplit best;
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

// The decision to go left of the plane.
struct BinnedSide {
  float4 offset, scale;
  int axis, plane;
  bool operator()(const Reference& reference) const {
    const float bin = ((centroid2(reference) - offset) * scale)[axis];
    return static_cast<int>(bin) < plane;
  }
};

inline uint32_t bins_for(uint32_t references, const BuildOptions& options) {
  return std::min(options.bins, 4 + references / 20);
}

// Anew, from the references of a range.
void fill(Histogram& histogram, const Binning& binning, const Range& range,
          std::span<const Reference> all);

}  // namespace tracer
