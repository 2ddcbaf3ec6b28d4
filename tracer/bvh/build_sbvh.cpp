// SBVH (M. Stich, H. Friedrich, A. Dietrich, Spatial Splits in Bounding Volume Hierarchies, 2009):
// where the children of the best object split overlap, space is split instead and references that
// cross the plane are clipped to both sides, unless it is cheaper to leave one whole ("reference
// unsplitting"). Where we differ: references are limited to a budget, which is shared among
// subtrees by their cost, so that the build can be parallel and its memory is
// known.
#include <array>
#include <cmath>

#include "tracer/bvh/binning.h"
#include "tracer/bvh/builders.h"
#include "tracer/bvh/clip.h"
#include "tracer/bvh/top_down.h"

namespace tracer {

namespace {

constexpr uint32_t max_slabs = 16;
constexpr float worth_it = 0.99f;  // of the cost of the object split
constexpr float min_share = 0.1f;  // of the node's area that its halves overlap (as in Embree)

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

struct Slab {
  Bounds box;                     // of the pieces in it
  uint32_t begins = 0, ends = 0;  // references whose first or last slab it is
};

struct SpatialSplit {
  int axis = -1;  // -1: none
  float at = 0.0f;
  float cost = infinity;  // sum of area * count of both sides
  Bounds left, right;
  uint32_t left_count = 0, right_count = 0;
};

class SpatialHistogram {
 public:
  void clear(const Slabs& slabs) {
    for (auto& row : axes_)
      std::fill_n(row.begin(), slabs.count, Slab{});
  }

  void add(const Slabs& slabs, const Reference& reference, const Corners& corners) {
    float4 lo = reference.lo, hi = reference.hi;
    lo[3] = hi[3] = 0.0f;  // an index is there, often a denormal
    const int4 first = slabs.slab_of(lo), last = slabs.slab_of(hi);
    for (int axis = 0; axis < 3; ++axis) {
      if (slabs.per_width[axis] == 0.0f) continue;
      auto& row = axes_[axis];
      const auto begin = static_cast<uint32_t>(first[axis]);
      auto end = static_cast<uint32_t>(last[axis]);
      if (end > begin && slabs.plane(axis, end) >= hi[axis]) --end;
      Bounds rest{lo, hi};
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
      const auto& row = axes_[axis];
      std::array<Bounds, max_slabs> right;
      std::array<uint32_t, max_slabs> right_count{};
      for (uint32_t i = slabs.count - 1; i > 0; --i) {
        right[i] = row[i].box;
        right_count[i] = row[i].ends;
        if (i + 1 == slabs.count) continue;
        right[i].grow(right[i + 1]);
        right_count[i] += right_count[i + 1];
      }
      Bounds left;
      uint32_t left_count = 0;
      for (uint32_t i = 1; i < slabs.count; ++i) {
        left.grow(row[i - 1].box);
        left_count += row[i - 1].begins;
        if (left_count == 0 || right_count[i] == 0) continue;
        if (left_count + right_count[i] - count > spare) continue;
        const float cost = half_area(left) * static_cast<float>(left_count) +
                           half_area(right[i]) * static_cast<float>(right_count[i]);
        if (cost < best.cost) {
          best = {axis, slabs.plane(axis, i), cost, left, right[i], left_count, right_count[i]};
        }
      }
    }
    return best;
  }

 private:
  std::array<std::array<Slab, max_slabs>, 3> axes_;
};

// Of the box that both children of an object split claim; 0 without one.
float overlap_area(const Histogram& histogram, uint32_t bins, const ObjectSplit& split) {
  if (split.axis < 0) return infinity;
  Bounds left, right;
  for (uint32_t i = 0; i < bins; ++i)
    (i < split.plane ? left : right).grow(histogram.axes[split.axis][i].box);
  const Bounds common{max(left.lo, right.lo), min(left.hi, right.hi)};
  return is_empty(common) ? 0.0f : half_area(common);
}

class SpatialSplitter {
 public:
  using Side = BinnedSide;
  struct Scratch {
    Histogram objects;
    SpatialHistogram space;
    SpatialSplit split;
    std::vector<Reference> left, right;
  };

  SpatialSplitter(const BuildInput& input, const BuildOptions& options)
      : input_(input), options_(options) {
    Bounds root;
    for (const Box& box : input.boxes) {
      root.grow(float4{box.lo.x, box.lo.y, box.lo.z, 0.0f},
                float4{box.hi.x, box.hi.y, box.hi.z, 0.0f});
    }
    least_overlap_ = options.min_overlap * half_area(root);
  }

  uint32_t spare(uint32_t references) const {
    if (input_.mesh == nullptr) return 0;
    const auto triangles = static_cast<float>(input_.mesh->triangles.size());
    const float allowed = triangles * (1.0f + options_.split_budget);
    return static_cast<uint32_t>(std::max(allowed - static_cast<float>(references), 0.0f));
  }

