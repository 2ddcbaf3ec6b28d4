// What it costs to split one node: at planes along each axis, as the tree has it, and where each
// builder would have put the plane. One step of the SAH, children counted as leaves (J. MacDonald,
// K. Booth, Heuristics for Ray Tracing using Space Subdivision, 1990), for a ray that enters the
// node, in units of the costs:
//   C = Ct + Ci (A(left) N(left) + A(right) N(right)) / A(node)
// N counts a triangle once, however many leaves below refer to it; of a triangle that leaves the
// node's box only the part inside counts, as for the builders that cut triangles.
#pragma once

#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "tracer/analyze/tree_table.h"
#include "tracer/progress.h"

namespace tracer {

inline constexpr uint32_t split_places = 255;  // planes an axis, which cut the box into equal parts

// Along one axis. NaN: nothing is on one side.
struct SplitCurve {
  std::vector<double> at;       // coordinates, ascending; empty: the box is flat
  std::vector<double> objects;  // triangles go whole to the side of their boxes' centres
  std::vector<double> space;    // triangles that the plane meets are cut, and go to both sides;
                                // empty: instances are not cut
};

struct SplitChoice {
  std::string_view id;           // of the builder
  bool leaf = false;             // it would not split
  int axis = -1;                 // -1: no plane tells the sides apart
  bool space = false;            // triangles are cut
  double at = 0.0;               // the plane's coordinate
  double cost = 0.0;             // NaN: not known
  uint32_t left = 0, right = 0;  // triangles or instances
  uint32_t children = 2;         // more: of a wide layout, and no plane alone
};

// With the build's own options: bins, leaf size, costs.
struct NodeSplits {
  std::shared_ptr<const SceneBvh> bvh;  // that it is of; nullptr: stopped
  uint32_t mesh = none;                 // none: the TLAS
  uint32_t node = 0;
  uint32_t references = 0;  // below the node, each triangle or instance once
  uint32_t max_leaf_size = 0;
  double leaf_cost = 0.0;  // Ci N
  std::array<SplitCurve, 3> axes;
  std::vector<SplitChoice> builders;  // midpoint, median, binned, sweep, sbvh
  SplitChoice tree;  // what the tree has: "tree"; more than two children have a cost and no plane
};

// `table` is of that tree, and has the node. Sorts the references: 1M in about a second.
NodeSplits node_splits(const Scene& scene, std::shared_ptr<const SceneBvh> bvh,
                       const TreeTable& table, uint32_t mesh, uint32_t node, const Job& job);

}  // namespace tracer
