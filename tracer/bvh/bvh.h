// The canonical binary BVH. Everything else (layouts, statistics, the tree panel) derives from it.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "tracer/math/box.h"

namespace tracer {

//  byte  0        12      16        28      32
//        | lo xyz | first | hi xyz | count |
struct BvhNode {
  vec3 lo{infinity};
  uint32_t first =
      0;  // inner: index of the left child, the right one follows; leaf: first reference
  vec3 hi{-infinity};
  uint32_t count = 0;  // leaf: number of references; 0 for an inner node
};
static_assert(sizeof(BvhNode) == 32);

inline bool is_leaf(const BvhNode& node) {
  return node.count > 0;
}
inline Box box_of(const BvhNode& node) {
  return {node.lo, node.hi};
}

// Places node 1 at the begin of a cache line, so that siblings, which are read together, share one.
// As in untouched.h, resize(n) leaves new nodes as the memory is; resize(n, BvhNode{}) does not.
template <class Node>
struct SiblingAllocator {
  using value_type = Node;
  static constexpr std::align_val_t line{64};
  static_assert(2 * sizeof(Node) == 64);

  SiblingAllocator() = default;
  template <class Other>
  explicit SiblingAllocator(const SiblingAllocator<Other>&) {}
  Node* allocate(size_t count) {
    return static_cast<Node*>(::operator new((count + 1) * sizeof(Node), line)) + 1;
  }
  template <class Other>
  void construct(Other*) noexcept {}
  template <class Other, class... Arguments>
  void construct(Other* at, Arguments&&... arguments) {
    std::construct_at(at, std::forward<Arguments>(arguments)...);
  }
  void deallocate(Node* nodes, size_t) { ::operator delete(nodes - 1, line); }
  bool operator==(const SiblingAllocator&) const = default;
};

// Node 0 is the root. Siblings are adjacent, children come after their parent, so one loop from the
// last node to the first refits the tree. `references` are indices of the primitives built over; a
// leaf owns references[first, first + count). A BVH over nothing has no nodes.
struct Bvh {
  std::vector<BvhNode, SiblingAllocator<BvhNode>> nodes;
  std::vector<uint32_t> references;
  uint32_t depth = 0;  // edges from the root to the deepest leaf: bounds the traversal stack
};

// The places in `references` of the leaves below a node, from left to right.
template <class Visit>
void for_references_below(const Bvh& tree, uint32_t node, const Visit& visit) {
  const BvhNode& row = tree.nodes[node];
  if (!is_leaf(row)) {
    for_references_below(tree, row.first, visit);
    for_references_below(tree, row.first + 1, visit);
    return;
  }
  for (uint32_t i = row.first; i < row.first + row.count; ++i)
    visit(i);
}

inline uint32_t references_below(const Bvh& tree, uint32_t node) {
  uint32_t count = 0;
  for_references_below(tree, node, [&](uint32_t) { ++count; });
  return count;
}

}  // namespace tracer
