// Words and numbers about nodes of trees, and what can be done with one, for the panels that list
// them.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "ui/widgets.h"
#include "ui/workspace_state.h"

namespace ui {

// "TLAS", "mesh 3 teapot".
std::string tree_name(const Frame& frame, uint32_t mesh);
// "instance 7 lamp".
std::string instance_name(const Frame& frame, uint32_t instance);
// "instance 7 lamp from node 12": what is at a place in the references of a TLAS, and where rays
// enter it, unless that is at its root.
std::string entry_name(const Frame& frame, const tracer::TreeTable& table, size_t place);
// "node 12", "leaf 13".
std::string node_name(const tracer::TreeTable& table, uint32_t node);
// Its label; in the TLAS the references are instances, or parts of some.
std::string measure_label(const tracer::NodeMeasureRow& measure, const tracer::TreeTable& table);
// "12.3 %"; "-" where there is none.
std::string measure_text(const tracer::NodeMeasureRow& measure, double value);

// The table of a tree as the snapshot has it; nullptr: it is not there (yet).
std::shared_ptr<const tracer::TreeTable> table_of(const Frame& frame, uint32_t mesh);
// The newest table, which may be of a tree that is gone.
std::shared_ptr<const tracer::TreeTable> newest_table(const Frame& frame, uint32_t mesh);

// All ray classes together, and each.
std::vector<Choice> ray_choices();
// Index of a RayClassRow; ray_class_count for "all".
int ray_class_index(std::string_view id);

// Keeps the selected instance if it shows the mesh, and the pixel.
void select_node(Frame& frame, const NodePlace& place);
void select_instance(Frame& frame, uint32_t instance);
// Of the instance that is selected, or the first one of the mesh.
void select_triangle(Frame& frame, uint32_t mesh, uint32_t triangle);
// The mesh's instance that is meant: the selected one, or the first; none: nothing shows it.
uint32_t instance_of(const Frame& frame, uint32_t mesh);
// Lights its box up in all panels.
void hover_node(Frame& frame, const NodePlace& place);
bool is_lit(const UiState& state, const NodePlace& place);

// A text that acts when it is clicked.
bool link(const char* label, std::string_view text, const char* help);

}  // namespace ui
