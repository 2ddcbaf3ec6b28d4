// Tree rotations (A. Kensler, Tree Rotations for Improving Bounding Volume Hierarchies, 2008):
// bottom-up, a child changes places with a child of its sibling where that makes the sibling's box
// smallest. Where we differ: no simulated annealing.
#include <algorithm>
#include <array>

#include "tracer/bvh/optimizers.h"
#include "tracer/bvh/tree_edit.h"

namespace tracer {

namespace {

constexpr int passes = 4;  // the gain halves with each

// The best of the four swaps below a node, if any; true if there was one.
bool rotate_at(std::vector<BvhNode, SiblingAllocator<BvhNode>>& nodes, const BvhNode& parent) {
  float best_gain = 0.0f;
  uint32_t best_child = 0, best_grandchild = 0;
  for (const uint32_t side : {0u, 1u}) {
    const uint32_t child = parent.first + side;               // goes down
    const BvhNode& sibling = nodes[parent.first + 1 - side];  // one of its children comes up
    if (is_leaf(sibling)) continue;
    for (const uint32_t grandside : {0u, 1u}) {
      const BvhNode& stays = nodes[sibling.first + 1 - grandside];
      const float after = half_area(united(box_of(nodes[child]), box_of(stays)));
      const float gain = half_area(box_of(sibling)) - after;
      if (gain <= best_gain) continue;
      best_gain = gain;
      best_child = child;
      best_grandchild = sibling.first + grandside;
    }
  }
  if (best_gain <= 0.0f) return false;
  std::swap(nodes[best_child], nodes[best_grandchild]);
  const uint32_t other = parent.first + (best_child == parent.first ? 1 : 0);
  BvhNode& sibling = nodes[other];
  const Box box = united(box_of(nodes[sibling.first]), box_of(nodes[sibling.first + 1]));
  sibling.lo = box.lo;
  sibling.hi = box.hi;
  return true;
}

}  // namespace

void rotate(Bvh& bvh, const BuildOptions&, BuildLog* log, const std::stop_token& stop) {
  for (int pass = 0; pass < passes && !stop.stop_requested(); ++pass) {
    bool changed = false;
    // Children before parents; a swap moves subtrees only below the node, all of them done.
    for (size_t i = bvh.nodes.size(); i-- > 0;) {
      if (!is_leaf(bvh.nodes[i])) changed = rotate_at(bvh.nodes, bvh.nodes[i]) || changed;
    }
    if (!changed) return;
    bvh = depth_first(bvh.nodes, bvh.references);
    if (log) log->optimized += bvh.references.size() / passes;
  }
}

}  // namespace tracer
