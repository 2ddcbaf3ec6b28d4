// Where the picture is taken from.
#include <fmt/format.h>

#include "ui/actions.h"
#include "ui/panels.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::vec3;

void draw_up_axis(tracer::Camera& camera) {
  row_label("Up axis", "Which axis of the world points up in the picture");
  const Scope scope("Up axis");
  const char* names[3] = {"X", "Y", "Z"};
  for (int i = 0; i < 3; ++i) {
    vec3 axis(0.0f);
    axis[i] = 1.0f;
    if (i > 0) ImGui::SameLine();
    if (ImGui::RadioButton(names[i], camera.up == axis)) camera.up = axis;
    mark(names[i]);
    tooltip("Which axis of the world points up in the picture");
  }
}

// Directions relative to the up axis: front looks along the next but one axis, right along the
// next.
void draw_presets(Frame& frame, const tracer::Camera& camera) {
  heading("Look from");
  const Scope scope("from");
  const int up = camera.up.x > 0.5f ? 0 : camera.up.z > 0.5f ? 2 : 1;
  // With z up, the front is towards -y; else towards the next axis but y.
  const int front = up == 2 ? 1 : 2;
  const int right = up == 0 ? 1 : 0;
  const float sign = up == 2 ? -1.0f : 1.0f;
  struct Preset {
    const char* label;
    int axis;
    float side;
  };
  const float width = (std::min(ImGui::GetContentRegionAvail().x, 26.0f * em()) -
                       2.0f * ImGui::GetStyle().ItemSpacing.x) /
                      3.0f;
  int column = 0;
  for (const Preset& preset :
       {Preset{"Front", front, sign}, Preset{"Right", right, 1.0f}, Preset{"Top", up, 1.0f},
        Preset{"Back", front, -sign}, Preset{"Left", right, -1.0f}, Preset{"Bottom", up, -1.0f}}) {
    if (column++ % 3 != 0) ImGui::SameLine();
    vec3 direction(0.0f);
    direction[preset.axis] = preset.side;
    if (button(preset.label, "Look at the target from this side", width)) {
      look_from(frame, direction);
    }
  }
}

void draw_bookmarks(Frame& frame, tracer::Camera& camera) {
  heading("Bookmarks");
  std::vector<Bookmark>& bookmarks = frame.state.bookmarks;
  input("Name", frame.state.bookmark_name, "of a new bookmark", "How the bookmark will be called");
  if (button("Remember this view", "Add the present camera to the bookmarks")) {
    const std::string& name = frame.state.bookmark_name;
    bookmarks.push_back(
        {name.empty() ? fmt::format("view {}", bookmarks.size() + 1) : name, camera});
    frame.state.bookmark_name.clear();
  }
  size_t removed = bookmarks.size();
  for (size_t i = 0; i < bookmarks.size(); ++i) {
    const Scope scope("bookmark", i);
    const float width = ImGui::GetContentRegionAvail().x - 5.5f * em();
    if (ImGui::Selectable(bookmarks[i].name.c_str(), bookmarks[i].camera == camera, 0,
                          {std::max(width, em()), 0})) {
      camera = bookmarks[i].camera;
    }
    mark("Go");
    tooltip("Go to this view");
    ImGui::SameLine();
    if (ImGui::SmallButton("Remove")) removed = i;
    mark("Remove");
    tooltip("Forget this bookmark");
  }
  if (removed < bookmarks.size()) {
    bookmarks.erase(bookmarks.begin() + static_cast<std::ptrdiff_t>(removed));
  }
}

}  // namespace

void draw_camera(Frame& frame) {
  if (!frame.edited.settings.look) {
    hint("The camera appears with the scene.");
    return;
  }
  tracer::Camera& camera = frame.edited.settings.look->camera;
  heading("Place");
  const float speed = 0.002f * scene_size(frame.snapshot);
  tracer::Camera moved = camera;
  drag3("Eye", moved.eye, speed, "World units; where the picture is taken from");
  drag3("Target", moved.target, speed, "World units; what is turned about, and in the middle");
  if (moved.eye != moved.target) camera = moved;  // a camera needs a direction
  slider("Field of view", camera.fov_degrees, 1.0f, 170.0f, "Vertical opening angle", "%.1f°");
  checkbox("Orthographic", camera.orthographic,
           "Parallel rays: sizes do not shrink with the distance (O)");
  draw_up_axis(camera);
  if (button("Focus", "On the selection, or on everything (F)")) focus_selection(frame);
  ImGui::SameLine();
  if (button("Reset", "Back to the scene's own camera (R)")) reset_camera(frame);
  draw_presets(frame, camera);
  heading("Flying");
  slider("Fly speed", frame.state.fly_speed, 0.05f, 20.0f,
         "Of W A S D, E and Q; at 1 a quarter of the scene's size in a second", "%.2f x", true);
  draw_bookmarks(frame, camera);
}

}  // namespace ui
