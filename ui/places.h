// Places in trees: chosen, in words, and as a selection.
#pragma once

#include <string>

#include "ui/workspace_state.h"

namespace ui {

// The TLAS (none) or the BLAS of a mesh; true in the frame in which it is chosen. Its entries are
// marked "tlas" and "mesh 3".
bool tree_combo(const Frame& frame, const char* label, uint32_t& mesh, const char* help);

// "mesh 2 wheel, node 12, triangle 7"; none: without that part, the TLAS for the mesh.
std::string place_name(const Frame& frame, uint32_t mesh, uint32_t node, uint32_t triangle);

// Selects nothing but the node, and the triangle of a mesh in the first instance that shows it, or
// the instance in the TLAS. none: without it.
void select_place(Frame& frame, uint32_t mesh, uint32_t node, uint32_t triangle);

}  // namespace ui
