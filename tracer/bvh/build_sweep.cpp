// Sweep SAH: every plane between two centroids on every axis (J. MacDonald, K. Booth, Heuristics
// for Ray Tracing using Space Subdivision, 1990; I. Wald, V. Havran, On Building Fast kd-Trees for
// Ray Tracing, and on Doing That in O(N log N), 2006). The primitives are sorted once an axis; a
// stable partition keeps the three orders.
#include <algorithm>
#include <array>
#include <bit>

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include "tracer/bvh/build_parts.h"
#include "tracer/bvh/builders.h"
#include "tracer/bvh/tree_edit.h"

namespace tracer {

namespace {

struct Split {
  float cost = infinity;  // sum of area * count of both sides
  int axis = 0;
  uint32_t middle = 0;  // first on the right
};

class Builder {
 public:
  Builder(const BuildInput& input, const BuildOptions& options, BuildLog* log, std::stop_token stop)
      : options_(options), log_(log), stop_(std::move(stop)), references_(references_of(input)) {
    const size_t count = references_.size();
    tbb::parallel_for(0, 3, [&](int axis) {
      Axis& a = axes_[axis];
      a.right_cost.resize(count);
      a.moved.resize(count);
      a.order.resize(count);
      for (uint32_t i = 0; i < count; ++i)
        a.order[i] = i;
      tbb::parallel_sort(a.order.begin(), a.order.end(), [&](uint32_t x, uint32_t y) {
        const float at_x = centroid2(references_[x])[axis], at_y = centroid2(references_[y])[axis];
        return at_x != at_y ? at_x < at_y : x < y;
      });
    });
    goes_left_.resize(count);
    nodes_.resize(2 * count - 1);
  }

  Bvh build() {
    split(0, 0, static_cast<uint32_t>(references_.size()), 1, 0);
    if (stop_.stop_requested()) return {};
    return depth_first(nodes_, axes_[0].order);
  }

 private:
  struct Axis {
    std::vector<uint32_t> order;    // primitives by centroid
    std::vector<uint32_t> moved;    // target of the partition
    std::vector<float> right_cost;  // area * count of what begins here
  };

  // Makes `node` of the primitives [begin, end) of each order. Below it is room for
  // 2 (end - begin - 1) nodes from `room` on; leaves leave gaps.
  void split(uint32_t node, uint32_t begin, uint32_t end, uint32_t room, uint32_t depth) {
    const uint32_t count = end - begin;
    Bounds box;
    for (uint32_t i = begin; i < end; ++i) {
      const Reference& reference = references_[axes_[0].order[i]];
      box.grow(reference.lo, reference.hi);
    }
    set_box(nodes_[node], box);
    const Split best = choose(begin, end, half_area(box), depth);
    if (best.middle == begin || stop_.stop_requested()) {
      nodes_[node].first = begin;
      nodes_[node].count = count;
      if (log_) log_->placed += count;
      return;
    }
    partition(begin, end, best);
    nodes_[node].first = room;
    nodes_[node].count = 0;
    const auto left = [&] { split(room, begin, best.middle, room + 2, depth + 1); };
    const auto right = [&] {
      split(room + 1, best.middle, end, room + 2 * (best.middle - begin), depth + 1);
    };
    run_both(count, left, right);
  }

  // middle == begin: a leaf.
  Split choose(uint32_t begin, uint32_t end, float area, uint32_t depth) {
    const uint32_t count = end - begin;
    const bool may_be_leaf = count <= options_.max_leaf_size;
    const Split leaf{0.0f, 0, begin}, halves{0.0f, 0, begin + count / 2};
    if (count == 1 || depth >= options_.max_depth) return leaf;
    if (options_.max_depth - depth <= std::bit_width(count)) return may_be_leaf ? leaf : halves;
    std::array<Split, 3> best;
    if (count < min_task) {
      for (int axis = 0; axis < 3; ++axis)
        best[axis] = sweep(axis, begin, end);
    } else {
      tbb::parallel_for(0, 3, [&](int axis) { best[axis] = sweep(axis, begin, end); });
    }
    const Split& least = *std::min_element(
        best.begin(), best.end(), [](const Split& a, const Split& b) { return a.cost < b.cost; });
    if (may_be_leaf &&
        !(split_cost(options_, area, least.cost) < leaf_cost(options_, count, area))) {
      return leaf;
    }
    // Equal boxes: no plane gains anything.
    return least.cost < static_cast<float>(count) * area ? least : halves;
  }

  Split sweep(int axis, uint32_t begin, uint32_t end) {
    Axis& a = axes_[axis];
    Bounds box;
    for (uint32_t i = end; i-- > begin + 1;) {
      const Reference& reference = references_[a.order[i]];
      box.grow(reference.lo, reference.hi);
      a.right_cost[i] = half_area(box) * static_cast<float>(end - i);
    }
    Split best;
    box = {};
    for (uint32_t i = begin + 1; i < end; ++i) {
      const Reference& reference = references_[a.order[i - 1]];
      box.grow(reference.lo, reference.hi);
      const float cost = half_area(box) * static_cast<float>(i - begin) + a.right_cost[i];
      if (cost < best.cost) best = {cost, axis, i};
    }
    return best;
  }

  void partition(uint32_t begin, uint32_t end, const Split& split) {
    const std::vector<uint32_t>& order = axes_[split.axis].order;
    for (uint32_t i = begin; i < end; ++i)
      goes_left_[order[i]] = i < split.middle;
    const auto move = [&](int axis) {
      if (axis == split.axis) return;
      Axis& a = axes_[axis];
      uint32_t left = begin, right = split.middle;
      for (uint32_t i = begin; i < end; ++i)
        a.moved[goes_left_[a.order[i]] ? left++ : right++] = a.order[i];
      std::copy(a.moved.begin() + begin, a.moved.begin() + end, a.order.begin() + begin);
    };
    if (end - begin < min_task) {
      for (int axis = 0; axis < 3; ++axis)
        move(axis);
    } else {
      tbb::parallel_for(0, 3, move);
    }
  }

  const BuildOptions& options_;
  BuildLog* log_;
  std::stop_token stop_;
  UntouchedVector<Reference> references_;
  std::array<Axis, 3> axes_;
  std::vector<uint8_t> goes_left_;  // by primitive
  std::vector<BvhNode> nodes_;
};

}  // namespace

Bvh build_sweep(const BuildInput& input, const BuildOptions& options, BuildLog* log,
                std::stop_token stop) {
  return Builder(input, options, log, std::move(stop)).build();
}

}  // namespace tracer
