// What is drawn over the picture: axes, light handles, the selection, values under the cursor.
#include <algorithm>
#include <cmath>

#include <imgui.h>

#include "ui/pick.h"
#include "ui/registry.h"
#include "ui/viewport.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::ivec2;
using tracer::vec2;
using tracer::vec3;

constexpr ImU32 dark = IM_COL32(0, 0, 0, 200);
constexpr ImU32 bright = IM_COL32(255, 200, 60, 255);
constexpr ImU32 node_color = IM_COL32(90, 230, 255, 255);
constexpr ImU32 hovered_color = IM_COL32(205, 246, 255, 255);
constexpr ImU32 pixel_color = IM_COL32(255, 60, 200, 110);

void outlined_line(ImDrawList& list, ImVec2 a, ImVec2 b, ImU32 color, float width) {
  const ImU32 outline = static_cast<ImU32>(200 * (color >> IM_COL32_A_SHIFT) / 255);
  list.AddLine(a, b, outline << IM_COL32_A_SHIFT, width + 2.0f);
  list.AddLine(a, b, color, width);
}

}  // namespace

void world_line(Frame& frame, const tracer::CameraFrame& camera, vec3 a, vec3 b, ImU32 color,
                float width) {
  if (!camera.orthographic) {
    float from = glm::dot(a - camera.eye, camera.forward);
    float to = glm::dot(b - camera.eye, camera.forward);
    const float near = 1e-3f * std::max(std::abs(from), std::abs(to));
    if (from < near && to < near) return;
    const vec3 step = b - a;
    const vec3 begin = a;
    if (from < near) a = begin + step * ((near - from) / (to - from));
    if (to < near) b = begin + step * ((near - from) / (to - from));
  }
  const std::optional<ImVec2> p = screen_from_world(frame, a);
  const std::optional<ImVec2> q = screen_from_world(frame, b);
  if (!p || !q) return;
  outlined_line(*ImGui::GetWindowDrawList(), *p, *q, color, width);
}

void world_box(Frame& frame, const tracer::CameraFrame& camera, const std::array<vec3, 8>& corners,
               ImU32 color, float width) {
  for (int i = 0; i < 8; ++i) {
    for (const int axis : {1, 2, 4}) {
      if ((i & axis) != 0) continue;
      world_line(frame, camera, corners[i], corners[i | axis], color, width);
    }
  }
}

ImVec2 screen_from_pixel(const Frame& frame, vec2 pixel) {
  const ViewportState& viewport = frame.state.viewport;
  const float width = static_cast<float>(std::max(frame.snapshot.film.width, 1));
  const float height = static_cast<float>(std::max(frame.snapshot.film.height, 1));
  return {viewport.lo.x + pixel.x / width * (viewport.hi.x - viewport.lo.x),
          viewport.lo.y + pixel.y / height * (viewport.hi.y - viewport.lo.y)};
}

vec2 pixel_from_screen(const Frame& frame, ImVec2 at) {
  const ViewportState& viewport = frame.state.viewport;
  const float width = std::max(viewport.hi.x - viewport.lo.x, 1.0f);
  const float height = std::max(viewport.hi.y - viewport.lo.y, 1.0f);
  return {(at.x - viewport.lo.x) / width * static_cast<float>(frame.snapshot.film.width),
          (at.y - viewport.lo.y) / height * static_cast<float>(frame.snapshot.film.height)};
}

std::optional<ivec2> pixel_at(const Frame& frame, ImVec2 at) {
  if (!ImGui::IsMousePosValid(&at)) return {};
  const vec2 pixel = glm::floor(pixel_from_screen(frame, at));
  const bool inside = pixel.x >= 0.0f && pixel.y >= 0.0f &&
                      pixel.x < static_cast<float>(frame.snapshot.film.width) &&
                      pixel.y < static_cast<float>(frame.snapshot.film.height);
  return inside ? std::optional<ivec2>(pixel) : std::nullopt;
}

std::optional<ImVec2> screen_from_world(const Frame& frame, vec3 point) {
  const std::optional<tracer::Projected> seen = tracer::project(film_frame(frame.snapshot), point);
  if (!seen) return {};
  const ImVec2 at = screen_from_pixel(frame, seen->pixel);
  // Far outside, lines lose their precision and draw lists their patience.
  if (!(std::abs(at.x) < 1e5f && std::abs(at.y) < 1e5f)) return {};
  return at;
}

