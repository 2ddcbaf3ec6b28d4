// Walking over what there is in a wide tree of any layout, for its rules.
#pragma once

#include <string>

#include <fmt/format.h>

#include "tracer/analyze/tree_rules.h"

namespace tracer {

// Calls check(WideNodes) if there is a wide tree.
template <class Check>
void in_wide(const TreeToCheck& of, const Check& check) {
  if (of.wide == nullptr) return;
  std::visit(
      [&](const auto& wide) {
        if constexpr (requires { wide.nodes; }) check(wide);
      },
      *of.wide);
}

inline std::string slot_name(size_t node, int slot) {
  return fmt::format("slot {} of wide node {}", slot, node);
}

// Calls visit(wide node, slot).
template <class Node, class Visit>
void for_each_slot(const WideNodes<Node>& wide, const Visit& visit) {
  for (uint32_t i = 0; i < wide.nodes.size(); ++i) {
    for (int slot = 0; slot < Node::width && wide.nodes[i].child[slot] != no_child; ++slot)
      visit(i, slot);
  }
}

// Calls visit(first block or entry, wide node, slot).
template <class Node, class Visit>
void for_each_leaf(const WideNodes<Node>& wide, const Visit& visit) {
  for_each_slot(wide, [&](uint32_t i, int slot) {
    const WideChild child = wide.nodes[i].child[slot];
    if (is_leaf(child)) visit(child & ~leaf_bit, i, slot);
  });
}

}  // namespace tracer
