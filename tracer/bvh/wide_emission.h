// Emission: which nodes a wide tree has, and how they lie in memory.
#pragma once

#include "tracer/bvh/wide_bvh.h"

namespace tracer {

// Nodes that lead to each other and to their leaves; boxes, blocks and entries are still to be
// filled in (wide_fill.h). The layout is a wide one, and the tree has nodes. The slots of
// a node are in the order of their priorities (occlusion_order.h), if there are any. Deterministic
// for any number of threads.
WideTree emitted(const Bvh& tree, bool is_tlas, const BuildOptions& options,
                 std::span<const float> priorities);

}  // namespace tracer
