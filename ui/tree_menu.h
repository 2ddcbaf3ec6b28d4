// The context menu of the Tree panel's rows.
#pragma once

#include "ui/node_words.h"

namespace ui {

// Draws it while the popup "row menu" is open, about TreeState::menu_row. `current` as of the list.
void draw_tree_menu(Frame& frame, const tracer::TreeFacts& facts, bool current);

// Shows the tree of an instance's mesh, with the instance selected.
void go_into(Frame& frame, uint32_t instance);

bool is_hidden(const BoxFilter& filter, const NodePlace& place);

}  // namespace ui
