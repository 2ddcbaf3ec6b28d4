// SBVH (M. Stich, H. Friedrich, A. Dietrich, Spatial Splits in Bounding Volume Hierarchies, 2009):
// where the children of the best object split overlap, space is split instead and references that
// cross the plane are clipped to both sides, unless it is cheaper to leave one whole ("reference
// unsplitting"). Where we differ: references are limited to a budget, which is shared among
// subtrees by their cost, so that the build can be parallel and its memory is known; and most
// planes are ruled out by the boxes of the references, before any triangle is clipped.
#include "tracer/bvh/builders.h"
#include "tracer/bvh/spatial_bounds.h"
#include "tracer/bvh/top_down.h"

namespace tracer {

namespace {

class SpatialSplitter {
 public:
  using Side = BinnedSide;
  struct Scratch {
    Histogram objects;
    SpatialBounds bounds;
    SpatialHistogram<max_slabs> space;
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
    if (overlap > std::max(least_overlap_, min_space_overlap * half_area(range.box))) {
      scratch.split = best_spatial(range, all, min_space_gain * objects.cost, scratch);
    }
    const bool in_space = scratch.split.cost < min_space_gain * objects.cost;
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

  // The fourth lanes say of which triangle.
  static Reference piece(const Reference& whole, const Bounds& part) {
    constexpr int4 fourth{0, 0, 0, -1};
    return {fourth ? whole.lo : part.lo, fourth ? whole.hi : part.hi};
  }

  // Where it may cost less than `cost`.
  SpatialSplit best_spatial(const Range& range, std::span<const Reference> all, float cost,
                            Scratch& scratch) const {
    const Slabs slabs(range.box, slabs_for(range.size()));
    AxisSet axes = all_axes;
    if (range.size() >= min_bounded) {
      sum(scratch.bounds, slabs, range,
          [&](SpatialBounds& bounds, uint32_t i) { bounds.add(slabs, all[i]); });
      axes = scratch.bounds.axes_below(cost, slabs, range.size(), range.spare);
      if (axes.none()) return {};
    }
    sum(scratch.space, slabs, range, [&](SpatialHistogram<max_slabs>& histogram, uint32_t i) {
      histogram.add(slabs, all[i], corners(all[i]), axes);
    });
    return scratch.space.best(slabs, range.size(), range.spare);
  }

  // Anew; add(sums, i) for each reference of a range.
  template <class Sums, class Add>
  static void sum(Sums& sums, const Slabs& slabs, const Range& range, const Add& add) {
    const auto sum_part = [&](Sums& part, uint32_t begin, uint32_t end) {
      part.clear(slabs);
      for (uint32_t i = begin; i < end; ++i)
        add(part, i);
    };
    if (range.size() < min_parallel) {
      sum_part(sums, range.begin, range.end);
      return;
    }
    std::vector<Sums> parts((range.size() + chunk_size - 1) / chunk_size);
    for_chunks(range.begin, range.end, [&](size_t chunk, uint32_t begin, uint32_t end) {
      sum_part(parts[chunk], begin, end);
    });
    sums.clear(slabs);
    for (const Sums& part : parts)
      sums.add(slabs, part);
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
