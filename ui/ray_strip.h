// All steps of a ray as a strip: x is the step, y the depth, the colour what happened.
#pragma once

#include "ui/ray_view.h"

namespace ui {

struct RayStrip {
  const tracer::RayLog& log;
  const tracer::LoggedRay& ray;
  std::string title;                    // to the left, a line for each '\n'; empty: no room for it
  std::optional<uint32_t> now;          // the step that is shown
  std::optional<uint32_t> lit;          // hovered elsewhere
  std::optional<NodePlace> lit_node{};  // its steps get a mark
};
struct StripMouse {
  std::optional<uint32_t> hovered, chosen;  // steps
};

// Fills `size`. The depth goes on from the TLAS into the instances' trees, and to the triangles.
StripMouse draw_ray_strip(const char* label, const RayStrip& strip, ImVec2 size);

// The rows of the strip: for each step how far below the root of the TLAS it is.
std::vector<uint32_t> strip_depths(const tracer::LoggedRay& ray);

// What the colours mean, as one or more lines.
void draw_strip_legend();

}  // namespace ui
