// A node that could be split, as builders see it.
#pragma once

#include <vector>

#include "tracer/analyze/tree_table.h"
#include "tracer/bvh/spatial_binning.h"
#include "tracer/scene/scene.h"

namespace tracer {

// What is below a node, each primitive once, and the part of its box that is in the node.
struct NodeParts {
  std::vector<uint32_t> primitives;  // ascending
  std::vector<Box> boxes;
};

NodeParts parts_below(const Scene& scene, const SceneBvh& bvh, const TreeTable& table,
                      uint32_t mesh, uint32_t node);

// Each once, ascending. Of a TLAS over parts of instances: their places in table.references.
std::vector<uint32_t> primitives_below(const TreeTable& table, uint32_t node);

// The references of one node, as builders see them.
struct SplitNode {
  const BuildOptions& options;
  BuildInput input;
  UntouchedVector<Reference> references;
  Range range;
  double area = 0.0;

  double cost(double children) const {
    const double each = area > 0.0 ? children / area : double(range.size());
    return double(options.traversal_cost) + double(options.intersection_cost) * each;
  }
  // A builder that weighs the split against a leaf does not take it.
  bool rather_leaf(double split_cost) const {
    const double leaf = double(options.intersection_cost) * double(range.size());
    return range.size() <= options.max_leaf_size && !(split_cost < leaf);
  }
};

inline Bounds as_bounds(const Box& box) {
  return {float4{box.lo.x, box.lo.y, box.lo.z, 0.0f}, float4{box.hi.x, box.hi.y, box.hi.z, 0.0f}};
}

}  // namespace tracer
