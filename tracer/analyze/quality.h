// Quality measures of a BVH.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "tracer/bvh/scene_bvh.h"
#include "tracer/render/film.h"

namespace tracer {

// Of one tree, or of all BLASes of a scene each counted once (SAH then weighted by triangles).
struct TreeStatistics {
  uint64_t nodes = 0;
  uint64_t leaves = 0;
  uint64_t references = 0;
  uint64_t primitives = 0;
  uint32_t max_depth = 0;
  double mean_leaf_depth = 0.0;
  uint32_t max_leaf_size = 0;
  double sah = 0.0;  // sum over inner A(n)/A(root) Ct + sum over leaves A(n)/A(root) count Ci
  float traversal_cost = 0.0f;
  float intersection_cost = 0.0f;
  uint64_t bytes = 0;                          // nodes, references, leaf triangles
  std::vector<uint64_t> leaf_size_histogram;   // index: references in the leaf
  std::vector<uint64_t> leaf_depth_histogram;  // index: depth
};

TreeStatistics statistics(const Bvh& bvh, float traversal_cost, float intersection_cost);
TreeStatistics blas_statistics(const SceneBvh& bvh);
TreeStatistics tlas_statistics(const SceneBvh& bvh);

// Cost per ray of one class: `mean` over all rays; the rest over the film's pixels that cast such
// rays, each with its own mean per ray, by nearest rank.
struct Percentiles {
  double mean = 0.0, p50 = 0.0, p95 = 0.0, p99 = 0.0, max = 0.0;
};
struct RayStatistics {
  uint64_t count = 0;  // rays
  Percentiles nodes, leaves, triangles, instances;
};
std::array<RayStatistics, ray_class_count> ray_statistics(const Film& film);

}  // namespace tracer
