// How a node is split, how it could be: cost over the plane's place on each axis, and what builders
// would have done, as a part of the Node panel.
#pragma once

#include "tracer/analyze/split_curves.h"
#include "ui/workspace_state.h"

namespace ui {

// Plots and table; `splits` is of the selected node.
void draw_node_splits(Frame& frame, const tracer::NodeSplits& splits);

// The range of costs that the plots show: from a little below the least one to the leaf's, or the
// dearest plane if that is less.
struct CostRange {
  double lo = 0.0, hi = 1.0;
};
CostRange cost_range(const tracer::NodeSplits& splits);

}  // namespace ui
