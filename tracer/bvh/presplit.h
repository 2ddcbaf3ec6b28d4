// Pre-splitting: large triangles that fill little of their box become several references before any
// builder sees them (T. Karras, T. Aila, Fast Parallel Construction of High-Quality Bounding Volume
// Hierarchies, 2013, section 4.4).
#pragma once

#include <stop_token>
#include <vector>

#include "tracer/bvh/build.h"

namespace tracer {

// Boxes that cover all triangles, and the triangle of each.
struct SplitBoxes {
  std::vector<Box> boxes;
  std::vector<uint32_t> primitives;
};

// At most `budget` times as many references more than there are triangles. `boxes` are those of the
// mesh's triangles. Split are triangles that fill at most `most_filled` of the faces of their box
// (seen from all three sides; one in the plane of two axes fills half, a thin one along the
// diagonal next to nothing). Deterministic for any number of threads.
SplitBoxes presplit(const Mesh& mesh, std::span<const Box> boxes, float budget, float most_filled,
                    const std::stop_token& stop);

}  // namespace tracer
