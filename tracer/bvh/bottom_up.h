// Visiting the nodes of a binary tree, children before their parents.
#pragma once

#include <span>
#include <vector>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "tracer/bvh/bvh.h"

namespace tracer {

// The nodes above the subtrees, parents first, and the roots of the subtrees.
struct TreeCut {
  std::vector<uint32_t> above, roots;
};
TreeCut cut(std::span<const BvhNode> nodes, size_t roots_wanted);

// The depth of the recursion is the tree's, max_tree_depth at most.
template <class Node, class Visit>
void for_nodes_below(std::span<Node> nodes, uint32_t index, const Visit& visit) {
  Node& node = nodes[index];
  if (!is_leaf(node)) {
    for_nodes_below(nodes, node.first, visit);
    for_nodes_below(nodes, node.first + 1, visit);
  }
  visit(node);
}

// visit(node) of a parent sees what those of its children did. One loop from the last node to the
// first, since children come after their parents; big trees as subtrees beside each other and then
// the nodes above them.
template <class Node, class Visit>
void for_nodes_bottom_up(std::span<Node> nodes, const Visit& visit) {
  constexpr size_t min_parallel = 1u << 14;  // nodes; below it one loop is as fast
  constexpr size_t tasks_wanted = 128;
  if (nodes.size() < min_parallel || tbb::this_task_arena::max_concurrency() == 1) {
    for (size_t i = nodes.size(); i-- > 0;)
      visit(nodes[i]);
    return;
  }
  const TreeCut at = cut(nodes, tasks_wanted);
  tbb::parallel_for(size_t{0}, at.roots.size(),
                    [&](size_t i) { for_nodes_below(nodes, at.roots[i], visit); });
  for (size_t i = at.above.size(); i-- > 0;)
    visit(nodes[at.above[i]]);
}

}  // namespace tracer
