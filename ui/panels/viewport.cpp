// The picture, as large as the panel, with what can be done in it.
#include "ui/viewport.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "ui/actions.h"
#include "ui/boxes.h"
#include "ui/panels.h"
#include "ui/pick.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

constexpr float settle_seconds = 0.15f;  // a size has to last so long before it is rendered

int divisor(PictureSize size) {
  return size == PictureSize::half_panel ? 2 : size == PictureSize::quarter_panel ? 4 : 1;
}

// The rendered size follows the panel's, but not while a border is being dragged.
void follow_size(Frame& frame, ImVec2 area) {
  ViewportState& viewport = frame.state.viewport;
  const ImVec2 density = ImGui::GetIO().DisplayFramebufferScale;
  const ImVec2 pixels = {area.x * std::max(density.x, 1.0f), area.y * std::max(density.y, 1.0f)};
  const bool first = viewport.panel_size.x == 0.0f;
  const bool same = pixels.x == viewport.panel_size.x && pixels.y == viewport.panel_size.y;
  viewport.panel_size = pixels;
  viewport.size_age =
      first ? settle_seconds : (same ? viewport.size_age + ImGui::GetIO().DeltaTime : 0.0f);
  if (frame.state.picture_size == PictureSize::fixed) return;
  const int part = divisor(frame.state.picture_size);
  const int width = std::clamp(static_cast<int>(pixels.x) / part, 1, tracer::max_image_size);
  const int height = std::clamp(static_cast<int>(pixels.y) / part, 1, tracer::max_image_size);
  tracer::RenderOptions& render = frame.edited.settings.render;
  if (render.width == width && render.height == height) return;
  if (viewport.size_age < settle_seconds) {
    frame.state.animating = true;
    return;
  }
  render.width = width;
  render.height = height;
}

// Fits the picture into the area, keeping its shape; one to one when it has nearly that size.
void place_picture(Frame& frame, ImVec2 at, ImVec2 area) {
  ViewportState& viewport = frame.state.viewport;
  const float width = static_cast<float>(std::max(frame.snapshot.film.width, 1));
  const float height = static_cast<float>(std::max(frame.snapshot.film.height, 1));
  const float scale = std::min(area.x / width, area.y / height);
  const ImVec2 size = {std::round(width * scale), std::round(height * scale)};
  viewport.lo = {std::floor(at.x + 0.5f * (area.x - size.x)),
                 std::floor(at.y + 0.5f * (area.y - size.y))};
  viewport.hi = {viewport.lo.x + size.x, viewport.lo.y + size.y};
}

void draw_empty(const Frame& frame, ImVec2 at, ImVec2 area) {
  const tracer::Snapshot& snapshot = frame.snapshot;
  std::string text = "No picture yet. File > Open scene... or File > Built-in scenes brings one.";
  if (snapshot.stage != tracer::Stage::none) {
    const std::string doing =
        snapshot.doing.empty() ? std::string(tracer::name(snapshot.stage)) : snapshot.doing;
    text = fmt::format("{}: {:.0f} %", doing, 100.0f * snapshot.progress);
  }
  const float wrap = std::min(area.x - 2.0f * em(), 30.0f * em());
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
  ImGui::GetWindowDrawList()->AddText(
      ImGui::GetFont(), em(),
      {std::floor(at.x + 0.5f * (area.x - size.x)), std::floor(at.y + 0.5f * (area.y - size.y))},
      ImGui::GetColorU32(ImGuiCol_TextDisabled), text.c_str(), nullptr, wrap);
}

// Over the picture, until it is dismissed.
void draw_banner(Frame& frame, ImVec2 at, ImVec2 area) {
  std::string& text = frame.state.banner;
  if (text.empty()) return;
  const float width = std::min(area.x - 2.0f * em(), 46.0f * em());
  const float wrap = width - 7.0f * em();
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
  ImGui::SetCursorScreenPos({std::floor(at.x + 0.5f * (area.x - width)), at.y + em()});
  ImGui::PushStyleColor(ImGuiCol_ChildBg, {0.36f, 0.10f, 0.10f, 0.96f});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0.6f * em(), 0.5f * em()));
  const float height = std::max(size.y, ImGui::GetFrameHeight()) + em();
  if (ImGui::BeginChild("banner", {width, height}, false,
                        ImGuiWindowFlags_AlwaysUseWindowPadding)) {
    ImGui::PushTextWrapPos(wrap);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::SameLine(width - 6.0f * em());
    if (button("Dismiss", "The Messages panel keeps it", 5.0f * em())) text.clear();
  }
  ImGui::EndChild();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
}

