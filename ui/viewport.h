// The parts of the viewport: where its picture is, what the mouse does, what is drawn over it.
#pragma once

#include <array>
#include <optional>

#include "tracer/scene/camera.h"
#include "ui/workspace_state.h"

namespace ui {

// Between pixels of the film and the screen.
ImVec2 screen_from_pixel(const Frame& frame, tracer::vec2 pixel);
tracer::vec2 pixel_from_screen(const Frame& frame, ImVec2 at);
// Nothing outside the picture.
std::optional<tracer::ivec2> pixel_at(const Frame& frame, ImVec2 at);

// Where a point of the world is on the screen, as the film's camera saw it.
std::optional<ImVec2> screen_from_world(const Frame& frame, tracer::vec3 point);

// Lines and boxes of the world over the picture, dark outlined; what is behind the camera is cut
// off. Corner i of a box has the upper coordinate of an axis where its bit of i is set.
void world_line(Frame& frame, const tracer::CameraFrame& camera, tracer::vec3 a, tracer::vec3 b,
                ImU32 color, float width);
void world_box(Frame& frame, const tracer::CameraFrame& camera,
               const std::array<tracer::vec3, 8>& corners, ImU32 color, float width);

// Orbit, pan, zoom, look, drag a light, select. The item is the picture's invisible button.
void viewport_mouse(Frame& frame, bool hovered);
void viewport_fly(Frame& frame);

// The light whose handle is at a place on the screen, or tracer::none.
uint32_t light_at(const Frame& frame, ImVec2 at);

// A light that follows the mouse: in the plane of the picture, or along the camera's up axis.
tracer::vec3 moved_light(const tracer::CameraFrame& frame, tracer::vec3 position, tracer::vec3 up,
                         tracer::vec2 pixels, bool along_up);

struct GizmoAxis {
  tracer::vec3 direction;
  ImVec2 at;  // of its end, on the screen
  float depth;
};
// The six ends of the axes, the farthest first.
std::array<GizmoAxis, 6> gizmo_axes(const Frame& frame);
float gizmo_radius();  // of an end

void draw_gizmo(Frame& frame);
void draw_light_handles(Frame& frame);
void draw_selection(Frame& frame);
void draw_node_pixels(Frame& frame);  // those that the Node panel asks to show
void draw_values(Frame& frame);
void draw_replay(Frame& frame);         // of the Replay panel, while it is on show
void draw_followed_rays(Frame& frame);  // of the Ray panel, while it is on show

}  // namespace ui
