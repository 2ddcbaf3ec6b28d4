// Undo and redo over workspace.h's History.
#pragma once

#include "ui/workspace_state.h"

namespace ui {

inline constexpr size_t max_states = 200;

// Notes the settings as a new state if they differ from the present one; states that were undone
// are forgotten. Moves of the camera within a second of each other become one state.
void record(History& history, const tracer::Settings& settings, double seconds);

bool can_undo(const History& history);
bool can_redo(const History& history);

// Nothing if there is no such state.
const tracer::Settings* undo(History& history);
const tracer::Settings* redo(History& history);

// Once a frame, when all widgets have been drawn: an edit ends when no widget is held. What changes
// by itself (time while playing, the size that follows the panel) is no edit.
void update_history(Edited& edited, UiState& state);

// Steps back or forth; the size that follows the panel stays as it is.
void undo(Edited& edited, UiState& state);
void redo(Edited& edited, UiState& state);

}  // namespace ui
