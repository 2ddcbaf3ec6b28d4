// How the tree has split a node, as a plane that its children lie on the two sides of.
#pragma once

#include "tracer/analyze/split_curves.h"
#include "tracer/analyze/split_node.h"

namespace tracer {

// Of node `id` of the table, which `node` was made of. Where no plane tells the children apart, or
// there are more than two, it has an axis of -1.
SplitChoice tree_split(const TreeTable& table, uint32_t id, const SplitNode& node);

}  // namespace tracer
