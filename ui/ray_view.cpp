// Follows rays.
#include "ui/ray_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ui {
namespace {

using tracer::LoggedRay;
using tracer::RayClass;
using tracer::RayLog;
using tracer::Step;
using tracer::StepKind;
using tracer::StepResult;

// After Okabe and Ito's colours, which the colour-blind can tell apart; what rays pay for is
// bright.
constexpr StepLook looks[] = {
    {"Inner node", "Entered: the boxes of its children are tested", IM_COL32(86, 160, 233, 255)},
    {"Leaf", "Entered: what is in it is tested", IM_COL32(0, 190, 140, 255)},
    {"Instance", "Entered: from the TLAS into the tree of a mesh", IM_COL32(200, 210, 225, 255)},
    {"Missed", "A child whose box the ray does not meet", IM_COL32(98, 102, 112, 255)},
    {"Behind", "Dropped: its box begins behind the nearest hit or the ray's end",
     IM_COL32(190, 110, 170, 255)},
    {"Triangle", "Tested and not hit", IM_COL32(240, 228, 66, 255)},
    {"Hit", "A triangle that is hit, nearer than all before", IM_COL32(240, 96, 60, 255)},
};

bool in_picture(const tracer::Snapshot& snapshot, tracer::ivec2 pixel) {
  return pixel.x >= 0 && pixel.y >= 0 && pixel.x < snapshot.film.width &&
         pixel.y < snapshot.film.height;
}

void start_again(RayState& state) {
  state.ray = 0;
  state.step = 0;
  state.before = false;
  state.stepped = false;
  state.playing = false;
  state.reveal = true;
}

void select_step(Frame& frame, const RayLog& log, const LoggedRay& ray) {
  if (log.bvh != frame.snapshot.bvh) return;
  const Step& step = ray.steps[frame.state.ray.step];
  Selection selection;
  selection.pixel = frame.state.selection.pixel;
  selection.instance = step.kind == StepKind::instance ? step.id : step.instance;
  if (step.kind == StepKind::triangle) selection.triangle = step.id;
  selection.node = node_of(log, ray, frame.state.ray.step);
  frame.state.selection = selection;
}

void play(Frame& frame, const RayView& view) {
  RayState& state = frame.state.ray;
  if (!state.playing) return;
  const LoggedRay* ray = stepped_ray(frame, view);
  if (ray == nullptr || state.step + 1 >= ray->steps.size()) {
    state.playing = false;
    return;
  }
  frame.state.animating = true;
  state.due += state.speed * std::min(ImGui::GetIO().DeltaTime, 0.25f);
  const float whole = std::floor(state.due);
  state.due -= whole;
  if (whole > 0.0f) go_to_step(frame, int64_t{state.step} + static_cast<int64_t>(whole));
}

// An arrow key that is held goes on stepping, after a pause.
void repeat_key(Frame& frame) {
  constexpr float pause = 0.35f;  // seconds
  constexpr float rate = 25.0f;   // steps a second
  RayState& state = frame.state.ray;
  const int way = int{frame.state.held[key_right]} - int{frame.state.held[key_left]};
  if (way == 0 || ImGui::GetIO().WantTextInput) {
    if (!state.playing) state.due = 0.0f;
    return;
  }
  if (state.playing || state.due == 0.0f) state.due = -pause * rate;
  state.playing = false;
  frame.state.animating = true;
  state.due += rate * std::min(ImGui::GetIO().DeltaTime, 0.25f);
  const float whole = std::floor(std::max(state.due, 0.0f));
  if (whole == 0.0f) return;
  state.due = std::max(state.due - whole, 1e-6f);
  go_to_step(frame, int64_t{state.step} + way * static_cast<int64_t>(whole));
}

void ask_for_rays(Frame& frame) {
  const RayState& state = frame.state.ray;
  if (state.locked) {
    if (state.locked->bvh != frame.snapshot.bvh) {
      frame.requests.log_rays = RayRequest{state.locked->pixel, state.locked};
    }
  } else if (state.pixel && in_picture(frame.snapshot, *state.pixel)) {
    frame.requests.log_rays = RayRequest{*state.pixel, nullptr};
  }
}

}  // namespace

RayView ray_view(const Frame& frame) {
  const RayState& state = frame.state.ray;
  const std::shared_ptr<const LoggedRays>& result = frame.work.rays.result;
  if (!state.locked) {
    if (!state.pixel || !result || !in_picture(frame.snapshot, *state.pixel)) return {};
    return {nullptr, result->log};
  }
  const bool again = result && result->of.again == state.locked;
  if (state.locked->bvh == frame.snapshot.bvh || !again) return {nullptr, state.locked};
  return {state.locked, result->log};
}

