// Tree rotations (A. Kensler, Tree Rotations for Improving Bounding Volume Hierarchies, 2008):
// bottom-up, a child changes places with a child of its sibling where that makes the sibling's box
// smallest. Where we differ: no simulated annealing.
#include <algorithm>

#include <tbb/parallel_invoke.h>

#include "tracer/bvh/build_steps.h"
#include "tracer/bvh/optimizers.h"
#include "tracer/bvh/tree_edit.h"

namespace tracer {

namespace {

constexpr int passes = 4;                // the gain halves with each
constexpr uint32_t serial_nodes = 4096;  // a subtree that is not worth a task

using Nodes = std::vector<BvhNode, SiblingAllocator<BvhNode>>;

// The best of the four swaps below a node, if any; true if there was one.
bool rotate_at(Nodes& nodes, const BvhNode& parent, BuildSteps* steps = nullptr) {
  if (is_leaf(parent)) return false;
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
  const uint32_t other = parent.first + (best_child == parent.first ? 1 : 0);
  BvhNode& sibling = nodes[other];
  if (steps != nullptr) {
    record_move(*steps, {box_of(nodes[best_child]), box_of(nodes[best_grandchild]), box_of(sibling),
                         best_gain});
  }
  std::swap(nodes[best_child], nodes[best_grandchild]);
  const Box box = united(box_of(nodes[sibling.first]), box_of(nodes[sibling.first + 1]));
  sibling.lo = box.lo;
  sibling.hi = box.hi;
  return true;
}

// The node and everything below it, which is its pair of children and what follows up to `end`, as
// depth-first order has it. Children before parents: a swap moves subtrees only below the node, all
// of them done. The same for any number of threads.
bool rotate_subtree(Nodes& nodes, uint32_t node, uint32_t end) {
  if (is_leaf(nodes[node])) return false;
  const uint32_t pair = nodes[node].first;
  bool left = false, right = false;
  if (end - pair < serial_nodes) {
    for (uint32_t i = end; i-- > pair;)
      left = rotate_at(nodes, nodes[i]) || left;
  } else {
    const uint32_t middle = is_leaf(nodes[pair + 1]) ? end : nodes[pair + 1].first;
    tbb::parallel_invoke([&] { left = rotate_subtree(nodes, pair, middle); },
                         [&] { right = rotate_subtree(nodes, pair + 1, end); });
  }
  const bool here = rotate_at(nodes, nodes[node]);
  return here || left || right;
}

// The same one after the other, with a log.
bool rotate_all(Nodes& nodes, BuildSteps& steps) {
  bool any = false;
  for (size_t i = nodes.size(); i-- > 0;)
    any = rotate_at(nodes, nodes[i], &steps) || any;
  steps.move_rounds.push_back(static_cast<uint32_t>(steps.moves.size()));
  return any;
}

}  // namespace

void rotate(Bvh& bvh, const BuildOptions&, BuildLog* log, const std::stop_token& stop) {
  if (bvh.nodes.empty()) return;
  bvh = depth_first(bvh.nodes, bvh.references);
  for (int pass = 0; pass < passes && !stop.stop_requested(); ++pass) {
    const bool any = log && log->steps ? rotate_all(bvh.nodes, *log->steps)
                                       : rotate_subtree(bvh.nodes, 0, uint32_t(bvh.nodes.size()));
    if (!any) return;
    bvh = depth_first(bvh.nodes, bvh.references);
    if (log) log->optimized += bvh.references.size() / passes;
  }
}

}  // namespace tracer
