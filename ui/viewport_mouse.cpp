// What the mouse and the held keys do in the viewport.
#include <algorithm>
#include <cmath>

#include <imgui.h>

#include "ui/actions.h"
#include "ui/camera_control.h"
#include "ui/pick.h"
#include "ui/viewport.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::Camera;
using tracer::ivec2;
using tracer::vec2;
using tracer::vec3;

constexpr float radians_per_pixel = 0.006f;
constexpr float click_distance = 4.0f;  // pixels

float squared_distance(ImVec2 a, ImVec2 b) {
  return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
}

bool click_gizmo(Frame& frame, ImVec2 mouse) {
  if (!frame.state.show_gizmo) return false;
  const float radius = gizmo_radius();
  const std::array<GizmoAxis, 6> axes = gizmo_axes(frame);
  for (size_t i = axes.size(); i-- > 0;) {  // the nearest first
    if (squared_distance(axes[i].at, mouse) > radius * radius) continue;
    look_from(frame, axes[i].direction);
    return true;
  }
  return false;
}

void press(Frame& frame, int button) {
  ViewportState& viewport = frame.state.viewport;
  const ImGuiIO& io = ImGui::GetIO();
  viewport.button = button;
  viewport.drag_from = io.MousePos;
  viewport.dragged = false;
  if (button == ImGuiMouseButton_Middle) {
    viewport.drag = ViewportDrag::pan;
  } else if (button == ImGuiMouseButton_Right) {
    viewport.drag = ViewportDrag::look;
  } else {
    const uint32_t light = light_at(frame, io.MousePos);
    if (light != tracer::none) {
      frame.state.selection = {};
      frame.state.selection.light = light;
      viewport.drag = ViewportDrag::light;
    } else if (!click_gizmo(frame, io.MousePos)) {
      viewport.drag = io.KeyShift ? ViewportDrag::pan : ViewportDrag::orbit;
    }
  }
}

// Film pixels a screen pixel.
float film_scale(const Frame& frame) {
  const ViewportState& viewport = frame.state.viewport;
  const float width = viewport.hi.x - viewport.lo.x;
  return width > 0.0f ? static_cast<float>(frame.snapshot.film.width) / width : 1.0f;
}

void drag(Frame& frame, ImVec2 delta) {
  if (!frame.edited.settings.look) return;
  tracer::Look& look = *frame.edited.settings.look;
  const ViewportState& viewport = frame.state.viewport;
  const float x = delta.x * radians_per_pixel / frame.state.scale;
  const float y = delta.y * radians_per_pixel / frame.state.scale;
  const int height = static_cast<int>(std::max(viewport.hi.y - viewport.lo.y, 1.0f));
  switch (viewport.drag) {
    case ViewportDrag::orbit:
      look.camera = orbit(look.camera, x, -y);
      break;
    case ViewportDrag::look:
      look.camera = look_around(look.camera, 0.5f * x, -0.5f * y);
      break;
    case ViewportDrag::pan:
      look.camera = pan(look.camera, {delta.x, delta.y}, height);
      break;
    case ViewportDrag::light: {
      const uint32_t light = frame.state.selection.light;
      if (light >= look.lights.size()) break;
      const float scale = film_scale(frame);
      look.lights[light].position =
          moved_light(film_frame(frame.snapshot), look.lights[light].position, look.camera.up,
                      {delta.x * scale, delta.y * scale}, ImGui::GetIO().KeyShift);
      break;
    }
    case ViewportDrag::none:
      break;
  }
}

void select(Frame& frame, ivec2 pixel) {
  Selection selection;
  selection.pixel = pixel;
  if (const std::optional<Picked> picked = pick(frame.snapshot, pixel)) {
    selection.instance = picked->hit.instance;
    selection.triangle = picked->hit.triangle;
    selection.material = picked->surface.material;
    frame.state.edited_material = selection.material;
  }
  frame.state.selection = selection;
}

void focus_at(Frame& frame, ivec2 pixel) {
  if (!frame.edited.settings.look) return;
  const std::optional<Picked> picked = pick(frame.snapshot, pixel);
  if (!picked) return;
  Camera& camera = frame.edited.settings.look->camera;
  camera = zoom_at(camera, picked->surface.position, 0.5f, 1e-5f * scene_size(frame.snapshot));
  camera.target = picked->surface.position;
}

void release(Frame& frame) {
  ViewportState& viewport = frame.state.viewport;
  const ViewportDrag was = viewport.drag;
  viewport.drag = ViewportDrag::none;
  const std::optional<ivec2> pixel = pixel_at(frame, ImGui::GetIO().MousePos);
  if (viewport.dragged || !pixel) return;
  if (was == ViewportDrag::look) {
    viewport.menu_pixel = *pixel;
    ImGui::OpenPopup("picture menu");
  } else if (was == ViewportDrag::orbit) {
    select(frame, *pixel);
  }
}

