// The rays that are followed step by step: which logs there are, which step is shown, and how it is
// changed. The panel (panels/ray.cpp), its parts and the picture (viewport_rays.cpp) share it.
#pragma once

#include <span>

#include "ui/workspace_state.h"

namespace ui {

// The logs on show. A locked ray has two once the trees are others than when it was locked.
struct RayView {
  std::shared_ptr<const tracer::RayLog> before;  // the locked log, of trees that are gone
  std::shared_ptr<const tracer::RayLog> now;  // of the trees of the picture, or the newest there is
};
RayView ray_view(const Frame& frame);

// The log whose steps are shown, and the ray in it; nullptr: there is none yet.
const tracer::RayLog* stepped_log(const Frame& frame, const RayView& view);
const tracer::LoggedRay* stepped_ray(const Frame& frame, const RayView& view);

// Whether the panel is on show: drawn in this frame or the last one.
bool is_ray_shown(const UiState& state);

// Once a frame while the panel is on show: follows the selected pixel, asks for the rays, plays,
// and brings ray and step into the range of what there is.
void follow_ray(Frame& frame);

// Goes to a step: its node, triangle and instance are selected if its trees are the picture's.
// Beyond the ends: the first or last step.
void go_to_step(Frame& frame, int64_t step);
void choose_ray(Frame& frame, uint32_t ray);  // and its first step
void toggle_lock(Frame& frame);

// Keys; nothing happens while the panel is not on show.
void step_forward(Frame& frame);
void step_back(Frame& frame);
void step_to_begin(Frame& frame);
void step_to_end(Frame& frame);

// Where the step's node is: its tree and index, of a triangle the leaf; nothing for an instance.
std::optional<NodePlace> node_of(const tracer::RayLog& log, const tracer::LoggedRay& ray,
                                 uint32_t step);

// How a kind of step is shown.
struct StepLook {
  const char *label, *help;
  ImU32 color;
};
const StepLook& step_look(const tracer::Step& step);
std::span<const StepLook> step_looks();

// By RayClass.
ImU32 ray_color(tracer::RayClass ray_class);

}  // namespace ui
