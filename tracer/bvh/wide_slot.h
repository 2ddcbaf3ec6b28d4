// The boxes of wide nodes' slots, plane by plane as the traversal computes them.
#pragma once

#include <bit>

#include "tracer/bvh/wide_bvh.h"

namespace tracer {

// 2^(exponent - 127): the step of a quantised node's planes.
inline float step_size(uint32_t exponent) {
  return std::bit_cast<float>(exponent << 23);
}

template <int W>
Box slot_box(const WideNode<W>& node, int slot) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lo[axis] = node.planes[2 * axis][slot];
    box.hi[axis] = node.planes[2 * axis + 1][slot];
  }
  return box;
}
inline Box slot_box(const QuantisedNode& node, int slot) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const float step = step_size(node.exponent[axis]);
    box.lo[axis] = node.origin[axis] + float(node.planes[2 * axis][slot]) * step;
    box.hi[axis] = node.origin[axis] + float(node.planes[2 * axis + 1][slot]) * step;
  }
  return box;
}

// The box that rays are tested against where the layout keeps a node of the canonical tree: a
// quantised one is larger than the node's own. The root, and a node that the layout has not, have
// their own. Follows the slots around the node's box down from the root.
Box layout_box(const Bvh& tree, const WideTree& wide, uint32_t node);

}  // namespace tracer
