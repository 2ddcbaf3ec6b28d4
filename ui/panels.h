// The panels, as rows. A new panel is one file and one row.
#pragma once

#include <span>
#include <string_view>

#include "ui/workspace_state.h"

namespace ui {

struct PanelRow {
  const char *id, *label, *help;
  Region region;  // where it is in the default layout
  void (*draw)(Frame& frame);
};
std::span<const PanelRow> panels();

void draw_tree(Frame& frame);
void draw_node_panel(Frame& frame);
void draw_viewport(Frame& frame);
void draw_scene(Frame& frame);
void draw_view(Frame& frame);
void draw_render(Frame& frame);
void draw_lights(Frame& frame);
void draw_materials(Frame& frame);
void draw_camera(Frame& frame);
void draw_boxes(Frame& frame);
void draw_build(Frame& frame);
void draw_statistics(Frame& frame);
void draw_builders(Frame& frame);
void draw_benchmark(Frame& frame);
void draw_hot_spots(Frame& frame);
void draw_findings(Frame& frame);
void draw_timeline(Frame& frame);
void draw_icicle(Frame& frame);
void draw_ray(Frame& frame);
void draw_replay_panel(Frame& frame);
void draw_messages(Frame& frame);

}  // namespace ui
