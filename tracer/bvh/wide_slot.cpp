// Finding the slot that stands for a node.
#include "tracer/bvh/wide_slot.h"

#include <vector>

namespace tracer {

Box layout_box(const Bvh& tree, const WideTree& wide, uint32_t node) {
  const Box own = box_of(tree.nodes[node]);
  const auto* quantised = std::get_if<Quantised8>(&wide);  // elsewhere a slot has the node's box
  if (quantised == nullptr || node == 0) return own;
  std::vector<uint32_t> open = {0};
  while (!open.empty()) {
    const QuantisedNode& from = quantised->nodes[open.back()];
    open.pop_back();
    for (int slot = 0; slot < QuantisedNode::width; ++slot) {
      const uint32_t binary = from.binary[slot];
      if (binary > node) continue;  // empty, or below the node or beside it
      const Box box = slot_box(from, slot);
      if (binary == node) return box;
      if (!is_leaf(from.child[slot]) && contains(box, own)) open.push_back(from.child[slot]);
    }
  }
  return own;
}

}  // namespace tracer
