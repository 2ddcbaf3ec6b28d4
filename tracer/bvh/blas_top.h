// The upper part of a BLAS: the nodes at which an instance of it may be entered.
#pragma once

#include <span>
#include <vector>

#include "tracer/bvh/scene_bvh.h"

namespace tracer {

// Node 0 is the root; children come after their parent and next to each other.
struct BlasTop {
  struct Node {
    EntryPoint at;
    uint32_t first = 0, children = 0;     // none: it is not opened further
    uint32_t first_box = 0, box_end = 0;  // in `boxes`
  };
  std::vector<Node> nodes;
  std::vector<Box> boxes;  // of the nodes without children, from left to right

  // Hold what is below a node.
  std::span<const Box> boxes_below(uint32_t node) const {
    return std::span(boxes).subspan(nodes[node].first_box,
                                    nodes[node].box_end - nodes[node].first_box);
  }
};

// The nodes of largest area opened until there are enough boxes. Of a wide layout only nodes that
// it keeps.
BlasTop top_of(const Blas& blas);

}  // namespace tracer
