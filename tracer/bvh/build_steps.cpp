#include "tracer/bvh/build_steps.h"

namespace tracer {

void record_merges(BuildSteps& steps, const Bvh& tree, std::span<const BvhNode> made,
                   std::span<const uint32_t> pairs) {
  std::vector<uint32_t> place(made.size());  // in `pairs`, of the pair that begins there
  for (uint32_t i = 0; i < pairs.size(); ++i)
    place[pairs[i]] = i;
  steps.order.resize(pairs.size());
  struct Same {
    uint32_t made, tree;
  };
  std::vector<Same> stack{{0, 0}};
  while (!stack.empty()) {
    const Same node = stack.back();
    stack.pop_back();
    if (is_leaf(made[node.made])) continue;
    const uint32_t from = made[node.made].first, to = tree.nodes[node.tree].first;
    steps.order[place[from]] = node.tree;
    stack.push_back({from, to});
    stack.push_back({from + 1, to + 1});
  }
}

void record_splits(BuildSteps& steps, const Bvh& tree) {
  steps.order.clear();
  std::vector<uint32_t> stack{0};
  while (!stack.empty() && !tree.nodes.empty()) {
    const uint32_t node = stack.back();
    stack.pop_back();
    if (is_leaf(tree.nodes[node])) continue;
    steps.order.push_back(node);
    stack.push_back(tree.nodes[node].first + 1);
    stack.push_back(tree.nodes[node].first);
  }
}

void record_move(BuildSteps& steps, const TreeMove& move) {
  if (steps.moves.size() < most_moves) {
    steps.moves.push_back(move);
  } else {
    ++steps.moves_left_out;
  }
}

}  // namespace tracer
