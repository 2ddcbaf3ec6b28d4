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
    const SlabRange in(slabs, reference);
    for (int axis = 0; axis < 3; ++axis) {
      Outline& begin = axes_[axis][in.first[axis]];
      begin.first.grow(in.lo, in.hi);
      ++begin.begins;
      Outline& end = axes_[axis][in.last[axis]];
      end.last.grow(in.lo, in.hi);
      ++end.ends;
    }
  }

  void add(const Slabs& slabs, const SpatialBounds& other) {
    for (int axis = 0; axis < 3; ++axis) {
      for (uint32_t i = 0; i < slabs.count; ++i) {
        Outline& outline = axes_[axis][i];
        outline.first.grow(other.axes_[axis][i].first);
        outline.last.grow(other.axes_[axis][i].last);
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
    Bounds first, last;  // of the references whose first or last slab it is
    uint32_t begins = 0, ends = 0;

    const Bounds& beginning() const { return first; }
    const Bounds& ending() const { return last; }
  };

  float least(int axis, const Slabs& slabs, uint32_t count, uint32_t spare) const {
    float least = infinity;
    for_planes(
        axes_[axis], slabs, count, spare, [&](uint32_t i, const Side& left, const Side& right) {
          const bool crossed = left.count + right.count > count;
          const float at = slabs.plane(axis, i);
          least = std::min(least, cost(left, crossed, axis, at) + cost(right, crossed, axis, at));
        });
    return least;
  }

  static float cost(const Side& side, bool crossed, int axis, float at) {
    if (is_empty(side.box)) return 0.0f;
    Bounds box = side.box;
    if (crossed) {
      box.lo = min(box.lo, in_lane(axis, at, infinity));
      box.hi = max(box.hi, in_lane(axis, at, -infinity));
    }
    return half_area(box) * static_cast<float>(side.count);
  }

  std::array<std::array<Outline, max_slabs>, 3> axes_;
};

}  // namespace tracer
