// EPO, the end-point overlap: what rays pay at their ends for boxes that have nothing to do with
// the surface there. Based on: T. Aila, T. Karras, S. Laine, On Quality Metrics of Bounding Volume
// Hierarchies, 2013.
//   EPO = sum over nodes n of C(n) A((S without Q(n)) inside box(n)) / A(S)
// S: all surface, Q(n): that of the triangles below n, A: area, C(n): Ct of an inner node, count *
// Ci of a leaf. Where we differ: the paper clips triangles to boxes. We take points p evenly from S
// and average the sum of C(n) over the nodes whose box holds p and which are not above p's
// triangle: the same quantity, with an error that is known and chosen.
#pragma once

#include <span>
#include <vector>

#include "tracer/analyze/monte_carlo.h"
#include "tracer/bvh/scene_bvh.h"

namespace tracer {

// Raw EPO, not the paper's blend with SAH, in units of the costs. The shares of all nodes add up to
// the value. Boxes are closed: a point on a face is in it.
struct Epo {
  double value = 0.0;
  double standard_error = 0.0;
  uint64_t samples = 0;
  std::vector<std::vector<float>> node_shares;  // by tree, by node
};

// An error below absolute_error tells as much: SAH, to which EPO is added, is above 1.
inline constexpr SampleLimits epo_limits = {.relative_error = 0.01, .absolute_error = 0.0005};

// Of one tree over the triangles of a mesh, whose depth is at most max_tree_depth. Deterministic
// for any number of threads; stopped: what is known by then.
Epo epo(const Mesh& mesh, const Bvh& tree, float traversal_cost, float intersection_cost,
        const SampleLimits& limits, const std::stop_token& stop);

// The mean over all BLASes weighted by triangles, sampled as a whole. One tree a mesh.
Epo blas_epo(const Scene& scene, const SceneBvh& bvh, const SampleLimits& limits,
             const std::stop_token& stop);

// Of the TLAS: S is the surface of all instances in the world, a leaf's cost is Ci an instance.
Epo tlas_epo(const Scene& scene, const SceneBvh& bvh, const SampleLimits& limits,
             const std::stop_token& stop);

}  // namespace tracer
