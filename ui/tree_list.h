// The list of the Tree panel: a row a node, its measures in columns.
#pragma once

#include "ui/node_words.h"

namespace ui {

// The order that the list is in.
SiblingOrder sibling_order(const TreeState& state);

// Fills what is left of the panel. `current`: the table is of the tree that is shown in the
// picture, so its nodes can be selected.
void draw_tree_list(Frame& frame, bool current);

// Shows another tree.
void show_tree(TreeState& state, uint32_t mesh);

// What the context menu copies: name and value of each known measure, a line each.
std::string node_text(const Frame& frame, const tracer::TreeFacts& facts, const NodePlace& place);

}  // namespace ui