void zoom(Frame& frame, float wheel) {
  if (!frame.edited.settings.look) return;
  Camera& camera = frame.edited.settings.look->camera;
  const std::optional<ivec2> pixel = pixel_at(frame, ImGui::GetIO().MousePos);
  vec3 point = camera.target;
  const std::optional<Picked> picked =
      pixel ? pick(frame.snapshot, *pixel) : std::optional<Picked>();
  if (picked) {
    point = picked->surface.position;
  } else if (pixel) {  // nothing there: a point at the target's distance
    const tracer::CameraFrame seen = tracer::frame(camera, std::max(frame.snapshot.film.width, 1),
                                                   std::max(frame.snapshot.film.height, 1));
    const tracer::Ray ray = tracer::primary_ray(seen, vec2(*pixel) + 0.5f);
    const float cosine = std::max(glm::dot(ray.direction, seen.forward), 0.05f);
    point = ray.origin + ray.direction * (glm::length(camera.target - camera.eye) / cosine);
  }
  camera = zoom_at(camera, point, std::pow(0.85f, wheel), 1e-5f * scene_size(frame.snapshot));
}

}  // namespace

vec3 moved_light(const tracer::CameraFrame& frame, vec3 position, vec3 up, vec2 pixels,
                 bool along_up) {
  const std::optional<tracer::Projected> at = tracer::project(frame, position);
  if (!at) return position;
  const float depth = frame.orthographic ? 1.0f : at->depth;
  const float unit = 2.0f * depth * frame.half_size.y / frame.resolution.y;  // world a pixel
  if (!along_up) return position + unit * (pixels.x * frame.right - pixels.y * frame.up);
  const float length = glm::length(up);
  const vec3 axis = length > 0.0f ? up / length : vec3(0, 1, 0);
  const std::optional<tracer::Projected> above =
      tracer::project(frame, position + 10.0f * unit * axis);
  if (!above) return position;
  const vec2 step = 0.1f * (above->pixel - at->pixel);  // on the screen, for `unit` of the world
  const float size = glm::dot(step, step);
  return size > 1e-4f ? position + unit * glm::dot(pixels, step) / size * axis : position;
}

void viewport_mouse(Frame& frame, bool hovered) {
  ViewportState& viewport = frame.state.viewport;
  const ImGuiIO& io = ImGui::GetIO();
  if (viewport.drag == ViewportDrag::none) {
    if (!hovered) return;
    if (io.MouseWheel != 0.0f) zoom(frame, io.MouseWheel);
    for (const int button :
         {ImGuiMouseButton_Left, ImGuiMouseButton_Right, ImGuiMouseButton_Middle}) {
      if (!ImGui::IsMouseClicked(button)) continue;
      const std::optional<ivec2> pixel = pixel_at(frame, io.MousePos);
      if (button == ImGuiMouseButton_Left && pixel && ImGui::IsMouseDoubleClicked(button)) {
        focus_at(frame, *pixel);
        return;
      }
      press(frame, button);
      return;
    }
    return;
  }
  const ImVec2 from = viewport.drag_from;
  const bool far = squared_distance(io.MousePos, from) > click_distance * click_distance;
  if (far && !viewport.dragged) {  // what was moved before it counted as a drag is made up for
    viewport.dragged = true;
    drag(frame, {io.MousePos.x - from.x, io.MousePos.y - from.y});
  } else if (viewport.dragged) {
    drag(frame, io.MouseDelta);
  }
  if (!ImGui::IsMouseDown(viewport.button)) release(frame);
}

void viewport_fly(Frame& frame) {
  UiState& state = frame.state;
  std::bitset<key_count>& flying = state.viewport.flying;
  const ImGuiIO& io = ImGui::GetIO();
  const bool looking = state.viewport.drag == ViewportDrag::look;
  const bool typing = io.WantTextInput || state.browser.visible;
  for (const char key : {'W', 'A', 'S', 'D', 'E', 'Q'}) {
    if (!state.held[key]) flying[key] = false;
    if (state.held[key] && looking) flying[key] = true;
  }
  for (const KeyPress& pressed : frame.keys) {  // Ctrl+S is a command, Ctrl while flying is slow
    const bool fly_key =
        pressed.key < 128 && pressed.key > 0 &&
        std::string_view("WASDEQ").find(static_cast<char>(pressed.key)) != std::string_view::npos;
    if (fly_key && !pressed.alt && (!pressed.control || looking)) flying[pressed.key] = true;
  }
  if (typing) flying.reset();
  if (flying.none() || !frame.edited.settings.look) return;
  vec3 move(0.0f);
  move.x = static_cast<float>(flying['D']) - static_cast<float>(flying['A']);
  move.y = static_cast<float>(flying['E']) - static_cast<float>(flying['Q']);
  move.z = static_cast<float>(flying['W']) - static_cast<float>(flying['S']);
  const float hurry = io.KeyShift ? 4.0f : io.KeyCtrl ? 0.25f : 1.0f;
  const float speed = 0.25f * scene_size(frame.snapshot) * state.fly_speed * hurry;
  Camera& camera = frame.edited.settings.look->camera;
  camera = fly(camera, move * speed * std::min(io.DeltaTime, 0.1f));
  state.animating = true;
}

}  // namespace ui
