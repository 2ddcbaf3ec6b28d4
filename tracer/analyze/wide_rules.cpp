// The rules for the nodes of a wide tree.
#include "tracer/analyze/wide_rules.h"

#include <algorithm>
#include <bit>
#include <iterator>

#include "tracer/analyze/wide_walk.h"
#include "tracer/bvh/wide_slot.h"
#include "tracer/choice.h"

namespace tracer {
namespace {

template <int W>
bool is_hittable(const WideNode<W>& node, int slot) {
  for (int axis = 0; axis < 3; ++axis) {
    if (node.planes[2 * axis][slot] != infinity || node.planes[2 * axis + 1][slot] != -infinity)
      return true;
  }
  return false;
}
bool is_hittable(const QuantisedNode& node, int slot) {
  return (node.slots >> slot & 1) != 0;
}

// The index of the alternative of WideTree that the options ask for.
size_t layout_asked(const TreeToCheck& of) {
  const LayoutRow* row = find_row(layouts(), of.options.layout);
  if (row == nullptr || row->width == 2 || of.tree.nodes.empty()) return 0;
  return row->quantised    ? WideTree(Quantised8()).index()
         : row->width == 4 ? WideTree(Wide4()).index()
                           : WideTree(Wide8()).index();
}

void check_layout(const TreeToCheck& of, FindingList& found) {
  constexpr std::string_view kinds[] = {"no wide nodes", "4-wide nodes", "8-wide nodes",
                                        "quantised 8-wide nodes"};
  static_assert(std::size(kinds) == std::variant_size_v<WideTree>);
  const size_t asked = layout_asked(of);
  if (of.wide->index() == asked) return;
  found.add(none, none, [&] {
    return fmt::format("the tree has {}; the layout {} has {}", kinds[of.wide->index()],
                       of.options.layout, kinds[asked]);
  });
}

// The node that a finding is at, if there is such a one.
uint32_t place(const TreeToCheck& of, uint32_t binary) {
  return binary < of.tree.nodes.size() ? binary : none;
}

// By wide node, as far as is known by now.
struct Links {
  std::vector<uint32_t> parent, depth, binary;
};

template <class Node>
void check_slots(const TreeToCheck& of, const WideNodes<Node>& wide, uint32_t i, Links& links,
                 FindingList& found) {
  const Node& node = wide.nodes[i];
  const size_t size = wide.nodes.size();
  bool is_after_empty = false;
  for (int slot = 0; slot < Node::width; ++slot) {
    const WideChild child = node.child[slot];
    const uint32_t binary = node.binary[slot];
    const auto add = [&](const auto& message) {
      const uint32_t at = place(of, binary);
      found.add(at != none ? at : place(of, links.binary[i]), none, message);
    };
    if (child == no_child) {
      is_after_empty = true;
      if (binary != none) {
        add([&] { return fmt::format("{} is empty, but stands for it", slot_name(i, slot)); });
      }
      if (is_hittable(node, slot)) {
        add([&] { return fmt::format("{} is empty, but rays may hit it", slot_name(i, slot)); });
      }
      continue;
    }
    if (is_after_empty) {
      add([&] { return fmt::format("{} comes after an empty one", slot_name(i, slot)); });
    }
    if (is_leaf(child)) continue;
    if (child <= i || child >= size) {
      add([&] {
        return fmt::format("{} leads to wide node {}; it must come after, within {} nodes",
                           slot_name(i, slot), child, size);
      });
    } else if (links.parent[child] != none) {
      add([&] {
        return fmt::format("{} leads to wide node {}, which is a child of wide node {}",
                           slot_name(i, slot), child, links.parent[child]);
      });
    } else {
      links.parent[child] = i;
      links.depth[child] = links.depth[i] + 1;
      links.binary[child] = binary;
    }
  }
}

template <class Node>
void check_depth(const TreeToCheck& of, const WideNodes<Node>& wide, const Links& links,
                 FindingList& found) {
  const auto deepest = std::max_element(links.depth.begin(), links.depth.end());
  const size_t i = size_t(deepest - links.depth.begin());
  const uint32_t at = place(of, links.binary[i]);
  if (*deepest != wide.depth) {
    found.add(at, none, [&] {
      return fmt::format("wide node {} is {} edges below the root; the wide tree says {}", i,
                         *deepest, wide.depth);
    });
  }
  if (*deepest > max_tree_depth) {
    found.add(at, none, [&] {
      return fmt::format("wide node {} is {} edges below the root; the stack ends at {}", i,
                         *deepest, max_tree_depth);
    });
  }
}

// The node of the canonical tree that each wide node stands for.
template <class Node>
std::vector<uint32_t> binary_of_each(const WideNodes<Node>& wide) {
  std::vector<uint32_t> binary(wide.nodes.size(), 0);
  for (const Node& node : wide.nodes) {
    for (int slot = 0; slot < Node::width; ++slot)
      if (!is_leaf(node.child[slot])) binary[node.child[slot]] = node.binary[slot];
  }
  return binary;
}

// Of the root none.
std::vector<uint32_t> parents(const Bvh& tree) {
  std::vector<uint32_t> parent(tree.nodes.size(), none);
  for (uint32_t i = 0; i < tree.nodes.size(); ++i) {
    const BvhNode& node = tree.nodes[i];
    if (!is_leaf(node)) parent[node.first] = parent[node.first + 1] = i;
  }
  return parent;
}

// The first leaf below `node` and below none of the slots; none: there is no such leaf.
uint32_t leaf_left_out(const Bvh& tree, uint32_t node, std::span<const uint32_t> slots) {
  if (std::find(slots.begin(), slots.end(), node) != slots.end()) return none;
  const BvhNode& row = tree.nodes[node];
  if (is_leaf(row)) return node;
  const uint32_t left = leaf_left_out(tree, row.first, slots);
  return left != none ? left : leaf_left_out(tree, row.first + 1, slots);
}

// What is wrong with slots[slot] of a wide node that stands for `top`; empty: nothing.
std::string fault(std::span<const uint32_t> slots, size_t slot, uint32_t top,
                  std::span<const uint32_t> parent) {
  const auto same = std::find(slots.begin(), slots.begin() + ptrdiff_t(slot), slots[slot]);
  if (same != slots.begin() + ptrdiff_t(slot)) {
    return fmt::format("stands for it, and so does slot {}", same - slots.begin());
  }
  if (slots[slot] == 0 && parent.size() == 1) return "";  // a root over a single leaf
  for (uint32_t above = parent[slots[slot]]; above != top; above = parent[above]) {
    if (above == none) return fmt::format("stands for it; it is not below node {}", top);
    if (std::find(slots.begin(), slots.end(), above) == slots.end()) continue;
    return fmt::format("stands for it, and another slot for node {} above it", above);
  }
  return "";
}

template <class Node>
void check_shares(const TreeToCheck& of, const Node& node, uint32_t i, uint32_t top,
                  std::span<const uint32_t> parent, FindingList& found) {
  int count = 0;
  for (; count < Node::width && node.child[count] != no_child; ++count) {
    if (node.binary[count] < of.tree.nodes.size()) continue;
    found.add(top, none, [&] {
      return fmt::format("{} stands for node {} of {}", slot_name(i, count), node.binary[count],
                         of.tree.nodes.size());
    });
    return;
  }
  const std::span<const uint32_t> slots(node.binary, size_t(count));
  bool is_sound = true;
  for (int slot = 0; slot < count; ++slot) {
    const std::string wrong = fault(slots, size_t(slot), top, parent);
    if (wrong.empty()) continue;
    is_sound = false;
    found.add(slots[slot], none, [&] { return fmt::format("{} {}", slot_name(i, slot), wrong); });
  }
  const uint32_t leaf = is_sound ? leaf_left_out(of.tree, top, slots) : none;
  if (leaf == none) return;
  found.add(leaf, none, [&] {
    return fmt::format("the leaf is below no slot of wide node {}, which stands for node {}", i,
                       top);
  });
}

// Whether a plane is where it belongs.
bool holds(const QuantisedNode&, bool is_high, float plane, float exact) {
  return is_high ? plane >= exact : plane <= exact;
}
template <int W>
bool holds(const WideNode<W>&, bool, float plane, float exact) {
  return std::bit_cast<uint32_t>(plane) == std::bit_cast<uint32_t>(exact);
}

// Empty: the slot's box is as it should be.
template <class Node>
std::string box_fault(const Node& node, int slot, const Box& exact) {
  const Box box = slot_box(node, slot);
  for (int plane = 0; plane < 6; ++plane) {
    const int axis = plane / 2;
    const bool is_high = plane % 2 == 1;
    const float wanted = is_high ? exact.hi[axis] : exact.lo[axis];
    const float is = is_high ? box.hi[axis] : box.lo[axis];
    if (holds(node, is_high, is, wanted)) continue;
    return fmt::format("has {} {} at {}, its node at {}", is_high ? "hi" : "lo", "xyz"[axis], is,
                       wanted);
  }
  return is_hittable(node, slot) ? "" : "is marked as empty";
}

}  // namespace

void check_wide_links(const TreeToCheck& of, FindingList& found) {
  if (of.wide == nullptr) return;
  check_layout(of, found);
  in_wide(of, [&](const auto& wide) {
    const auto size = uint32_t(wide.nodes.size());
    if (size == 0) {
      found.add(none, none, [] { return "there are no wide nodes"; });
      return;
    }
    Links links{std::vector<uint32_t>(size, none), std::vector<uint32_t>(size),
                std::vector<uint32_t>(size, none)};
    links.binary[0] = 0;
    for (uint32_t i = 0; i < size; ++i) {
      if (i > 0 && links.parent[i] == none) {
        found.add(none, none, [&] { return fmt::format("no slot leads to wide node {}", i); });
      }
      check_slots(of, wide, i, links, found);
    }
    check_depth(of, wide, links, found);
  });
}

void check_wide_subtrees(const TreeToCheck& of, FindingList& found) {
  in_wide(of, [&](const auto& wide) {
    const std::vector<uint32_t> parent = parents(of.tree);
    const std::vector<uint32_t> binary = binary_of_each(wide);
    for (uint32_t i = 0; i < wide.nodes.size(); ++i) {
      if (binary[i] >= parent.size()) continue;  // found at its parent
      check_shares(of, wide.nodes[i], i, binary[i], parent, found);
    }
  });
}

void check_wide_boxes(const TreeToCheck& of, FindingList& found) {
  in_wide(of, [&](const auto& wide) {
    for_each_slot(wide, [&](uint32_t i, int slot) {
      const auto& node = wide.nodes[i];
      const uint32_t binary = node.binary[slot];
      const std::string wrong = box_fault(node, slot, box_of(of.tree.nodes[binary]));
      if (wrong.empty()) return;
      found.add(binary, none, [&] { return fmt::format("{} {}", slot_name(i, slot), wrong); });
    });
  });
}

}  // namespace tracer