uint32_t light_at(const Frame& frame, ImVec2 at) {
  if (!frame.state.show_lights || !frame.edited.settings.look) return tracer::none;
  const std::vector<tracer::Light>& lights = frame.edited.settings.look->lights;
  const float reach = 0.7f * em();
  for (uint32_t i = 0; i < lights.size(); ++i) {
    const std::optional<ImVec2> handle = screen_from_world(frame, lights[i].position);
    if (!handle) continue;
    const float x = handle->x - at.x, y = handle->y - at.y;
    if (x * x + y * y <= reach * reach) return i;
  }
  return tracer::none;
}

void draw_light_handles(Frame& frame) {
  if (!frame.state.show_lights || !frame.edited.settings.look) return;
  const std::vector<tracer::Light>& lights = frame.edited.settings.look->lights;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const uint32_t under = frame.state.viewport.drag == ViewportDrag::none
                             ? light_at(frame, ImGui::GetIO().MousePos)
                             : tracer::none;
  for (uint32_t i = 0; i < lights.size(); ++i) {
    const std::optional<ImVec2> at = screen_from_world(frame, lights[i].position);
    if (!at) continue;
    const bool lit = i == frame.state.selection.light || i == under;
    const float radius = (lit ? 0.5f : 0.4f) * em();
    const ImVec4 color = swatch(lights[i].color);
    list.AddCircleFilled(*at, radius + 2.0f, dark);
    list.AddCircleFilled(*at, radius,
                         lights[i].on ? ImGui::GetColorU32(color) : IM_COL32(60, 60, 60, 255));
    list.AddCircle(*at, radius + 2.0f, lit ? bright : IM_COL32(255, 255, 255, 160), 0, 1.5f);
    mark("light handle " + std::to_string(i + 1), {at->x - radius, at->y - radius},
         {at->x + radius, at->y + radius});
    if (!lit) continue;
    const ImVec2 text = {at->x + radius + 0.4f * em(), at->y - 0.5f * em()};
    list.AddText({text.x + 1, text.y + 1}, dark, lights[i].name.c_str());
    list.AddText(text, IM_COL32_WHITE, lights[i].name.c_str());
  }
}

void draw_selection(Frame& frame) {
  const Selection& selection = frame.state.selection;
  const tracer::CameraFrame camera = film_frame(frame.snapshot);
  const float width = std::max(1.0f, std::floor(frame.state.scale));
  if (const auto corners = instance_corners(frame.snapshot, selection.instance)) {
    world_box(frame, camera, *corners, IM_COL32(255, 255, 255, 150), width);
  }
  const auto node_boxes = [&](const NodePlace& place, ImU32 color, float thickness) {
    for (const auto& box : node_corners(frame.snapshot, place, selection.instance))
      world_box(frame, camera, box, color, thickness);
  };
  if (selection.node) node_boxes(*selection.node, node_color, 1.5f * width);
  // Panels that are drawn after this one have not said yet what is under the mouse.
  const Selection& hovered =
      frame.state.hovered == Selection() ? frame.state.was_hovered : frame.state.hovered;
  if (hovered.node) node_boxes(*hovered.node, hovered_color, width);
  if (hovered.triangle == tracer::none) {
    if (const auto corners = instance_corners(frame.snapshot, hovered.instance)) {
      world_box(frame, camera, *corners, hovered_color, width);
    }
  } else if (const auto corners =
                 triangle_corners(frame.snapshot, hovered.instance, hovered.triangle)) {
    for (int i = 0; i < 3; ++i)
      world_line(frame, camera, (*corners)[i], (*corners)[(i + 1) % 3], hovered_color, width);
  }
  if (const auto corners =
          triangle_corners(frame.snapshot, selection.instance, selection.triangle)) {
    for (int i = 0; i < 3; ++i) {
      world_line(frame, camera, (*corners)[i], (*corners)[(i + 1) % 3], bright, 2.0f * width);
    }
  }
}

