// The Ray panel's lists: the rays of the pixel as a tree, and the steps of one of them.
#pragma once

#include "ui/ray_view.h"

namespace ui {

// Counters of each ray; where there are two logs, those of now with the difference. Fills `size`.
void draw_ray_list(Frame& frame, const RayView& view, ImVec2 size);

// The steps of the ray that is followed. Fills `size`.
void draw_step_list(Frame& frame, const RayView& view, ImVec2 size);

}  // namespace ui