void add_light_at(Frame& frame, const Picked& picked) {
  if (!frame.edited.settings.look) return;
  std::vector<tracer::Light>& lights = frame.edited.settings.look->lights;
  tracer::Light light;
  const float distance = 0.1f * scene_size(frame.snapshot);
  light.name = fmt::format("light {}", lights.size() + 1);
  light.position = picked.surface.position + distance * picked.surface.shading_normal;
  light.intensity = distance * distance * 2.0f;
  frame.state.selection = {};
  frame.state.selection.light = static_cast<uint32_t>(lights.size());
  lights.push_back(light);
}

void draw_menu_items(Frame& frame) {
  const Scope scope("menu");
  const tracer::ivec2 pixel = frame.state.viewport.menu_pixel;
  const std::optional<Picked> picked = pick(frame.snapshot, pixel);
  if (menu_item("Select", nullptr, "This triangle and its instance", false, picked.has_value())) {
    Selection selection;
    selection.instance = picked->hit.instance;
    selection.triangle = picked->hit.triangle;
    selection.material = picked->surface.material;
    selection.pixel = pixel;
    frame.state.selection = selection;
    frame.state.edited_material = selection.material;
  }
  if (menu_item("Turn about this point", nullptr, "The camera's target moves here", false,
                picked.has_value() && frame.edited.settings.look)) {
    frame.edited.settings.look->camera.target = picked->surface.position;
  }
  if (menu_item("Edit its material", nullptr, "Show it in the Materials panel", false,
                picked.has_value())) {
    frame.state.edited_material = picked->surface.material;
    show_panel(frame.state.layout, "materials");
  }
  if (menu_item("Add a light here", nullptr, "A little above the surface", false,
                picked.has_value())) {
    add_light_at(frame, *picked);
  }
  if (menu_item("Copy the values", nullptr, "What is known of this pixel, to the clipboard")) {
    std::string text;
    for (const std::string& line : describe(frame.snapshot, frame.edited.view, pixel)) {
      text += line + "\n";
    }
    ImGui::SetClipboardText(text.c_str());
  }
  ImGui::Separator();
  if (menu_item("Focus", "F", "On the selection, or on everything")) focus_selection(frame);
  if (menu_item("Reset the camera", "R", "Back to the scene's own camera")) reset_camera(frame);
  if (menu_item("Save picture...", "Ctrl+E", "With its legend")) {
    browse(frame, FilePurpose::save_picture);
  }
}

}  // namespace

void draw_viewport(Frame& frame) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImVec2 area = ImGui::GetContentRegionAvail();
  area = {std::max(std::floor(area.x), 1.0f), std::max(std::floor(area.y), 1.0f)};
  follow_size(frame, area);
  place_picture(frame, at, area);
  const ViewportState& viewport = frame.state.viewport;

  ImGui::InvisibleButton("picture", area,
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  mark("picture");
  const bool hovered = ImGui::IsItemHovered();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 end(at.x + area.x, at.y + area.y);
  const bool covered = frame.picture != nullptr && viewport.lo.x <= at.x && viewport.lo.y <= at.y &&
                       viewport.hi.x >= end.x && viewport.hi.y >= end.y;
  if (!covered) list.AddRectFilled(at, end, IM_COL32(14, 15, 17, 255));
  if (frame.picture == nullptr || frame.snapshot.film.width == 0) {
    draw_empty(frame, at, area);
  } else {
    list.PushClipRect(at, end, true);
    list.AddImage(frame.texture, viewport.lo, viewport.hi);
    viewport_mouse(frame, hovered);
    if (hovered) frame.state.hovered.pixel = pixel_at(frame, ImGui::GetIO().MousePos);
    draw_node_pixels(frame);
    draw_selection(frame);
    draw_replay(frame);
    draw_followed_rays(frame);
    draw_light_handles(frame);
    draw_gizmo(frame);
    if (viewport.drag == ViewportDrag::none) draw_values(frame);
    list.PopClipRect();
    if (ImGui::BeginPopup("picture menu")) {
      draw_menu_items(frame);
      ImGui::EndPopup();
    }
  }
  request_box_facts(frame);
  viewport_fly(frame);
  draw_banner(frame, at, area);
}

}  // namespace ui
