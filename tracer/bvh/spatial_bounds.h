// What splitting space can gain at best, from boxes alone: most nodes need no triangle clipped to
// know that no plane through their slabs is worth it.
#pragma once

#include "tracer/bvh/spatial_binning.h"

namespace tracer {

inline constexpr uint32_t min_bounded = 16;  // references: fewer are clipped as fast

// On each side of a plane lie whole references and pieces of those that cross it. How many is
// known; their box holds the boxes of the whole ones and reaches the plane where a reference
// crosses it. (Where a triangle was clipped before, its box can be larger than what is left of it,
// so the bound is close, not strict.)
class SpatialBounds {
 public:
  void clear(const Slabs& slabs) {
    for (auto& row : axes_)
      std::fill_n(row.begin(), slabs.count, Outline{});
  }

  void add(const Slabs& slabs, const Reference& reference) {
    const Slabbed in(slabs, reference);
    for (int axis = 0; axis < 3; ++axis) {
      Outline& first = axes_[axis][in.first[axis]];
      first.beginning.grow(in.lo, in.hi);
      ++first.begins;
      Outline& last = axes_[axis][in.last[axis]];
      last.ending.grow(in.lo, in.hi);
      ++last.ends;
    }
  }

  void add(const Slabs& slabs, const SpatialBounds& other) {
    for (int axis = 0; axis < 3; ++axis) {
      for (uint32_t i = 0; i < slabs.count; ++i) {
        Outline& outline = axes_[axis][i];
        outline.beginning.grow(other.axes_[axis][i].beginning);
        outline.ending.grow(other.axes_[axis][i].ending);
        outline.begins += other.axes_[axis][i].begins;
        outline.ends += other.axes_[axis][i].ends;
      }
    }
  }

  // Those with a plane that may cost less than `cost` and adds at most `spare` references.
  AxisSet axes_below(float cost, const Slabs& slabs, uint32_t count, uint32_t spare) const {
    AxisSet axes;
    for (int axis = 0; axis < 3; ++axis) {
      if (slabs.per_width[axis] != 0.0f) axes[axis] = least(axis, slabs, count, spare) < cost;
    }
    return axes;
  }

 private:
  struct Outline {
    Bounds beginning, ending;  // of the references whose first or last slab it is
    uint32_t begins = 0, ends = 0;
  };

  float least(int axis, const Slabs& slabs, uint32_t count, uint32_t spare) const {
    const auto& row = axes_[axis];
    std::array<Bounds, max_slabs> right;
    std::array<uint32_t, max_slabs> right_count{};
    for (uint32_t i = slabs.count - 1; i > 0; --i) {
      right[i] = row[i].beginning;
      right_count[i] = row[i].ends;
      if (i + 1 == slabs.count) continue;
      right[i].grow(right[i + 1]);
      right_count[i] += right_count[i + 1];
    }
    float least = infinity;
    Bounds left;
    uint32_t left_count = 0;
    for (uint32_t i = 1; i < slabs.count; ++i) {
      left.grow(row[i - 1].ending);
      left_count += row[i - 1].begins;
      if (left_count == 0 || right_count[i] == 0) continue;
      const uint32_t crossing = left_count + right_count[i] - count;
      if (crossing > spare) continue;
      const bool crossed = crossing > 0;
      const float at = slabs.plane(axis, i);
      least = std::min(least,
                       area(left, crossed, axis, at) * static_cast<float>(left_count) +
                           area(right[i], crossed, axis, at) * static_cast<float>(right_count[i]));
    }
    return least;
  }

  // Half that of a side's box.
  static float area(Bounds box, bool crossed, int axis, float at) {
    if (is_empty(box)) return 0.0f;
    if (crossed) {
      box.lo = min(box.lo, in_lane(axis, at, infinity));
      box.hi = max(box.hi, in_lane(axis, at, -infinity));
    }
    return half_area(box);
  }

  std::array<std::array<Outline, max_slabs>, 3> axes_;
};

}  // namespace tracer