const RayLog* stepped_log(const Frame& frame, const RayView& view) {
  return frame.state.ray.before && view.before ? view.before.get() : view.now.get();
}

const LoggedRay* stepped_ray(const Frame& frame, const RayView& view) {
  const RayLog* log = stepped_log(frame, view);
  return log != nullptr && frame.state.ray.ray < log->rays.size() ? &log->rays[frame.state.ray.ray]
                                                                  : nullptr;
}

bool is_ray_shown(const UiState& state) {
  return state.ray.drawn_in + 1 >= ImGui::GetFrameCount();
}

void follow_ray(Frame& frame) {
  RayState& state = frame.state.ray;
  state.drawn_in = ImGui::GetFrameCount();
  if (state.scene_generation != frame.snapshot.scene_generation) {
    state.scene_generation = frame.snapshot.scene_generation;
    state.locked.reset();
    state.pixel.reset();
    start_again(state);
  }
  const std::optional<tracer::ivec2>& selected = frame.state.selection.pixel;
  if (!state.locked && selected && selected != state.pixel) {
    state.pixel = selected;
    start_again(state);
  }
  ask_for_rays(frame);
  const RayView view = ray_view(frame);
  if (const RayLog* log = stepped_log(frame, view)) {
    state.ray = std::min(state.ray, static_cast<uint32_t>(log->rays.size()) - 1);
    const size_t steps = log->rays[state.ray].steps.size();
    state.step = std::min(state.step, static_cast<uint32_t>(std::max<size_t>(steps, 1)) - 1);
  }
  play(frame, view);
  repeat_key(frame);
}

void go_to_step(Frame& frame, int64_t step) {
  const RayView view = ray_view(frame);
  const LoggedRay* ray = stepped_ray(frame, view);
  if (ray == nullptr || ray->steps.empty()) return;
  RayState& state = frame.state.ray;
  state.step = static_cast<uint32_t>(
      std::clamp<int64_t>(step, 0, static_cast<int64_t>(ray->steps.size()) - 1));
  state.stepped = true;
  state.reveal = true;
  select_step(frame, *stepped_log(frame, view), *ray);
}

void choose_ray(Frame& frame, uint32_t ray) {
  frame.state.ray.ray = ray;
  frame.state.ray.playing = false;
  go_to_step(frame, 0);
}

void toggle_lock(Frame& frame) {
  RayState& state = frame.state.ray;
  if (state.locked) {
    state.locked.reset();
    state.before = false;
    return;
  }
  state.locked = ray_view(frame).now;
}

void step_forward(Frame& frame) {
  if (is_ray_shown(frame.state)) go_to_step(frame, int64_t{frame.state.ray.step} + 1);
}

void step_back(Frame& frame) {
  if (is_ray_shown(frame.state)) go_to_step(frame, int64_t{frame.state.ray.step} - 1);
}

void step_to_begin(Frame& frame) {
  if (is_ray_shown(frame.state)) go_to_step(frame, 0);
}

void step_to_end(Frame& frame) {
  if (is_ray_shown(frame.state)) go_to_step(frame, std::numeric_limits<int64_t>::max());
}

std::optional<NodePlace> node_of(const RayLog& log, const LoggedRay& ray, uint32_t index) {
  const auto mesh_of = [&](const Step& step) {
    return step.instance == tracer::none ? tracer::none : log.bvh->instances[step.instance].mesh;
  };
  // A triangle belongs to the leaf that was entered last.
  for (size_t i = index + 1; i-- > 0;) {
    const Step& step = ray.steps[i];
    if (step.kind == StepKind::instance) return {};
    if (step.kind != StepKind::triangle) return NodePlace{mesh_of(step), step.id};
  }
  return {};
}

const StepLook& step_look(const Step& step) {
  switch (step.result) {
    case StepResult::missed:
      return looks[3];
    case StepResult::behind:
      return looks[4];
    case StepResult::tested:
      return looks[5];
    case StepResult::hit:
      return looks[6];
    case StepResult::entered:
      break;
  }
  return looks[step.kind == StepKind::node ? 0 : step.kind == StepKind::leaf ? 1 : 2];
}

std::span<const StepLook> step_looks() {
  return looks;
}

ImU32 ray_color(RayClass ray_class) {
  constexpr ImU32 colors[] = {IM_COL32(245, 245, 245, 255), IM_COL32(204, 121, 167, 255),
                              IM_COL32(230, 159, 0, 255), IM_COL32(0, 190, 140, 255)};
  return colors[static_cast<size_t>(ray_class)];
}

}  // namespace ui
