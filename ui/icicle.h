// The icicle's picture, and what the mouse does in it.
#pragma once

#include "tracer/render/measure_colors.h"
#include "ui/workspace_state.h"

namespace ui {

// Fills `size` with the shown part. Hovering, selecting and zooming work unless `stale`: then the
// tree that it is of is gone.
void draw_icicle_cells(Frame& frame, const std::shared_ptr<const tracer::Icicle>& icicle,
                       ImVec2 size, bool stale);

// The same as areas (tracer/analyze/treemap.h).
void draw_treemap(Frame& frame, const std::shared_ptr<const tracer::Icicle>& icicle, ImVec2 size,
                  bool stale);

// A click in either. The selected instance stays if it shows the node.
void choose_node(Frame& frame, const NodePlace& place);

// The colours with their numbers, from the top down.
void draw_color_scale(const char* label, const tracer::Icicle& icicle, bool logarithmic,
                      ImVec2 size, const char* help);

// "node 12 of mesh 3, a leaf"; its triangles and what is known of it, a line each.
std::string node_text(const tracer::Icicle& icicle, uint32_t node);

}  // namespace ui
