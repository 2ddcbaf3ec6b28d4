// The whole window: menu bar, four regions of tabs with borders to drag, status bar.
#include <algorithm>
#include <cmath>

#include <imgui.h>

#include "ui/actions.h"
#include "ui/browse.h"
#include "ui/frame_parts.h"
#include "ui/history.h"
#include "ui/keys.h"
#include "ui/panels.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

const PanelRow* find_panel(std::string_view id) {
  for (const PanelRow& row : panels()) {
    if (row.id == id) return &row;
  }
  return nullptr;
}

bool in_use(const Layout& layout, Region region) {
  return std::any_of(layout.panels.begin(), layout.panels.end(), [&](const PanelPlace& place) {
    return place.shown && place.region == region;
  });
}

void draw_tab_menu(Frame& frame, const PanelRow& row, Region region) {
  if (!ImGui::BeginPopup("tab menu")) return;
  Layout& layout = frame.state.layout;
  for (int i = 0; i < region_count; ++i) {
    const std::string label = std::string("Move to the ") + region_names[i];
    const bool elsewhere = static_cast<Region>(i) != region;
    if (menu_item(label.c_str(), nullptr, "Put this panel into another region", false, elsewhere)) {
      move_panel(layout, row.id, static_cast<Region>(i));
    }
  }
  ImGui::Separator();
  if (menu_item("Hide", nullptr, "The View menu shows it again")) hide_panel(layout, row.id);
  if (menu_item("Reset layout", "Ctrl+0", "All panels back to where they were at first")) {
    reset_layout(frame);
  }
  ImGui::EndPopup();
}

void draw_tab(Frame& frame, const PanelRow& row, Region region) {
  const int index = static_cast<int>(region);
  Layout& layout = frame.state.layout;
  const bool raise = layout.raise[index] && layout.front[index] == row.id;
  const Scope scope(row.id);
  const bool open =
      ImGui::BeginTabItem(row.label, nullptr, raise ? ImGuiTabItemFlags_SetSelected : 0);
  mark("tab");
  tooltip(row.help);
  const bool asked = ImGui::IsItemClicked(ImGuiMouseButton_Right);
  if (open) {
    if (raise) layout.raise[index] = false;
    if (!layout.raise[index]) layout.front[index] = row.id;
    const bool picture = row.draw == draw_viewport;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding,
                        picture ? ImVec2(0, 0) : ImVec2(0.6f * em(), 0.4f * em()));
    const ImGuiWindowFlags flags =
        ImGuiWindowFlags_AlwaysUseWindowPadding |
        (picture ? ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse |
                       ImGuiWindowFlags_NoBackground
                 : 0);
    const bool visible = ImGui::BeginChild("content", {0, 0}, false, flags);
    ImGui::PopStyleVar();
    if (visible) row.draw(frame);
    ImGui::EndChild();
    ImGui::EndTabItem();
  }
  if (asked) ImGui::OpenPopup("tab menu");  // an open tab has ids of its own
  draw_tab_menu(frame, row, region);
}

void draw_region(Frame& frame, Region region, ImVec2 at, ImVec2 size) {
  if (size.x < 1.0f || size.y < 1.0f) return;
  const int index = static_cast<int>(region);
  ImGui::SetCursorScreenPos(at);
  if (ImGui::BeginChild(region_names[index], size, false, ImGuiWindowFlags_NoBackground)) {
    if (!in_use(frame.state.layout, region)) {
      ImGui::Indent(em());
      hint(
          "No panel is here. The View menu shows the hidden ones; a right click on a tab moves "
          "it.");
    }
    if (ImGui::BeginTabBar("tabs", ImGuiTabBarFlags_FittingPolicyScroll)) {
      // By value: a menu of a tab may change the list.
      const std::vector<PanelPlace> places = frame.state.layout.panels;
      for (const PanelPlace& place : places) {
        const PanelRow* row = find_panel(place.panel);
        if (row != nullptr && place.shown && place.region == region) draw_tab(frame, *row, region);
      }
      ImGui::EndTabBar();
    }
  }
  ImGui::EndChild();
}

// A border between regions; `length` is what it resizes, in unscaled pixels.
void draw_splitter(Frame& frame, const char* name, ImVec2 at, ImVec2 size, float& length,
                   float direction, float initial) {
  const bool vertical = size.y > size.x;
  ImGui::SetCursorScreenPos(at);
  ImGui::InvisibleButton(name, size);
  mark(name);
  const bool lit = ImGui::IsItemHovered() || ImGui::IsItemActive();
  if (lit) {
    ImGui::SetMouseCursor(vertical ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
    const ImGuiCol color =
        ImGui::IsItemActive() ? ImGuiCol_SeparatorActive : ImGuiCol_SeparatorHovered;
    ImGui::GetWindowDrawList()->AddRectFilled(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(),
                                              ImGui::GetColorU32(color), 2.0f);
  }
  if (ImGui::IsItemActive()) {
    const ImVec2 moved = ImGui::GetIO().MouseDelta;
    length += direction * (vertical ? moved.x : moved.y) / frame.state.scale;
  }
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) length = initial;
}