// The pixels that the Node panel has found, while it shows them.
void draw_node_pixels(Frame& frame) {
  const NodeState& state = frame.state.node;
  const std::shared_ptr<const WatchedPixels>& shown = state.blocks_of;
  const std::optional<NodePlace>& node = frame.state.selection.node;
  if (!state.show_pixels || !shown || !node || !is_shown(frame.state.layout, "node")) return;
  const tracer::Watched& watched = shown->pixels.node;
  if (shown->film != frame.snapshot.render_generation ||
      *node != NodePlace{watched.mesh, watched.node}) {
    return;
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (const tracer::PixelBlock& block : state.blocks) {
    list.AddRectFilled(screen_from_pixel(frame, vec2(block.x0, block.y0)),
                       screen_from_pixel(frame, vec2(block.x1, block.y1)), pixel_color);
  }
}

float gizmo_radius() {
  return 0.6f * em();
}

std::array<GizmoAxis, 6> gizmo_axes(const Frame& frame) {
  const tracer::Camera camera =
      frame.edited.settings.look ? frame.edited.settings.look->camera : tracer::Camera();
  const tracer::CameraFrame seen = tracer::frame(camera, 1, 1);
  const ViewportState& viewport = frame.state.viewport;
  const float length = 2.2f * em();
  const ImVec2 middle = {viewport.hi.x - 3.4f * em(), viewport.lo.y + 3.4f * em()};
  std::array<GizmoAxis, 6> axes;
  for (int i = 0; i < 6; ++i) {
    vec3 direction(0.0f);
    direction[i % 3] = i < 3 ? 1.0f : -1.0f;
    axes[i] = {direction,
               {middle.x + length * glm::dot(direction, seen.right),
                middle.y - length * glm::dot(direction, seen.up)},
               glm::dot(direction, seen.forward)};
  }
  std::sort(axes.begin(), axes.end(),
            [](const GizmoAxis& a, const GizmoAxis& b) { return a.depth > b.depth; });
  return axes;
}

void draw_gizmo(Frame& frame) {
  if (!frame.state.show_gizmo) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ViewportState& viewport = frame.state.viewport;
  const ImVec2 middle = {viewport.hi.x - 3.4f * em(), viewport.lo.y + 3.4f * em()};
  list.AddCircleFilled(middle, 3.1f * em(), IM_COL32(20, 22, 26, 110), 48);
  const char* names[3] = {"X", "Y", "Z"};
  const ImU32 colors[3] = {IM_COL32(230, 80, 80, 255), IM_COL32(110, 200, 90, 255),
                           IM_COL32(90, 140, 240, 255)};
  for (const GizmoAxis& axis : gizmo_axes(frame)) {
    const int i = axis.direction.x != 0.0f ? 0 : axis.direction.y != 0.0f ? 1 : 2;
    const bool positive = axis.direction[i] > 0.0f;
    const ImU32 color = positive ? colors[i] : (colors[i] & 0x00ffffffu) | 0x70000000u;
    if (positive) list.AddLine(middle, axis.at, color, 2.0f);
    list.AddCircleFilled(axis.at, positive ? gizmo_radius() : 0.6f * gizmo_radius(), color);
    mark(std::string("axis ") + (positive ? "+" : "-") + names[i],
         {axis.at.x - 0.5f * gizmo_radius(), axis.at.y - 0.5f * gizmo_radius()},
         {axis.at.x + 0.5f * gizmo_radius(), axis.at.y + 0.5f * gizmo_radius()});
    if (!positive) continue;
    const ImVec2 size = ImGui::CalcTextSize(names[i]);
    list.AddText({std::floor(axis.at.x - 0.5f * size.x), std::floor(axis.at.y - 0.5f * size.y)},
                 IM_COL32(20, 20, 20, 255), names[i]);
  }
}

void draw_values(Frame& frame) {
  if (!frame.state.show_values || !frame.state.hovered.pixel) return;
  const std::vector<std::string> lines =
      describe(frame.snapshot, frame.edited.view, *frame.state.hovered.pixel);
  float width = 0.0f;
  for (const std::string& line : lines)
    width = std::max(width, ImGui::CalcTextSize(line.c_str()).x);
  const float height = 1.2f * em();
  const ViewportState& viewport = frame.state.viewport;
  // The upper left corner, or the lower right one when the cursor is there.
  const ImVec2 size = {width + em(), height * static_cast<float>(lines.size()) + 0.8f * em()};
  ImVec2 at = {viewport.lo.x + 0.5f * em(), viewport.lo.y + 0.5f * em()};
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (mouse.x < at.x + size.x + em() && mouse.y < at.y + size.y + em()) {
    at = {viewport.hi.x - size.x - 0.5f * em(), viewport.hi.y - size.y - 0.5f * em()};
  }
  at = {std::floor(at.x), std::floor(at.y)};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, IM_COL32(16, 18, 22, 190), 4.0f);
  mark("values", at, {at.x + size.x, at.y + size.y});
  for (size_t i = 0; i < lines.size(); ++i) {
    list.AddText(
        {at.x + 0.5f * em(), std::floor(at.y + 0.4f * em() + static_cast<float>(i) * height)},
        ImGui::GetColorU32(ImGuiCol_Text), lines[i].c_str());
  }
}

}  // namespace ui
