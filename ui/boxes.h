// The boxes in the picture: what they are made of.
#pragma once

#include "tracer/analyze/box_set.h"
#include "ui/workspace_state.h"

namespace ui {

// What is selected, hidden and known.
tracer::BoxSources box_sources(const UiState& state, const Work& work);

// Asks for what the shown boxes' colours need; in each frame in which the picture is drawn.
void request_box_facts(Frame& frame);

}  // namespace ui
