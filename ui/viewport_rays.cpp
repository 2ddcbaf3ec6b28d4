// Over the picture: the rays of the Ray panel by class, and where the one that is followed is now.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tracer/analyze/ray_words.h"
#include "ui/actions.h"
#include "ui/pick.h"
#include "ui/ray_view.h"
#include "ui/registry.h"
#include "ui/viewport.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::CameraFrame;
using tracer::LoggedRay;
using tracer::RayLog;
using tracer::Step;
using tracer::StepKind;
using tracer::vec3;

constexpr ImU32 shadow = IM_COL32(0, 0, 0, 200);
constexpr ImU32 waiting_color = IM_COL32(170, 150, 255, 120);

ImU32 faded(ImU32 color, float part) {
  const auto alpha = static_cast<ImU32>(static_cast<float>(color >> IM_COL32_A_SHIFT) * part);
  return (color & 0x00ffffffu) | (alpha << IM_COL32_A_SHIFT);
}

vec3 at(const tracer::Ray& ray, float t) {
  return ray.origin + t * ray.direction;
}

// Where the drawn line ends: at the hit, at the light, or somewhere outside the scene.
float end_of(const Frame& frame, const tracer::CastRay& cast) {
  if (is_hit(cast.hit)) return cast.hit.t;
  if (cast.ray.t_max < tracer::infinity) return cast.ray.t_max;
  const float length = glm::length(cast.ray.direction);
  return length > 0.0f ? 1.2f * scene_size(frame.snapshot) / length : 0.0f;
}

void draw_dot(ImDrawList& list, ImVec2 place, float radius, ImU32 color) {
  list.AddCircleFilled(place, radius + 1.0f, shadow);
  list.AddCircleFilled(place, radius, color);
}

void draw_cross(ImDrawList& list, ImVec2 place, float size, ImU32 color) {
  for (const auto& [stroke, width] : {std::pair(shadow, 4.0f), std::pair(color, 2.0f)}) {
    list.AddLine({place.x - size, place.y - size}, {place.x + size, place.y + size}, stroke, width);
    list.AddLine({place.x - size, place.y + size}, {place.x + size, place.y - size}, stroke, width);
  }
}

void draw_one(Frame& frame, const CameraFrame& camera, const LoggedRay& ray, bool lit) {
  const tracer::CastRay& cast = ray.cast;
  const ImU32 color = faded(ray_color(cast.ray_class), lit ? 1.0f : 0.75f);
  const float width = (lit ? 2.0f : 1.6f) * frame.state.scale;
  const float end = end_of(frame, cast);
  const bool lost = !is_hit(cast.hit) && !(cast.ray.t_max < tracer::infinity);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (lost) {  // fades away
    constexpr int parts = 16;
    for (int i = 0; i < parts; ++i) {
      const float from = static_cast<float>(i) / parts, to = static_cast<float>(i + 1) / parts;
      world_line(frame, camera, at(cast.ray, from * end), at(cast.ray, to * end),
                 faded(color, 1.0f - from), width);
    }
  } else {
    world_line(frame, camera, at(cast.ray, 0.0f), at(cast.ray, end), color, width);
  }
  const float size = (lit ? 0.25f : 0.18f) * em();
  if (const auto place = screen_from_world(frame, cast.ray.origin)) {
    list.AddCircle(*place, size, color, 0, 1.5f);
  }
  if (!is_hit(cast.hit)) return;
  if (const auto place = screen_from_world(frame, at(cast.ray, end))) {
    draw_cross(list, *place, size, color);
  }
}

void draw_node(Frame& frame, const CameraFrame& camera, const tracer::SceneBvh& bvh,
               uint32_t instance, uint32_t node, ImU32 color, float width) {
  const bool tlas = instance == tracer::none;
  const std::optional<tracer::Box> box =
      node_box(bvh, {tlas ? tracer::none : bvh.instances[instance].mesh, node});
  if (!box) return;
  const tracer::mat4 to_world = tlas ? tracer::mat4(1.0f) : bvh.instances[instance].to_world;
  world_box(frame, camera, box_corners(*box, to_world), color, width * frame.state.scale);
}

// The box of the step's node; of a triangle that of its leaf, of an instance its root.
void draw_step_box(Frame& frame, const CameraFrame& camera, const RayLog& log, const LoggedRay& ray,
                   uint32_t index, ImU32 color, float width) {
  const Step& step = ray.steps[index];
  if (step.kind == StepKind::instance) {
    draw_node(frame, camera, *log.bvh, step.id, 0, color, width);
  } else if (const std::optional<NodePlace> place = node_of(log, ray, index)) {
    draw_node(frame, camera, *log.bvh, step.instance, place->node, color, width);
  }
}

void draw_label(ImDrawList& list, ImVec2 place, const std::string& text, ImU32 color) {
  const ImVec2 left = {std::floor(place.x + 0.5f * em()), std::floor(place.y - 0.5f * em())};
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  list.AddRectFilled({left.x - 2.0f, left.y - 1.0f},
                     {left.x + size.x + 2.0f, left.y + size.y + 1.0f}, IM_COL32(16, 18, 22, 190),
                     3.0f);
  list.AddText(left, color, text.c_str());
}

