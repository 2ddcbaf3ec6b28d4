// The keys, as rows: what F1 lists is what the keyboard does.
#pragma once

#include <span>

#include "ui/workspace_state.h"

namespace ui {

// A row without an action says what is done elsewhere: with the mouse, or while a key is held.
struct KeyRow {
  const char* group;
  const char* keys;  // as shown
  const char* help;
  int key;
  bool control, shift;
  void (*act)(Frame& frame);
};
std::span<const KeyRow> key_rows();

// Carries out the presses of this frame; none while text is being typed.
void handle_keys(Frame& frame);

// The list on F1.
void draw_key_list(Frame& frame);

}  // namespace ui
