// Places in trees: in words, and as a selection.
#pragma once

#include <string>

#include "ui/workspace_state.h"

namespace ui {

// "mesh 2 wheel", or "TLAS" for none.
std::string tree_name(const tracer::Snapshot& snapshot, uint32_t mesh);

// With ", node 12, triangle 7"; none: without that part.
std::string place_name(const tracer::Snapshot& snapshot, uint32_t mesh, uint32_t node,
                       uint32_t triangle);

// Selects nothing but the node, and the triangle of a mesh in the first instance that shows it.
// none: without it.
void select_place(Frame& frame, uint32_t mesh, uint32_t node, uint32_t triangle);

}  // namespace ui