void draw_regions(Frame& frame, ImVec2 at, ImVec2 size) {
  Layout& layout = frame.state.layout;
  const float scale = frame.state.scale;
  const float gap = std::floor(5.0f * scale);
  const bool has_left = in_use(layout, Region::left), has_right = in_use(layout, Region::right);
  const bool has_bottom = in_use(layout, Region::bottom);
  // The centre keeps some room, whatever was asked for; a smaller window does not forget it.
  const float room = std::max(0.5f * (size.x / scale - 200.0f), 60.0f);
  layout.left = std::clamp(layout.left, 120.0f, 4000.0f);
  layout.right = std::clamp(layout.right, 120.0f, 4000.0f);
  layout.bottom = std::clamp(layout.bottom, 60.0f, 4000.0f);
  const float left = has_left ? std::floor(std::min(layout.left, room) * scale) : 0.0f;
  const float right = has_right ? std::floor(std::min(layout.right, room) * scale) : 0.0f;
  const float bottom =
      has_bottom
          ? std::floor(std::min(layout.bottom * scale, std::max(size.y - 120.0f * scale, 0.0f)))
          : 0.0f;
  const float middle_x = at.x + left + (has_left ? gap : 0.0f);
  const float right_x = at.x + size.x - right;
  const float middle = std::max(right_x - (has_right ? gap : 0.0f) - middle_x, 1.0f);
  const float centre = std::max(size.y - bottom - (has_bottom ? gap : 0.0f), 1.0f);
  const Layout initial = default_layout();

  {
    const Scope scope("splitter");
    if (has_left) {
      draw_splitter(frame, "left", {at.x + left, at.y}, {gap, size.y}, layout.left, 1.0f,
                    initial.left);
    }
    if (has_right) {
      draw_splitter(frame, "right", {right_x - gap, at.y}, {gap, size.y}, layout.right, -1.0f,
                    initial.right);
    }
    if (has_bottom) {
      draw_splitter(frame, "bottom", {middle_x, at.y + centre}, {middle, gap}, layout.bottom, -1.0f,
                    initial.bottom);
    }
  }
  if (ImGui::IsAnyItemActive()) {  // what the mouse cannot reach is not stored
    layout.left = has_left ? std::min(layout.left, room) : layout.left;
    layout.right = has_right ? std::min(layout.right, room) : layout.right;
  }
  if (has_left) draw_region(frame, Region::left, at, {left, size.y});
  if (has_bottom) {
    draw_region(frame, Region::bottom, {middle_x, at.y + centre + gap}, {middle, bottom});
  }
  if (has_right) draw_region(frame, Region::right, {right_x, at.y}, {right, size.y});
  // Last: the picture shows what the others have under the mouse in the same frame.
  draw_region(frame, Region::centre, {middle_x, at.y}, {middle, centre});
}

// The range that is played and scrubbed: one swing, a minute without a deformer that swings, or
// what the user chose.
void fit_time_range(Frame& frame) {
  TimelineState& range = frame.state.timeline;
  if (range.own_range) return;
  const tracer::Deformer& deformer = frame.edited.settings.deformer;
  range.from = 0.0f;
  range.to = tracer::is_moving(deformer) ? 1.0f / deformer.speed : 60.0f;
}

void advance_time(Frame& frame) {
  fit_time_range(frame);
  if (!frame.state.playing) return;
  float& time = frame.edited.settings.time;
  time = std::min(time + ImGui::GetIO().DeltaTime * frame.state.play_speed, tracer::max_time);
  const TimelineState& range = frame.state.timeline;
  const float length = range.to - range.from;
  if (range.loop && length > 0.0f && time > range.to) {
    time = range.from + std::fmod(time - range.from, length);
  }
  frame.state.animating = true;
}

}  // namespace

void draw_workspace(Frame& frame) {
  frame.state.animating = false;
  frame.state.was_hovered = frame.state.hovered;
  frame.state.hovered = {};
  handle_keys(frame);
  advance_time(frame);

  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize(display);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  const ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                 ImGuiWindowFlags_MenuBar | ImGuiWindowFlags_NoSavedSettings |
                                 ImGuiWindowFlags_NoBringToFrontOnFocus |
                                 ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoBackground;
  ImGui::Begin("workspace", nullptr, flags);
  ImGui::PopStyleVar(3);
  draw_menu_bar(frame);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float status = std::floor(ImGui::GetFrameHeight() + 0.3f * em());
  draw_regions(frame, at, {display.x, std::max(display.y - at.y - status, 1.0f)});
  ImGui::SetCursorScreenPos({0, display.y - status});
  if (ImGui::BeginChild("status", {display.x, status}, false,
                        ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse)) {
    draw_status_bar(frame);
  }
  ImGui::EndChild();
  ImGui::End();

  draw_browser(frame);
  draw_key_list(frame);
  draw_about(frame);
  update_history(frame.edited, frame.state);
}

}  // namespace ui
