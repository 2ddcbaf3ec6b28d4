// The actions.
#include "ui/actions.h"

#include "tracer/choice.h"
#include "tracer/render/views.h"
#include "ui/browse.h"
#include "ui/camera_control.h"
#include "ui/history.h"
#include "ui/pick.h"

namespace ui {

void fit_range(Frame& frame) {
  if (frame.picture == nullptr || !frame.picture->has_range) return;
  frame.edited.view.range = frame.picture->histogram.range;
}

void toggle_wireframe(Frame& frame) {
  std::string& view = frame.edited.view.view;
  std::string& before = frame.state.viewport.view_before;
  if (view == "wireframe") {
    view = before.empty() ? "shaded" : before;
  } else {
    before = view;
    view = "wireframe";
  }
}

void choose_view(Frame& frame, int number) {
  const auto views = tracer::views();
  if (number >= 1 && static_cast<size_t>(number) <= views.size()) {
    frame.edited.view.view = views[number - 1].id;
  }
}

void toggle_play(Frame& frame) {
  frame.state.playing = !frame.state.playing;
}

void clear_selection(Frame& frame) {
  frame.state.selection = {};
}

void focus_selection(Frame& frame) {
  if (!frame.edited.settings.look) return;
  tracer::Camera& camera = frame.edited.settings.look->camera;
  const uint32_t light = frame.state.selection.light;
  if (light < frame.edited.settings.look->lights.size()) {
    const tracer::vec3 at = frame.edited.settings.look->lights[light].position;
    const tracer::vec3 move = at - camera.target;
    camera.eye += move;
    camera.target = at;
    return;
  }
  camera =
      focused_on(camera, selected_bounds(frame.snapshot, frame.state.selection), aspect(frame));
}

void reset_camera(Frame& frame) {
  if (!frame.edited.settings.look || !frame.snapshot.scene) return;
  frame.edited.settings.look->camera = frame.snapshot.scene->camera;
}

void toggle_orthographic(Frame& frame) {
  if (!frame.edited.settings.look) return;
  bool& orthographic = frame.edited.settings.look->camera.orthographic;
  orthographic = !orthographic;
}

void look_from(Frame& frame, tracer::vec3 direction) {
  if (!frame.edited.settings.look) return;
  tracer::Camera& camera = frame.edited.settings.look->camera;
  camera = seen_along(camera, -direction);
}

void delete_selected_light(Frame& frame) {
  if (!frame.edited.settings.look) return;
  std::vector<tracer::Light>& lights = frame.edited.settings.look->lights;
  uint32_t& selected = frame.state.selection.light;
  if (selected >= lights.size()) return;
  lights.erase(lights.begin() + selected);
  selected = tracer::none;
}

void undo_edit(Frame& frame) {
  undo(frame.edited, frame.state);
}

void redo_edit(Frame& frame) {
  redo(frame.edited, frame.state);
}

void browse(Frame& frame, FilePurpose purpose) {
  open_browser(frame.state.browser, purpose);
}

void reset_layout(Frame& frame) {
  frame.state.layout = default_layout();
}

void open_builtin(Frame& frame, std::string_view id) {
  frame.requests.open = std::string(id);
}

float scene_size(const tracer::Snapshot& snapshot) {
  if (!snapshot.bvh) return 1.0f;
  const float size = glm::length(tracer::extent(tracer::bounds(*snapshot.bvh)));
  return size > 0.0f ? size : 1.0f;
}

float aspect(const Frame& frame) {
  const tracer::RenderOptions& render = frame.edited.settings.render;
  return render.height > 0 ? static_cast<float>(render.width) / static_cast<float>(render.height)
                           : 1.0f;
}

}  // namespace ui
