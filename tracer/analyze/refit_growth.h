// How much the nodes of refitted trees have grown since they were built.
#pragma once

#include <vector>

#include "tracer/bvh/scene_bvh.h"

namespace tracer {

// Area now / area at the build, for each node; 1 for a tree that was not refitted. A node that had
// no area counts as if it had a millionth of the root's.
std::vector<float> node_growth(const Blas& blas);

// Of the leaf that holds a triangle, for each triangle; the largest where several leaves do.
std::vector<float> triangle_growth(const Blas& blas, size_t triangles);

// Over the nodes of all BLASes, each counted once.
struct RefitGrowth {
  double mean = 1.0;  // weighted by the area at the build
  double max = 1.0;
  uint32_t mesh = none, node = none;  // where it is largest; none: nothing was refitted
};
RefitGrowth refit_growth(const SceneBvh& bvh);

}  // namespace tracer