// Where the ray enters the box, and the nearest hit so far.
void draw_distances(Frame& frame, const RayLog& log, const LoggedRay& ray, const Step& step) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool box = step.kind == StepKind::node || step.kind == StepKind::leaf;
  const bool best_is_hit = step.t_best < ray.cast.ray.t_max;
  if (best_is_hit) {
    if (const auto place = screen_from_world(frame, at(ray.cast.ray, step.t_best))) {
      draw_dot(list, *place, 0.3f * em(), IM_COL32(240, 96, 60, 255));
      draw_label(list, {place->x, place->y + em()}, "best t " + short_number(step.t_best),
                 IM_COL32(255, 170, 140, 255));
    }
  }
  if (!box || step.result == tracer::StepResult::missed) return;
  if (tracer::is_untested(*log.bvh, ray, frame.state.ray.step)) return;
  if (const auto place = screen_from_world(frame, at(ray.cast.ray, step.t_entry))) {
    draw_dot(list, *place, 0.25f * em(), step_look(step).color);
    draw_label(list, {place->x, place->y - em()}, "entry t " + short_number(step.t_entry),
               step_look(step).color);
  }
}

void draw_step(Frame& frame, const CameraFrame& camera, const RayLog& log, const LoggedRay& ray) {
  const RayState& state = frame.state.ray;
  if (state.step >= ray.steps.size()) return;
  const Step& step = ray.steps[state.step];
  if (state.stepped && state.show_boxes) {
    for (const uint32_t node : step.stack)
      draw_node(frame, camera, *log.bvh, step.instance, node, waiting_color, 1.0f);
    draw_step_box(frame, camera, log, ray, state.step, step_look(step).color, 2.0f);
  }
  if (state.hovered_step < ray.steps.size()) {
    draw_step_box(frame, camera, log, ray, state.hovered_step, IM_COL32(255, 200, 60, 255), 1.5f);
  }
  if (state.stepped) draw_distances(frame, log, ray, step);
}

// The classes there are, at the picture's right edge below the axes; heat maps and boxes have their
// legends in the lower corners.
void draw_legend(Frame& frame, const RayLog& log) {
  std::array<uint32_t, tracer::ray_class_count> counts{};
  for (const LoggedRay& ray : log.rays)
    ++counts[static_cast<size_t>(ray.cast.ray_class)];
  std::vector<std::pair<std::string, ImU32>> lines;
  float width = 0.0f;
  for (int i = 0; i < tracer::ray_class_count; ++i) {
    if (counts[static_cast<size_t>(i)] == 0) continue;
    lines.emplace_back(
        fmt::format("{} {}", counts[static_cast<size_t>(i)], tracer::ray_classes()[i].id),
        ray_color(static_cast<tracer::RayClass>(i)));
    width = std::max(width, ImGui::CalcTextSize(lines.back().first.c_str()).x);
  }
  const float line = 1.2f * em();
  const ImVec2 size = {width + 2.6f * em(), line * static_cast<float>(lines.size()) + 0.6f * em()};
  const ViewportState& viewport = frame.state.viewport;
  const ImVec2 lo = {std::floor(viewport.hi.x - size.x - 0.5f * em()),
                     std::floor(viewport.lo.y + 7.0f * em())};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(lo, {lo.x + size.x, lo.y + size.y}, IM_COL32(16, 18, 22, 190), 4.0f);
  mark("ray legend", lo, {lo.x + size.x, lo.y + size.y});
  for (size_t i = 0; i < lines.size(); ++i) {
    const float y = std::floor(lo.y + 0.3f * em() + static_cast<float>(i) * line);
    list.AddLine({lo.x + 0.5f * em(), y + 0.5f * em()}, {lo.x + 1.6f * em(), y + 0.5f * em()},
                 lines[i].second, 2.0f);
    list.AddText({lo.x + 2.0f * em(), y}, ImGui::GetColorU32(ImGuiCol_Text),
                 lines[i].first.c_str());
  }
}

}  // namespace

void draw_followed_rays(Frame& frame) {
  if (!is_ray_shown(frame.state)) return;
  const RayState& state = frame.state.ray;
  const RayView view = ray_view(frame);
  const RayLog* log = stepped_log(frame, view);
  const LoggedRay* ray = stepped_ray(frame, view);
  if (ray == nullptr) return;
  const CameraFrame camera = film_frame(frame.snapshot);
  if (state.shown_rays == "all") {
    for (const LoggedRay& other : log->rays) {
      if (&other != ray) draw_one(frame, camera, other, false);
    }
  }
  if (state.shown_rays != "none") {
    draw_one(frame, camera, *ray, true);
    if (state.hovered_ray < log->rays.size()) {
      draw_one(frame, camera, log->rays[state.hovered_ray], true);
    }
    draw_legend(frame, *log);
  }
  draw_step(frame, camera, *log, *ray);
}

}  // namespace ui
