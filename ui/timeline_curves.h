// The curves of the Timeline panel.
#pragma once

#include "ui/workspace_state.h"

namespace ui {

// What was measured, or what to do to have it measured. A click in a curve goes to that moment.
void draw_timeline_curves(Frame& frame);

}  // namespace ui
