// The menus, and the window about the program and its counters.
#include <algorithm>

#include <imgui.h>

#include "tracer/bvh/counters.h"
#include "tracer/render/views.h"
#include "tracer/scene/builtin.h"
#include "ui/actions.h"
#include "ui/frame_parts.h"
#include "ui/history.h"
#include "ui/panels.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

bool begin_menu(const char* label, bool enabled = true) {
  const bool open = ImGui::BeginMenu(label, enabled);
  if (!open) mark(label);
  return open;
}

void menu_toggle(const char* label, bool& value, const char* help) {
  if (menu_item(label, nullptr, help, value)) value = !value;
}

void draw_builtin_scenes(Frame& frame) {
  const Scope scope("Built-in scenes");
  for (const tracer::BuiltinSceneRow& row : tracer::builtin_scenes()) {
    const bool chosen = frame.edited.settings.source.name == row.id;
    if (menu_item(std::string(row.label).c_str(), nullptr, std::string(row.help).c_str(), chosen)) {
      open_builtin(frame, row.id);
    }
  }
}

void draw_recent(Frame& frame) {
  const Scope scope("Recent files");
  for (const std::string& file : frame.state.recent_files) {
    if (menu_item(file.c_str(), nullptr, "Open this file again")) frame.requests.open = file;
  }
}

void draw_file_menu(Frame& frame) {
  const Scope scope("File");
  if (menu_item("Open scene...", "Ctrl+O", "Open a scene from a file")) {
    browse(frame, FilePurpose::open_scene);
  }
  if (begin_menu("Built-in scenes")) {
    draw_builtin_scenes(frame);
    ImGui::EndMenu();
  }
  if (begin_menu("Recent files", !frame.state.recent_files.empty())) {
    draw_recent(frame);
    ImGui::EndMenu();
  }
  if (menu_item("Open sky...", nullptr,
                "Light the scene with another sky: an equirectangular .hdr file")) {
    browse(frame, FilePurpose::open_sky);
  }
  ImGui::Separator();
  if (menu_item("Save picture...", "Ctrl+E",
                "The picture as it is shown (.png, with its legend), or its linear radiance "
                "(.exr, .hdr)")) {
    browse(frame, FilePurpose::save_picture);
  }
  if (menu_item("Save screenshot", "F12", "A picture of the whole window")) {
    frame.requests.screenshot = true;
  }
  ImGui::Separator();
  if (menu_item("Open session...", "Ctrl+L", "Everything as it was saved: scene, edits, view")) {
    browse(frame, FilePurpose::open_session);
  }
  if (menu_item("Save session...", "Ctrl+S", "Scene, edits, view and layout, to open them again")) {
    browse(frame, FilePurpose::save_session);
  }
  ImGui::Separator();
  if (menu_item("Quit", "Ctrl+Q", "Close the window")) frame.requests.quit = true;
}

void draw_edit_menu(Frame& frame) {
  const Scope scope("Edit");
  const History& history = frame.state.history;
  if (menu_item("Undo", "Ctrl+Z", "Take the last edit back", false, can_undo(history))) {
    undo_edit(frame);
  }
  if (menu_item("Redo", "Ctrl+Shift+Z", "Do it again", false, can_redo(history))) redo_edit(frame);
}

void draw_scale_menu(Frame& frame) {
  const Scope scope("Scale");
  struct Step {
    const char* label;
    float scale;
  };
  for (const Step& step :
       {Step{"Automatic", 0.0f}, Step{"75 %", 0.75f}, Step{"100 %", 1.0f}, Step{"125 %", 1.25f},
        Step{"150 %", 1.5f}, Step{"200 %", 2.0f}, Step{"300 %", 3.0f}}) {
    const bool chosen = frame.state.user_scale == step.scale;
    if (menu_item(step.label, nullptr, "Size of text and controls", chosen)) {
      frame.state.user_scale = step.scale;
    }
  }
}

void draw_view_menu(Frame& frame) {
  const Scope scope("View");
  Layout& layout = frame.state.layout;
  for (const PanelRow& row : panels()) {
    const bool shown = is_shown(layout, row.id);
    if (!menu_item(row.label, nullptr, row.help, shown)) continue;
    if (shown) {
      hide_panel(layout, row.id);
    } else {
      show_panel(layout, row.id);
    }
  }
  ImGui::Separator();
  menu_toggle("Axes", frame.state.show_gizmo, "The axes in the corner of the picture");
  menu_toggle("Light handles", frame.state.show_lights, "Lights in the picture, to drag them");
  menu_toggle("Values under the cursor", frame.state.show_values,
              "Text in the picture: hit, surface and counters of the pixel under the cursor");
  ImGui::Separator();
  if (begin_menu("Scale")) {
    draw_scale_menu(frame);
    ImGui::EndMenu();
  }
  if (menu_item("Reset layout", "Ctrl+0", "All panels back to where they were at first")) {
    reset_layout(frame);
  }
}

void draw_help_menu(Frame& frame) {
  const Scope scope("Help");
  if (menu_item("Keys and mouse", "F1", "All keys and what the mouse does")) {
    frame.state.show_keys = true;
  }
  if (menu_item("About the numbers", nullptr, "What the program is and what it counts")) {
    frame.state.show_about = true;
  }
}

template <class Rows>
void list_rows(const char* title, const Rows& rows) {
  heading(title);
  for (const auto& row : rows) {
    const float left = ImGui::GetCursorPosX();
    ImGui::TextUnformatted(row.label.data(), row.label.data() + row.label.size());
    ImGui::SameLine(left + 11.0f * em());
    hint(row.help);
  }
}

}  // namespace

void draw_menu_bar(Frame& frame) {
  if (!ImGui::BeginMenuBar()) return;
  {
    const Scope scope("menu");
    struct Menu {
      const char* label;
      void (*draw)(Frame& frame);
    };
    for (const Menu& menu : {Menu{"File", draw_file_menu}, Menu{"Edit", draw_edit_menu},
                             Menu{"View", draw_view_menu}, Menu{"Help", draw_help_menu}}) {
      if (!begin_menu(menu.label)) continue;
      menu.draw(frame);
      ImGui::EndMenu();
    }
  }
  ImGui::EndMenuBar();
}

void draw_about(Frame& frame) {
  if (!frame.state.show_about) return;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * display.x, 0.5f * display.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
  ImGui::SetNextWindowSize(
      {std::min(48.0f * em(), 0.95f * display.x), std::min(40.0f * em(), 0.9f * display.y)},
      ImGuiCond_Appearing);
  const ImGuiWindowFlags flags = ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings;
  if (ImGui::Begin("About the numbers", &frame.state.show_about, flags)) {
    hint(
        "bvhscope is a debugger for bounding volume hierarchies: it traces a scene on the CPU and "
        "shows what each ray cost, in which node and why.");
    list_rows("Counters, of each pixel and ray class", tracer::counters());
    list_rows("Ray classes", tracer::ray_classes());
    list_rows("Views", tracer::views());
    heading("SAH");
    hint(
        "The expected cost of a random ray: the sum over inner nodes of A(node) / A(root) Ct, and "
        "over leaves of A(node) / A(root) count Ci, where A is the surface area of the box. Of "
        "several trees it is the mean, weighted by triangles. (MacDonald and Booth 1990)");
    heading("Speed");
    hint("Mrays/s: millions of rays in a second, taken from the passes that count nothing.");
    if (button("Close", "Close this window")) frame.state.show_about = false;
  }
  ImGui::End();
}

}  // namespace ui
