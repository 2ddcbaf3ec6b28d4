// In which order shadow rays visit the children of a wide node: any hit will do, so the child first
// that is likely to end the ray soon. Decided when the tree is widened, so it costs a ray nothing.
#pragma once

#include <span>
#include <vector>

#include "tracer/bvh/bvh.h"
#include "tracer/bvh/wide_bvh.h"

namespace tracer {

// Of the nodes of the canonical tree, in their order; siblings of higher priority come first.
// Empty where the tree's own order stays. Triangles are in the order of tree.references; none: the
// tree is a TLAS, of which the chance to block is not known.
std::vector<float> occlusion_priorities(const Bvh& tree, std::span<const LeafTriangle> triangles,
                                        const BuildOptions& options);

}  // namespace tracer
