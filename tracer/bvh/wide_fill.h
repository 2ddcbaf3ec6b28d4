// What the nodes of a wide tree hold: the boxes of their slots, the triangles of their leaves.
#pragma once

#include "tracer/bvh/wide_bvh.h"

namespace tracer {

// From the canonical tree that the slots came from, with its boxes of now; as for widen.
void fill(WideTree& wide, const Bvh& tree, std::span<const LeafTriangle> triangles,
          std::span<const EntryPoint> entries);

}  // namespace tracer
