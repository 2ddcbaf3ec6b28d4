// Changing finished trees: their order, their leaves, their depth.
#pragma once

#include <span>

#include "tracer/bvh/build.h"

namespace tracer {

// A tree in the making may have its nodes in any order and with gaps: siblings are adjacent, the
// root is node 0. Gives it in depth-first order, references as the leaves come.
Bvh depth_first(std::span<const BvhNode> nodes, std::span<const uint32_t> references);

// Makes a leaf of every subtree that costs less as one and fits. A tree of leaves with one
// primitive each gets the leaves that SAH wants. Needs depth-first order and keeps it.
void collapse_leaves(Bvh& bvh, const BuildOptions& options);

// Subtrees that reach below options.max_depth are halved anew, in the order of their references.
// Needs depth-first order and keeps it.
void limit_depth(Bvh& bvh, std::span<const Box> boxes, const BuildOptions& options);

// References to parts become references to their primitives, each once a leaf.
void name_primitives(Bvh& bvh, const BuildInput& input);

}  // namespace tracer
