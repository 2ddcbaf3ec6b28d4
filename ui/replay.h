// The replayed build: how far it is, and which boxes that makes.
#pragma once

#include "ui/workspace_state.h"

namespace ui {

// The replay that is shown; nullptr: none, or it is of trees that are gone.
const tracer::Replay* shown_replay(const Frame& frame);

// To a step, 0..number of steps; selects the node that the step before it has made, if the finished
// tree has it.
void go_to_build_step(Frame& frame, size_t step);

// Once a frame while the panel is on show: asks for the replay, plays it, and brings the step into
// its range.
void follow_replay(Frame& frame);

}  // namespace ui
