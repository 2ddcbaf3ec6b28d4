// What the builders share: primitives as boxes, four floats at a time, and ranges of them.
#pragma once

#include <bit>
#include <vector>

#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include "tracer/bvh/build.h"
#include "tracer/math/simd.h"
#include "tracer/untouched.h"

namespace tracer {

inline constexpr size_t chunk_size = 8192;          // references a parallel pass hands to one task
inline constexpr uint32_t min_parallel = 1u << 14;  // smaller nodes are one task

// A primitive while the tree is built. The fourth lanes are free: lo carries the primitive's index.
struct Reference {
  float4 lo, hi;
};

inline uint32_t primitive(const Reference& reference) {
  return std::bit_cast<uint32_t>(reference.lo[3]);
}
// Twice the centroid: spares a multiplication.
inline float4 centroid2(const Reference& reference) {
  return reference.lo + reference.hi;
}

struct Bounds {
  float4 lo = broadcast(infinity);
  float4 hi = broadcast(-infinity);

  void grow(float4 other_lo, float4 other_hi) {
    lo = min(lo, other_lo);
    hi = max(hi, other_hi);
  }
  void grow(const Bounds& other) { grow(other.lo, other.hi); }
};

inline float half_area(const Bounds& bounds) {
  const float4 e = bounds.hi - bounds.lo;
  return e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
}

inline int longest_axis(const Bounds& bounds) {
  const float4 size = bounds.hi - bounds.lo;
  return size[0] >= size[1] ? (size[0] >= size[2] ? 0 : 2) : (size[1] >= size[2] ? 1 : 2);
}

// References [begin, end) with their bounds and those of their (doubled) centroids.
struct Range {
  uint32_t begin = 0, end = 0;
  Bounds box, centroids;
  uint32_t spare = 0;  // places behind `end` for references that spatial splits add

  uint32_t size() const { return end - begin; }
};

inline void add(Range& range, const Reference& reference) {
  range.box.grow(reference.lo, reference.hi);
  const float4 c = centroid2(reference);
  range.centroids.grow(c, c);
}

// SAH times the area of the root: of a leaf, and of a node whose children's area * count sum to
// `children`.
inline float leaf_cost(const BuildOptions& options, uint32_t count, float area) {
  return options.intersection_cost * static_cast<float>(count) * area;
}
inline float split_cost(const BuildOptions& options, float area, float children) {
  return options.traversal_cost * area + options.intersection_cost * children;
}

inline void set_box(BvhNode& node, const Bounds& box) {
  node.lo = xyz(box.lo);
  node.hi = xyz(box.hi);
}

// function(chunk, begin, end) for consecutive pieces of [begin, end), in parallel.
template <class Function>
void for_chunks(uint32_t begin, uint32_t end, const Function& function) {
  const size_t chunks = (end - begin + chunk_size - 1) / chunk_size;
  tbb::parallel_for(size_t{0}, chunks, [&](size_t chunk) {
    const uint32_t from = begin + static_cast<uint32_t>(chunk * chunk_size);
    function(chunk, from, std::min<uint32_t>(end, from + chunk_size));
  });
}

inline constexpr uint32_t min_task = 4096;  // primitives of a subtree that is worth a task

// Two subtrees of together `count` primitives, at the same time if that is worth it.
template <class Left, class Right>
void run_both(uint32_t count, const Left& left, const Right& right) {
  if (count < min_task) {
    left();
    right();
    return;
  }
  tbb::task_group tasks;
  tasks.run(left);
  right();
  tasks.wait();
}

UntouchedVector<Reference> references_of(const BuildInput& input);

// The range with its bounds measured anew.
Range measured(std::span<const Reference> references, uint32_t begin, uint32_t end);

}  // namespace tracer
