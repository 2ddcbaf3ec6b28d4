// How much of a BVH's boxes is shared or empty.
// Every definition is on closed boxes. Two boxes that only touch, that is whose common part has no
// extent along an axis along which both have one, do not overlap; flat boxes in one plane may.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "tracer/bvh/scene_bvh.h"
#include "tracer/render/film.h"

namespace tracer {

// Means over the inner nodes n, with children l and r, weighted by the area A(n), that is by how
// often random lines come by. 0 for a tree without inner nodes.
struct Overlap {
  // sum A(l and r in common) / sum A(n): how often a line through n meets what both children claim.
  double siblings = 0.0;
  // sum A(n) (1 - (V(l) + V(r) - V(l and r in common)) / V(n)) / sum A(n): the part of n that is in
  // neither child. V is length, area or volume, by how many extents n has.
  double empty_space = 0.0;
};

Overlap overlap(const Bvh& tree);

// Of one inner node over its children: the sum over pairs of A(in common) / A(node), and the part
// of V(node) in no child. 0 where the node has no area.
struct ChildFit {
  double overlap = 0.0;
  double empty_space = 0.0;  // 0..1
};
ChildFit child_fit(const Box& node, std::span<const Box> children);

// What two boxes have in common; empty if they only touch.
Box common(const Box& a, const Box& b);

Overlap blas_overlap(const SceneBvh& bvh);  // weighted by triangles

// Instances a and b, a < b: A(boxes in common) / min(A(a), A(b)), 0..1.
struct InstancePair {
  uint32_t a, b;
  float overlap;
};

struct InstanceOverlap {
  // The sum over all other instances, as a mean over the instances: how many whole neighbours an
  // instance shares its box with.
  double mean = 0.0;
  double mean_neighbours = 0.0;     // instances that a box overlaps, however little
  uint64_t instances_asked = 0;     // evenly chosen ones stand for all if there are too many
  std::vector<InstancePair> worst;  // at most 16, the largest overlap first
};

// Found through the TLAS, not by trying all pairs. Stopped: nothing.
InstanceOverlap instance_overlap(const SceneBvh& bvh, const std::stop_token& stop);

// Of the primary rays of pass 0: the share of BLASes entered that did not give the ray's hit.
struct WastedEntries {
  uint64_t entries = 0;
  uint64_t hits = 0;
};
WastedEntries wasted_entries(const Film& film);
inline double share(const WastedEntries& wasted) {
  return wasted.entries > 0 ? 1.0 - double(wasted.hits) / double(wasted.entries) : 0.0;
}

}  // namespace tracer
