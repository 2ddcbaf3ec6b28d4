// Walking down the trees to the nodes whose boxes are wanted, for box_set.cpp.
#pragma once

#include "tracer/analyze/box_set.h"

namespace tracer {

// What the ids say.
struct WantedBoxes {
  const BoxSetRow& set;
  bool tlas, blases;
  uint32_t first, last;  // levels
  bool leaves;
};

// The trees as the layout has them, and where they stand.
struct PlacedTrees {
  const SceneBvh& bvh;
  const Inspection& inspection;

  const TreeTable* table(uint32_t mesh) const { return table_of(inspection, mesh); }
  bool has(const NodePlace& place) const {
    const TreeTable* of = table(place.mesh);
    return of != nullptr && place.node < of->nodes.size();
  }
  const TableNode& node(const NodePlace& place) const {
    return table(place.mesh)->nodes[place.node];
  }
  std::span<const uint32_t> children(const NodePlace& place) const {
    return children_of(*table(place.mesh), place.node);
  }
  std::span<const uint32_t> references(const NodePlace& leaf) const {
    const TableNode& row = node(leaf);
    return {table(leaf.mesh)->references.data() + row.first, row.references};
  }
  // The node at which the i-th instance of a leaf of the TLAS is entered.
  uint32_t entry(const NodePlace& leaf, size_t i) const {
    const TreeTable& of = *table(leaf.mesh);
    return of.entries.empty() ? 0 : of.entries[node(leaf).first + i];
  }
};

// The instances through which the selected node is seen; `none` for the TLAS.
std::vector<uint32_t> instances_of(const SceneBvh& bvh, const BoxSources& sources);

// Boxes without values, and how many there are. What is selected or isolated are nodes that the
// layout has.
void collect(const PlacedTrees& trees, const WantedBoxes& wanted, const BoxSources& sources,
             NodeBoxes& result);

}  // namespace tracer
