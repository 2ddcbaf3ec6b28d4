// Large trees are emitted in parts, which are put one after the other.
#include "tracer/bvh/wide_emission.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "tracer/bvh/widening.h"
#include "tracer/choice.h"

namespace tracer {
namespace {

// A node of a wide tree that is being made: a binary node, and which slot leads to it.
struct Open {
  uint32_t binary = 0;
  uint32_t parent = none;  // of the root: none
  int slot = 0;
  uint32_t depth = 0;
};

// A node without its boxes.
template <int W>
struct Links {
  WideChild child[W];
  uint32_t binary[W];
};

// Part of a wide tree, numbered by itself: one node near the root, or all that is below one.
template <int W>
struct Part {
  Open root;  // parent: the part that is this one node
  bool whole = true;
  UntouchedVector<Links<W>> nodes;
  uint32_t leaves = 0;  // their blocks or entries
  uint32_t depth = 0;
};

// Decides which nodes there are, depth first, children of large area before small ones so that
// what is often visited together lies together.
template <int W, class Widening>
class Emission {
 public:
  Emission(const Bvh& tree, bool is_tlas, std::span<const float> priorities)
      : tree_(tree), is_tlas_(is_tlas), priorities_(priorities), widening_(tree, !is_tlas) {}

  // In the order of their nodes.
  std::vector<Part<W>> parts() const {
    constexpr size_t min_parallel = 1u << 14;  // nodes; below it one part is as fast
    constexpr int levels = W == 4 ? 4 : 3;     // some hundreds of subtrees
    const bool parallel =
        tree_.nodes.size() >= min_parallel && tbb::this_task_arena::max_concurrency() > 1;
    std::vector<Part<W>> parts;
    divide({}, parallel ? levels : 0, parts);
    tbb::parallel_for(size_t{0}, parts.size(), [&](size_t i) {
      if (parts[i].whole) add_subtree(parts[i]);
    });
    return parts;
  }

 private:
  void divide(const Open& root, int levels, std::vector<Part<W>>& parts) const {
    const auto index = uint32_t(parts.size());
    parts.push_back({root, levels == 0, {}, 0, root.depth});
    if (levels == 0) return;
    std::vector<Open> open;
    add_node(root.binary, root.depth, index, parts[index], open);
    for (; !open.empty(); open.pop_back())
      divide(open.back(), levels - 1, parts);
  }

  void add_subtree(Part<W>& part) const {
    std::vector<Open> open = {{part.root.binary, none, 0, part.root.depth}};
    while (!open.empty()) {
      const Open now = open.back();
      open.pop_back();
      const auto index = uint32_t(part.nodes.size());
      if (now.parent != none) part.nodes[now.parent].child[now.slot] = index;
      part.depth = std::max(part.depth, now.depth);
      add_node(now.binary, now.depth, index, part, open);
    }
  }

  // The inner ones of its children wait in `open`, the first to come last, and lead to `index`.
  void add_node(uint32_t from, uint32_t depth, uint32_t index, Part<W>& part,
                std::vector<Open>& open) const {
    Links<W>& node = part.nodes.emplace_back();
    std::fill_n(node.child, W, no_child);
    std::fill_n(node.binary, W, none);
    const NodeSlots<W> slots = slots_of_node(from);
    const size_t first_open = open.size();
    for (int slot = 0; slot < slots.count; ++slot) {
      const uint32_t binary = slots.node[slot];
      node.binary[slot] = binary;
      if (widening_.is_leaf_slot(binary)) {
        const uint32_t references = references_below(tree_, binary);
        node.child[slot] = part.leaves | leaf_bit;
        part.leaves += is_tlas_ ? references : (references + block_size - 1) / block_size;
      } else {
        open.push_back({binary, index, slot, depth + 1});
      }
    }
    const auto area = [&](const Open& of) { return half_area(box_of(tree_.nodes[of.binary])); };
    std::stable_sort(open.begin() + ptrdiff_t(first_open), open.end(),
                     [&](const Open& a, const Open& b) { return area(a) < area(b); });
  }

  NodeSlots<W> slots_of_node(uint32_t binary) const {
    if (is_leaf(tree_.nodes[binary])) return {{binary}, 1};  // only the root
    NodeSlots<W> slots = widening_.children(binary);
    if (!priorities_.empty()) {  // the last slot is visited first
      std::stable_sort(slots.node.begin(), slots.node.begin() + slots.count,
                       [&](uint32_t a, uint32_t b) { return priorities_[a] < priorities_[b]; });
    }
    return slots;
  }

  const Bvh& tree_;
  bool is_tlas_;
  std::span<const float> priorities_;
  Widening widening_;
};

// Counts the parts' nodes and leaves through.
template <class Node>
void join(std::span<const Part<Node::width>> parts, bool is_tlas, WideNodes<Node>& wide) {
  struct Base {
    uint32_t node = 0, leaf = 0;
  };
  std::vector<Base> bases;
  Base total;
  for (const auto& part : parts) {
    bases.push_back(total);
    total.node += uint32_t(part.nodes.size());
    total.leaf += part.leaves;
    wide.depth = std::max(wide.depth, part.depth);
  }
  wide.nodes.resize(total.node);
  if (is_tlas) {
    wide.entries.resize(total.leaf);
  } else {
    wide.blocks.resize(total.leaf);
  }
  tbb::parallel_for(size_t{0}, parts.size(), [&](size_t i) {
    const Base base = bases[i];
    Node* node = wide.nodes.data() + base.node;
    for (const auto& links : parts[i].nodes) {
      std::copy_n(links.binary, Node::width, node->binary);
      std::transform(links.child, links.child + Node::width, node->child, [&](WideChild child) {
        if (child == no_child) return child;
        return child + (is_leaf(child) ? base.leaf : base.node);
      });
      ++node;
    }
  });
  for (size_t i = 0; i < parts.size(); ++i) {
    const Open& root = parts[i].root;
    if (root.parent != none) wide.nodes[bases[root.parent].node].child[root.slot] = bases[i].node;
  }
}

template <class Node, template <int> class Widening>
WideNodes<Node> emitted_by(const Bvh& tree, bool is_tlas, std::span<const float> priorities) {
  constexpr int W = Node::width;
  const std::vector<Part<W>> parts = Emission<W, Widening<W>>(tree, is_tlas, priorities).parts();
  WideNodes<Node> wide;
  join<Node>(parts, is_tlas, wide);
  return wide;
}

template <class Node>
WideNodes<Node> emitted_as(const Bvh& tree, bool is_tlas, std::string_view widening,
                           std::span<const float> priorities) {
  return widening == "greedy" ? emitted_by<Node, GreedyWidening>(tree, is_tlas, priorities)
                              : emitted_by<Node, OptimalWidening>(tree, is_tlas, priorities);
}

}  // namespace

WideTree emitted(const Bvh& tree, bool is_tlas, const BuildOptions& options,
                 std::span<const float> priorities) {
  const LayoutRow& layout = *find_row(layouts(), options.layout);
  const std::string& widening = options.widening;
  if (layout.quantised) return emitted_as<QuantisedNode>(tree, is_tlas, widening, priorities);
  if (layout.width == 4) return emitted_as<WideNode<4>>(tree, is_tlas, widening, priorities);
  return emitted_as<WideNode<8>>(tree, is_tlas, widening, priorities);
}

}  // namespace tracer
