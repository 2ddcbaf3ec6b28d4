// Boxes in the world of what is placed there.
#pragma once

#include <span>
#include <vector>

#include "tracer/bvh/bvh.h"

namespace tracer {

// The world box of transformed boxes (J. Arvo, Transforming Axis-aligned Bounding Boxes, 1990),
// widened by what transforming a ray may round away.
Box world_box(std::span<const Box> boxes, const mat4& to_world);

// Boxes that hold what is below a node: of the nodes there, the largest ones opened until there are
// enough. Together they fit a turned instance better than the node's box does.
std::vector<Box> cover(const Bvh& tree, uint32_t node = 0);

}  // namespace tracer
