// Space in equal slabs on each axis, what of the triangles is in each, and the plane between two
// slabs with the lowest SAH cost (M. Stich, H. Friedrich, A. Dietrich, Spatial Splits in Bounding
// Volume Hierarchies, 2009).
#pragma once

#include <array>
#include <bitset>
#include <cmath>

#include "tracer/bvh/binning.h"
#include "tracer/bvh/clip.h"

namespace tracer {

inline constexpr uint32_t max_slabs = 16;       // that builders use
inline constexpr float min_space_gain = 0.99f;  // times the cost of the object split: worth it
inline constexpr float min_space_overlap =
    0.1f;  // of the node's area that the halves of an object split claim both (as in Embree)

using AxisSet = std::bitset<3>;
inline const AxisSet all_axes{7};

// Planes that cut a box into equal slabs, on each axis.
struct Slabs {
  uint32_t count;
  float4 lo, width, per_width;

  Slabs(const Bounds& box, uint32_t slabs)
      : count(slabs),
        lo(box.lo),
        width((box.hi - box.lo) * broadcast(1.0f / static_cast<float>(slabs))) {
    for (int axis = 0; axis < 3; ++axis) {
      const float inverse = 1.0f / width[axis];
      per_width[axis] = std::isfinite(inverse) ? inverse : 0.0f;  // a flat axis has no planes
    }
    lo[3] = width[3] = per_width[3] = 0.0f;
  }
  float plane(int axis, uint32_t index) const {
    return lo[axis] + width[axis] * static_cast<float>(index);
  }
  int4 slab_of(float4 point) const {
    const int4 index = __builtin_convertvector((point - lo) * per_width, int4);
    const auto end = static_cast<int>(count) - 1;
    const int4 last = {end, end, end, 0};
    return index < last ? index : last;
  }
};

// The first and last slab that a reference is in, on each axis. The index in its fourth lanes,
// often a denormal, is taken out.
struct SlabRange {
  float4 lo, hi;
  int4 first, last;

  SlabRange(const Slabs& slabs, const Reference& reference)
      : lo(three(reference.lo)), hi(three(reference.hi)) {
    first = slabs.slab_of(lo);
    last = slabs.slab_of(hi);
    // What only touches the plane before its last slab is not in it.
    const float4 plane = slabs.lo + slabs.width * __builtin_convertvector(last, float4);
    last += (last > first) & (plane >= hi);  // a lane that holds is -1
  }

 private:
  // Not lane by lane, which would go through memory.
  static float4 three(float4 lanes) {
    return __builtin_bit_cast(float4, __builtin_bit_cast(int4, lanes) & int4{-1, -1, -1, 0});
  }
};

struct Slab {
  Bounds box;                     // of the pieces in it
  uint32_t begins = 0, ends = 0;  // references whose first or last slab it is

  const Bounds& beginning() const { return box; }
  const Bounds& ending() const { return box; }
};

// What is on one side of a plane.
struct Side {
  Bounds box;
  uint32_t count = 0;

  void add(const Bounds& more, uint32_t references) {
    box.grow(more);
    count += references;
  }
};

// visit(i, left, right) for the plane before each slab i that has references on both sides and adds
// at most `spare` to `count`. Left of it are the slabs' endings, right of it their beginnings.
template <class Piece, size_t most, class Visit>
void for_planes(const std::array<Piece, most>& row, const Slabs& slabs, uint32_t count,
                uint32_t spare, const Visit& visit) {
  std::array<Side, most> right;
  Side behind;
  for (uint32_t i = slabs.count - 1; i > 0; --i) {
    behind.add(row[i].beginning(), row[i].ends);
    right[i] = behind;
  }
  Side left;
  for (uint32_t i = 1; i < slabs.count; ++i) {
    left.add(row[i - 1].ending(), row[i - 1].begins);
    if (left.count == 0 || right[i].count == 0) continue;
    if (left.count + right[i].count - count <= spare) visit(i, left, right[i]);
  }
}

struct SpatialSplit {
  int axis = -1;  // -1: none
  float at = 0.0f;
  float cost = infinity;  // sum of area * count of both sides
  Bounds left, right;
  uint32_t left_count = 0, right_count = 0;
};

// Of at most `most` slabs.
template <uint32_t most>
class SpatialHistogram {
 public:
  void clear(const Slabs& slabs) {
    for (auto& row : axes_)
      std::fill_n(row.begin(), slabs.count, Slab{});
  }

  // On some axes.
  void add(const Slabs& slabs, const Reference& reference, const Corners& corners,
           AxisSet axes = all_axes) {
    const SlabRange in(slabs, reference);
    for (int axis = 0; axis < 3; ++axis) {
      if (slabs.per_width[axis] == 0.0f || !axes[axis]) continue;
      auto& row = axes_[axis];
      const auto begin = static_cast<uint32_t>(in.first[axis]);
      const auto end = static_cast<uint32_t>(in.last[axis]);
      Bounds rest{in.lo, in.hi};
      for (uint32_t i = begin; i < end; ++i) {
        const Clipped parts = clip(corners, rest, axis, slabs.plane(axis, i + 1));
        if (!is_empty(parts.left)) row[i].box.grow(parts.left);
        rest = parts.right;
        if (is_empty(rest)) break;
      }
      if (!is_empty(rest)) row[end].box.grow(rest);
      ++row[begin].begins;
      ++row[end].ends;
    }
  }

  void add(const Slabs& slabs, const SpatialHistogram& other) {
    for (int axis = 0; axis < 3; ++axis) {
      for (uint32_t i = 0; i < slabs.count; ++i) {
        Slab& slab = axes_[axis][i];
        slab.box.grow(other.axes_[axis][i].box);
        slab.begins += other.axes_[axis][i].begins;
        slab.ends += other.axes_[axis][i].ends;
      }
    }
  }

  // Among those that add at most `spare` references.
  SpatialSplit best(const Slabs& slabs, uint32_t count, uint32_t spare) const {
    SpatialSplit best;
    for (int axis = 0; axis < 3; ++axis) {
      for_planes(
          axes_[axis], slabs, count, spare, [&](uint32_t i, const Side& left, const Side& right) {
            const float cost = half_area(left.box) * static_cast<float>(left.count) +
                               half_area(right.box) * static_cast<float>(right.count);
            if (!(cost < best.cost)) return;
            best = {axis, slabs.plane(axis, i), cost, left.box, right.box, left.count, right.count};
          });
    }
    return best;
  }

  std::span<const Slab> axis(int index) const { return axes_[index]; }

 private:
  std::array<std::array<Slab, most>, 3> axes_;
};

// Of the box that both children of an object split claim; 0 without one.
inline float overlap_area(const Histogram& histogram, uint32_t bins, const ObjectSplit& split) {
  if (split.axis < 0) return infinity;
  Bounds left, right;
  for (uint32_t i = 0; i < bins; ++i)
    (i < split.plane ? left : right).grow(histogram.axes[split.axis][i].box);
  const Bounds common{max(left.lo, right.lo), min(left.hi, right.hi)};
  return is_empty(common) ? 0.0f : half_area(common);
}

// Few for few references.
inline uint32_t slabs_for(uint32_t references) {
  return std::min(max_slabs, 4 + references / 64);
}

}  // namespace tracer
