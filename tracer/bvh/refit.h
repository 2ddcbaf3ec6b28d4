// Refit: new boxes for the nodes of a tree whose primitives have moved. The tree's shape stays.
// I. Wald, S. Boulos, P. Shirley, Ray Tracing Deformable Scenes Using Dynamic Bounding Volume
// Hierarchies, 2007.
#pragma once

#include <span>

#include "tracer/bvh/scene_bvh.h"

namespace tracer {

// boxes: one a primitive. A leaf gets the box of its primitives, an inner node that of its
// children. The same for any number of threads.
void refit(Bvh& tree, std::span<const Box> boxes);

// Also the leaf triangles. The mesh has as many triangles as the one that the tree was built over.
// Boxes of split references become those of whole triangles.
void refit(Blas& blas, const Mesh& mesh);

// A copy, refitted, that knows the areas which its nodes had when the tree was built.
std::shared_ptr<Blas> refitted(const Blas& built, const Mesh& mesh);

// Whether the builder cut triangles at boxes: a refit cannot keep the cuts.
bool has_split_references(const Blas& blas, const Mesh& mesh);

}  // namespace tracer
