// The keyboard and its list.
#include "ui/keys.h"

#include <array>
#include <initializer_list>

#include "ui/actions.h"
#include "ui/ray_view.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

constexpr std::array<KeyRow, 38> rows = {{
    {"Camera", "Left drag", "Turn about the target", 0, false, false, nullptr},
    {"Camera", "Middle or Shift+left drag", "Move sideways", 0, false, false, nullptr},
    {"Camera", "Wheel", "Zoom at the cursor", 0, false, false, nullptr},
    {"Camera", "Right drag", "Look around from where you stand", 0, false, false, nullptr},
    {"Camera", "W A S D, E Q", "Fly; E up, Q down; with Shift fast, with Ctrl slow", 0, false,
     false, nullptr},
    {"Camera", "Double click", "Focus on what is under the cursor", 0, false, false, nullptr},
    {"Camera", "F", "Focus on the selection, or on everything", 'F', false, false, focus_selection},
    {"Camera", "R", "Back to the scene's own camera", 'R', false, false, reset_camera},
    {"Camera", "O", "Orthographic on or off", 'O', false, false, toggle_orthographic},
    {"Picture", "Click", "Select the triangle, its instance and its material", 0, false, false,
     nullptr},
    {"Picture", "Right click", "Menu", 0, false, false, nullptr},
    {"Picture", "Drag a light", "Move it in the picture's plane; with Shift up and down", 0, false,
     false, nullptr},
    {"Picture", "Esc", "Clear the selection", key_escape, false, false, clear_selection},
    {"Picture", "Delete", "Remove the selected light", key_delete, false, false,
     delete_selected_light},
    {"Picture", "1 ... 9", "The first nine views", 0, false, false, nullptr},
    {"Picture", "M", "Wireframe, and back", 'M', false, false, toggle_wireframe},
    {"Picture", "C", "Fit the range to the picture", 'C', false, false, fit_range},
    {"Picture", "Space", "Play or pause", key_space, false, false, toggle_play},
    {"Ray", "Right", "One step on, while the Ray panel is on show", key_right, false, false,
     step_forward},
    {"Ray", "Left", "One step back", key_left, false, false, step_back},
    {"Ray", ".", "One step on, too", '.', false, false, step_forward},
    {"Ray", ",", "One step back, too", ',', false, false, step_back},
    {"Ray", "Home", "To the first step", key_home, false, false, step_to_begin},
    {"Ray", "End", "To the last step", key_end, false, false, step_to_end},
    {"File", "Ctrl+O", "Open a scene", 'O', true, false,
     [](Frame& frame) { browse(frame, FilePurpose::open_scene); }},
    {"File", "Ctrl+S", "Save the session", 'S', true, false,
     [](Frame& frame) { browse(frame, FilePurpose::save_session); }},
    {"File", "Ctrl+L", "Load a session", 'L', true, false,
     [](Frame& frame) { browse(frame, FilePurpose::open_session); }},
    {"File", "Ctrl+E", "Save the picture", 'E', true, false,
     [](Frame& frame) { browse(frame, FilePurpose::save_picture); }},
    {"File", "F12", "Save a picture of the whole window", key_f12, false, false,
     [](Frame& frame) { frame.requests.screenshot = true; }},
    {"File", "Ctrl+Q", "Quit", 'Q', true, false, [](Frame& frame) { frame.requests.quit = true; }},
    {"Edit", "Ctrl+Z", "Undo", 'Z', true, false, undo_edit},
    {"Edit", "Ctrl+Shift+Z", "Redo", 'Z', true, true, redo_edit},
    {"Edit", "Ctrl+Y", "Redo", 'Y', true, false, redo_edit},
    {"Edit", "Ctrl+click a number", "Type it", 0, false, false, nullptr},
    {"Window", "F1 or ?", "This list", key_f1, false, false,
     [](Frame& frame) { frame.state.show_keys = !frame.state.show_keys; }},
    {"Window", "Right click a tab", "Move a panel to another region, or hide it", 0, false, false,
     nullptr},
    {"Window", "Drag a border", "Resize a region; double click: its default size", 0, false, false,
     nullptr},
    {"Window", "Ctrl+0", "Reset the layout", '0', true, false, reset_layout},
}};

void press(Frame& frame, const KeyPress& pressed) {
  for (const KeyRow& row : rows) {
    if (row.act == nullptr || row.key != pressed.key) continue;
    if (row.control == pressed.control && row.shift == pressed.shift && !pressed.alt) {
      row.act(frame);
      return;
    }
  }
  const bool plain = !pressed.control && !pressed.alt;
  if (plain && pressed.key >= '1' && pressed.key <= '9') choose_view(frame, pressed.key - '0');
}

bool typed_question_mark() {
  const ImVector<ImWchar>& typed = ImGui::GetIO().InputQueueCharacters;
  for (int i = 0; i < typed.Size; ++i) {
    if (typed[i] == '?') return true;
  }
  return false;
}

void draw_groups(std::initializer_list<std::string_view> groups) {
  ImGui::BeginGroup();
  for (const std::string_view group : groups) {
    ImGui::TextColored({0.55f, 0.72f, 0.90f, 1.0f}, "%s", std::string(group).c_str());
    const float left = ImGui::GetCursorScreenPos().x;
    for (const KeyRow& row : rows) {
      if (row.group != group) continue;
      ImGui::TextUnformatted(row.keys);
      ImGui::SameLine();
      ImGui::SetCursorScreenPos({left + 12.0f * em(), ImGui::GetCursorScreenPos().y});
      ImGui::TextDisabled("%s", row.help);
    }
    ImGui::Spacing();
  }
  ImGui::EndGroup();
}

}  // namespace

std::span<const KeyRow> key_rows() {
  return rows;
}

void handle_keys(Frame& frame) {
  if (ImGui::GetIO().WantTextInput || frame.state.browser.visible) return;
  if (typed_question_mark()) frame.state.show_keys = true;
  for (const KeyPress& pressed : frame.keys) {
    if (frame.state.show_keys && pressed.key == key_escape) {
      frame.state.show_keys = false;
    } else {
      press(frame, pressed);
    }
  }
}

void draw_key_list(Frame& frame) {
  if (!frame.state.show_keys) return;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * display.x, 0.5f * display.y}, ImGuiCond_Always, {0.5f, 0.5f});
  const ImGuiWindowFlags flags = ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize |
                                 ImGuiWindowFlags_NoSavedSettings;
  if (ImGui::Begin("Keys and mouse", &frame.state.show_keys, flags)) {
    const Scope scope("keys");
    draw_groups({"Camera", "Picture", "Ray"});
    ImGui::SameLine(0, 2.0f * em());
    draw_groups({"File", "Edit", "Window"});
    if (button("Close", "Esc or F1 closes it too")) frame.state.show_keys = false;
  }
  ImGui::End();
}

}  // namespace ui
