// Widening: which nodes of the canonical tree become the children of a wide node.
// Optimal: the dynamic programme of H. Ylitie, T. Karras, S. Laine, Efficient Incoherent Ray
// Traversal on GPUs Through Compressed Wide BVHs, 2017, with blocks of triangles as leaves.
// Greedy: I. Wald, C. Benthin, S. Boulos, Getting Rid of Packets, 2008.
#pragma once

#include <array>

#include "tracer/bvh/wide_bvh.h"

namespace tracer {

// What the slots of a wide node stand for: nodes of the canonical tree from left to right.
template <int W>
struct NodeSlots {
  std::array<uint32_t, W> node;
  int count = 0;
};

// Of a canonical node: the least cost of its subtree as a forest of at most i + 1 wide subtrees.
// References above two blocks are not told apart.
template <int W>
struct ForestCosts {
  float forest[W - 1];
  uint32_t references;
  bool as_leaf;  // the one subtree of forest[0] is a leaf
};

// A widening says of an inner node of its tree, which it refers to, what the slots are; and of what
// a slot stands for whether it is a leaf there. W is 4 or 8.

// merges_leaves: subtrees of few references may become one leaf.
template <int W>
class OptimalWidening {
 public:
  OptimalWidening(const Bvh& tree, bool merges_leaves);

  bool is_leaf_slot(uint32_t node) const { return costs_[node].as_leaf; }
  NodeSlots<W> children(uint32_t node) const;

 private:
  void spread(uint32_t node, int roots, NodeSlots<W>& slots) const;
  void spread_below(uint32_t node, int roots, NodeSlots<W>& slots) const;

  const Bvh& tree_;
  UntouchedVector<ForestCosts<W>> costs_;  // by node
};

// Leaves stay as they are.
template <int W>
class GreedyWidening {
 public:
  explicit GreedyWidening(const Bvh& tree, bool /*merges_leaves*/) : tree_(tree) {}

  bool is_leaf_slot(uint32_t node) const { return is_leaf(tree_.nodes[node]); }
  NodeSlots<W> children(uint32_t node) const;

 private:
  const Bvh& tree_;
};

}  // namespace tracer
