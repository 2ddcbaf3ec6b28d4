// The costs that choose the optimal slots, and opening the largest child for the greedy ones.
#include "tracer/bvh/widening.h"

#include "tracer/bvh/bottom_up.h"

namespace tracer {
namespace {

constexpr WideningRow widening_rows[] = {
    {"optimal", "Optimal",
     "The wide tree of lowest SAH that can be made of the binary one, its leaves blocks of "
     "triangles, by dynamic programming.",
     "H. Ylitie, T. Karras, S. Laine, Efficient Incoherent Ray Traversal on GPUs Through "
     "Compressed Wide BVHs, 2017"},
    {"greedy", "Greedy",
     "From the root on, the child of largest area is replaced by its children until the node is "
     "full; leaves stay as they are.",
     "I. Wald, C. Benthin, S. Boulos, Getting Rid of Packets, 2008"},
};

constexpr uint32_t max_merged = 2 * block_size;  // references of a subtree that becomes one leaf

float cost_of_leaf(float area, uint32_t references) {
  const uint32_t blocks = (references + block_size - 1) / block_size;
  return area * block_cost * float(blocks);
}

// What is spent on the left of two subtrees that share `roots` wide subtrees, at best.
template <int W>
int best_share(const ForestCosts<W>& left, const ForestCosts<W>& right, int roots) {
  int best = 1;
  float least = infinity;
  for (int share = 1; share < roots; ++share) {
    const float cost = left.forest[share - 1] + right.forest[roots - share - 1];
    if (cost >= least) continue;
    least = cost;
    best = share;
  }
  return best;
}

}  // namespace

template <int W>
OptimalWidening<W>::OptimalWidening(const Bvh& tree, bool merges_leaves)
    : tree_(tree), costs_(tree.nodes.size()) {
  for_nodes_bottom_up(std::span(tree.nodes), [&](const BvhNode& node) {
    ForestCosts<W>& costs = costs_[&node - tree.nodes.data()];
    const float area = half_area(box_of(node));
    if (is_leaf(node)) {
      costs.references = std::min(node.count, max_merged + 1);
      costs.as_leaf = true;
      std::fill_n(costs.forest, W - 1, cost_of_leaf(area, node.count));
      return;
    }
    const ForestCosts<W>& left = costs_[node.first];
    const ForestCosts<W>& right = costs_[node.first + 1];
    costs.references = std::min(left.references + right.references, max_merged + 1);
    float inner = infinity;
    for (int k = 1; k < W; ++k)
      inner = std::min(inner, left.forest[k - 1] + right.forest[W - k - 1]);
    inner += area;
    const bool mergeable = merges_leaves && costs.references <= max_merged;
    const float merged = mergeable ? cost_of_leaf(area, costs.references) : infinity;
    costs.as_leaf = merged <= inner;
    costs.forest[0] = std::min(merged, inner);
    for (int i = 2; i < W; ++i) {
      float least = costs.forest[i - 2];
      for (int k = 1; k < i; ++k)
        least = std::min(least, left.forest[k - 1] + right.forest[i - k - 1]);
      costs.forest[i - 1] = least;
    }
  });
}

template <int W>
NodeSlots<W> OptimalWidening<W>::children(uint32_t node) const {
  NodeSlots<W> slots;
  spread_below(node, W, slots);
  return slots;
}

template <int W>
void OptimalWidening<W>::spread(uint32_t node, int roots, NodeSlots<W>& slots) const {
  const ForestCosts<W>& costs = costs_[node];
  while (roots > 1 && costs.forest[roots - 1] == costs.forest[roots - 2])
    --roots;
  if (roots == 1) {
    slots.node[slots.count++] = node;
  } else {
    spread_below(node, roots, slots);
  }
}

template <int W>
void OptimalWidening<W>::spread_below(uint32_t node, int roots, NodeSlots<W>& slots) const {
  const uint32_t left = tree_.nodes[node].first;
  const int share = best_share(costs_[left], costs_[left + 1], roots);
  spread(left, share, slots);
  spread(left + 1, roots - share, slots);
}

template <int W>
NodeSlots<W> GreedyWidening<W>::children(uint32_t node) const {
  NodeSlots<W> slots;
  slots.node[0] = tree_.nodes[node].first;
  slots.node[1] = tree_.nodes[node].first + 1;
  for (slots.count = 2; slots.count < W; ++slots.count) {
    int largest = -1;
    float most = -1.0f;
    for (int i = 0; i < slots.count; ++i) {
      const float area = half_area(box_of(tree_.nodes[slots.node[i]]));
      if (is_leaf_slot(slots.node[i]) || !(area > most)) continue;
      most = area;
      largest = i;
    }
    if (largest < 0) break;
    const uint32_t opened = tree_.nodes[slots.node[largest]].first;
    slots.node[slots.count] = opened + 1;
    slots.node[largest] = opened;
  }
  return slots;
}

template class OptimalWidening<4>;
template class OptimalWidening<8>;
template class GreedyWidening<4>;
template class GreedyWidening<8>;

std::span<const WideningRow> widenings() {
  return widening_rows;
}

}  // namespace tracer
