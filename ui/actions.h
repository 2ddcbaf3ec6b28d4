// What a key, a menu entry and a button can all do.
#pragma once

#include "ui/workspace_state.h"

namespace ui {

void fit_range(Frame& frame);                // the shown range becomes that of the picture's values
void toggle_wireframe(Frame& frame);         // and back to the view before
void choose_view(Frame& frame, int number);  // 1..9
void toggle_play(Frame& frame);
void clear_selection(Frame& frame);
void focus_selection(Frame& frame);
void reset_camera(Frame& frame);  // the scene's own
void toggle_orthographic(Frame& frame);
void look_from(Frame& frame, tracer::vec3 direction);  // the camera is in this direction
void delete_selected_light(Frame& frame);
void undo_edit(Frame& frame);
void redo_edit(Frame& frame);
void browse(Frame& frame, FilePurpose purpose);
void reset_layout(Frame& frame);
void open_builtin(Frame& frame, std::string_view id);

// Room around the camera's target: the scene's diagonal, or 1.
float scene_size(const tracer::Snapshot& snapshot);

// Width over height of the picture.
float aspect(const Frame& frame);

}  // namespace ui