  Decision<Side> decide(const Range& range, std::span<const Reference> all,
                        Scratch& scratch) const {
    const uint32_t count = range.size();
    const Binning binning(range, std::min(options_.bins, 4 + count / 10));
    fill(scratch.objects, binning, range, all);
    const ObjectSplit objects = best_split(scratch.objects, binning.bins);
    scratch.split = {};
    const float overlap =
        range.spare > 0 ? overlap_area(scratch.objects, binning.bins, objects) : 0;
    if (overlap > std::max(least_overlap_, min_share * half_area(range.box))) {
      scratch.split = best_spatial(range, all, scratch.space);
    }
    const bool in_space = scratch.split.cost < worth_it * objects.cost;
    const float cost = in_space ? scratch.split.cost : objects.cost;
    const float area = half_area(range.box);
    if (count <= options_.max_leaf_size &&
        !(split_cost(options_, area, cost) < leaf_cost(options_, count, area))) {
      return {};
    }
    Decision<Side> decision;
    if (in_space) {
      decision.kind = DecisionKind::clip;
    } else if (objects.axis < 0) {
      if (count > options_.max_leaf_size) decision.kind = DecisionKind::halve;
    } else {
      decision.kind = DecisionKind::split;
      decision.side = {binning.offset, binning.scale, objects.axis,
                       static_cast<int>(objects.plane)};
    }
    return decision;
  }

  // Each side keeps what is only there; the others are clipped, or left whole on one side while
  // that is cheaper or there is no place for another reference.
  void clip(const Range& range, std::span<const Reference> all, Scratch& scratch) const {
    SpatialSplit split = scratch.split;
    scratch.left.clear();
    scratch.right.clear();
    uint32_t spare = range.spare;
    auto left_count = static_cast<float>(split.left_count);
    auto right_count = static_cast<float>(split.right_count);
    for (const Reference& reference : all.subspan(range.begin, range.size())) {
      if (reference.hi[split.axis] <= split.at) {
        scratch.left.push_back(reference);
        continue;
      }
      if (reference.lo[split.axis] >= split.at) {
        scratch.right.push_back(reference);
        continue;
      }
      const Bounds box{reference.lo, reference.hi};
      const Clipped parts = tracer::clip(corners(reference), box, split.axis, split.at);
      Bounds all_left = split.left, all_right = split.right;
      all_left.grow(box);
      all_right.grow(box);
      const float left_area = half_area(split.left), right_area = half_area(split.right);
      const float both = left_area * left_count + right_area * right_count;
      const float only_left = half_area(all_left) * left_count + right_area * (right_count - 1.0f);
      const float only_right = left_area * (left_count - 1.0f) + half_area(all_right) * right_count;
      const bool can_split = spare > 0 && !is_empty(parts.left) && !is_empty(parts.right);
      if (can_split && both <= std::min(only_left, only_right)) {
        --spare;
        scratch.left.push_back(piece(reference, parts.left));
        scratch.right.push_back(piece(reference, parts.right));
      } else if (only_left <= only_right) {
        scratch.left.push_back(reference);
        split.left = all_left;
        right_count -= 1.0f;
      } else {
        scratch.right.push_back(reference);
        split.right = all_right;
        left_count -= 1.0f;
      }
    }
    // All on one side after all.
    auto &left = scratch.left, &right = scratch.right;
    if (left.empty() || right.empty()) {
      auto &from = left.empty() ? right : left, &to = left.empty() ? left : right;
      const auto half = from.begin() + static_cast<std::ptrdiff_t>(from.size() / 2);
      to.assign(half, from.end());
      from.erase(half, from.end());
    }
  }

 private:
  Corners corners(const Reference& reference) const {
    return corners_of(*input_.mesh, primitive_of(input_, primitive(reference)));
  }

  static Reference piece(const Reference& whole, const Bounds& part) {
    Reference result{part.lo, part.hi};
    result.lo[3] = whole.lo[3];
    result.hi[3] = whole.hi[3];
    return result;
  }

  SpatialSplit best_spatial(const Range& range, std::span<const Reference> all,
                            SpatialHistogram& histogram) const {
    const Slabs slabs(range.box, std::min(max_slabs, 4 + range.size() / 16));
    const auto add = [&](SpatialHistogram& to, uint32_t begin, uint32_t end) {
      to.clear(slabs);
      for (uint32_t i = begin; i < end; ++i)
        to.add(slabs, all[i], corners(all[i]));
    };
    if (range.size() < min_parallel) {
      add(histogram, range.begin, range.end);
    } else {
      std::vector<SpatialHistogram> pieces((range.size() + chunk_size - 1) / chunk_size);
      for_chunks(range.begin, range.end, [&](size_t chunk, uint32_t begin, uint32_t end) {
        add(pieces[chunk], begin, end);
      });
      histogram.clear(slabs);
      for (const SpatialHistogram& piece : pieces)
        histogram.add(slabs, piece);
    }
    return histogram.best(slabs, range.size(), range.spare);
  }

  const BuildInput& input_;
  const BuildOptions& options_;
  float least_overlap_ = 0.0f;
};

}  // namespace

Bvh build_sbvh(const BuildInput& input, const BuildOptions& options, BuildLog* log,
               std::stop_token stop) {
  return TopDown(input, options, log, std::move(stop), SpatialSplitter(input, options)).build();
}

}  // namespace tracer
