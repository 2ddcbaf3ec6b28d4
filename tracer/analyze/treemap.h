// The nodes of one level as areas of a rectangle, each as large as its width in the icicle: what
// weighs much is seen at once, wherever it is in the tree. Every inner node divides its rectangle
// among its children across the longer side. B. Johnson, B. Shneiderman, Tree-Maps: A Space-Filling
// Approach to the Visualization of Hierarchical Information Structures, 1991.
#pragma once

#include <vector>

#include "tracer/analyze/icicle.h"

namespace tracer {

struct TreemapTile {
  vec2 lo{0.0f}, hi{0.0f};  // pixels
  uint32_t node = 0;
  float value = 0.0f;  // of the colour; the largest of what is too small to be shown by itself
};

// The part of the map that is shown: a square of the whole, which is 0..1 in both directions.
struct TreemapView {
  glm::dvec2 lo{0.0};
  double length = 1.0;
  bool operator==(const TreemapView&) const = default;
};

// What the view shows of the nodes of `level`, of leaves above it, and of nodes whose own children
// would be smaller than a few pixels: at most a fixed part of size.x * size.y tiles. What a node
// weighs itself is an empty part of its rectangle.
std::vector<TreemapTile> treemap(const Icicle& icicle, uint32_t level, ivec2 size,
                                 const TreemapView& view = {});

// The smallest view that shows all of a node, or of the one that has taken it in; the whole map if
// the icicle has no such node.
TreemapView treemap_view_of(const Icicle& icicle, uint32_t node, ivec2 size);

}  // namespace tracer
