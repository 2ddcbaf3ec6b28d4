// The parts of the workspace around the panels.
#pragma once

#include "ui/workspace_state.h"

namespace ui {

void draw_menu_bar(Frame& frame);    // inside a window with a menu bar
void draw_status_bar(Frame& frame);  // one line
void draw_about(Frame& frame);

}  // namespace ui
