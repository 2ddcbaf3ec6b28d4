// One pixel's rays: what they cost, and one of them step by step.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "tracer/analyze/ray_words.h"
#include "ui/panels.h"
#include "ui/ray_strip.h"
#include "ui/ray_tables.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::Counters;
using tracer::LoggedRay;
using tracer::RayLog;

constexpr Choice shown_rays[] = {
    {"all", "All rays", "All rays of the pixel are drawn over the picture"},
    {"one", "This ray", "The ray that is followed is drawn over the picture"},
    {"none", "No rays", "No ray is drawn over the picture"},
};

void draw_buttons(Frame& frame, const LoggedRay& ray) {
  RayState& state = frame.state.ray;
  const float narrow = 1.9f * em();
  if (button("|<", "To the first step (Home)", narrow)) go_to_step(frame, 0);
  ImGui::SameLine();
  if (button("<", "One step back (Left or ,)", narrow)) go_to_step(frame, int64_t{state.step} - 1);
  ImGui::SameLine();
  if (button(state.playing ? "Pause" : "Play", "Go on step after step", 3.8f * em())) {
    state.playing = !state.playing;
    if (state.playing && state.step + 1 >= ray.steps.size()) go_to_step(frame, 0);
    state.due = 0.0f;
  }
  ImGui::SameLine();
  if (button(">", "One step on (Right or .)", narrow)) go_to_step(frame, int64_t{state.step} + 1);
  ImGui::SameLine();
  if (button(">|", "To the last step (End)", narrow)) {
    go_to_step(frame, static_cast<int64_t>(ray.steps.size()) - 1);
  }
}

void draw_scrub(Frame& frame, const LoggedRay& ray, float width) {
  int step = static_cast<int>(frame.state.ray.step) + 1;
  const int last = std::max(static_cast<int>(ray.steps.size()), 1);
  const std::string format = fmt::format("step %d of {}", ray.steps.size());
  ImGui::SetNextItemWidth(width);
  if (ImGui::SliderInt("##scrub", &step, 1, last, format.c_str(), ImGuiSliderFlags_AlwaysClamp)) {
    frame.state.ray.playing = false;
    go_to_step(frame, step - 1);
  }
  mark("Scrub");
  tooltip("The step that is shown; drag to go through them");
}

// A check box of a line of controls, with its label behind it.
void check(const char* label, bool& value, const char* help) {
  ImGui::Checkbox(label, &value);
  mark(label);
  tooltip(help);
}

void draw_options(Frame& frame) {
  RayState& state = frame.state.ray;
  ImGui::SetNextItemWidth(6.0f * em());
  ImGui::SliderFloat("##speed", &state.speed, 1.0f, 1000.0f, "%.0f a second",
                     ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
  mark("Speed");
  tooltip("Steps a second while playing");
  ImGui::SameLine();
  bool locked = state.locked != nullptr;
  const bool was = locked;
  check("Lock", locked,
        "Keep these rays: the camera can be moved to see them from elsewhere. When the tree "
        "changes, by another builder or another time, the same rays are followed through the new "
        "tree too, and both are shown");
  if (locked != was) toggle_lock(frame);
  ImGui::SameLine();
  check("Boxes", state.show_boxes,
        "Over the picture: the box of the step's node, and dimmer those of the nodes that wait on "
        "the stack");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(6.5f * em());
  const Choice* shown = std::find_if(std::begin(shown_rays), std::end(shown_rays) - 1,
                                     [&](const Choice& row) { return row.id == state.shown_rays; });
  if (ImGui::BeginCombo("##rays", std::string(shown->label).c_str())) {
    for (const Choice& row : shown_rays) {
      if (ImGui::Selectable(std::string(row.label).c_str(), &row == shown)) {
        state.shown_rays = row.id;
      }
      mark("Rays/" + std::string(row.id));
      tooltip(row.help);
    }
    ImGui::EndCombo();
  } else {
    mark("Rays");
    tooltip("Which rays are drawn over the picture. " + std::string(shown->help));
  }
}

void draw_controls(Frame& frame, const LoggedRay& ray) {
  draw_buttons(frame, ray);
  ImGui::SameLine();
  const float options = 26.0f * em() + 5.0f * ImGui::GetStyle().ItemSpacing.x;
  const float left = ImGui::GetContentRegionAvail().x - options;
  const bool one_line = left > 8.0f * em();
  draw_scrub(frame, ray, one_line ? left : -1.0f);
  if (one_line) ImGui::SameLine();
  draw_options(frame);
}

void draw_strip(Frame& frame, const RayStrip& strip, bool before, const char* label, ImVec2 size) {
  RayState& state = frame.state.ray;
  const StripMouse mouse = draw_ray_strip(label, strip, size);
  if (mouse.hovered && strip.now) {
    state.hovered_step = *mouse.hovered;
    if (strip.log.bvh == frame.snapshot.bvh) {
      frame.state.hovered.node = node_of(strip.log, strip.ray, *mouse.hovered);
      frame.state.hovered.instance = strip.ray.steps[*mouse.hovered].instance;
    }
  }
  if (!mouse.chosen || mouse.chosen == strip.now) return;
  state.playing = false;
  state.before = before;
  go_to_step(frame, *mouse.chosen);
}

std::string strip_title(const char* when, const RayLog& log, const LoggedRay& ray) {
  return fmt::format("{}: {}\n{} steps, {} nodes", when, log.bvh->options.builder,
                     grouped(ray.steps.size()), grouped(ray.counters.nodes));
}

// `hovered` is the step under the mouse in the last frame, or none.
void draw_strips(Frame& frame, const RayView& view, uint32_t hovered, float height) {
  const RayState& state = frame.state.ray;
  const LoggedRay& now = view.now->rays[state.ray];
  const float width = ImGui::GetContentRegionAvail().x;
  const auto lit = hovered != tracer::none ? std::optional(hovered) : std::optional<uint32_t>();
  const bool old = state.before && view.before;
  const auto place = [&](bool side) {
    return side == old ? std::optional(state.step) : std::optional<uint32_t>();
  };
  RayStrip strip{*view.now, now, "", place(false), old ? std::nullopt : lit, {}};
  if (view.now->bvh == frame.snapshot.bvh) strip.lit_node = frame.state.selection.node;
  if (!view.before) {
    draw_strip(frame, strip, false, "strip", {width, height});
    return;
  }
  const LoggedRay& before = view.before->rays[state.ray];
  const RayStrip first{*view.before,
                       before,
                       strip_title("Before", *view.before, before),
                       place(true),
                       old ? lit : std::nullopt,
                       {}};
  strip.title = strip_title("Now", *view.now, now);
  draw_strip(frame, first, true, "strip before", {width, height});
  draw_strip(frame, strip, false, "strip", {width, height});
}

// What the two logs have in common, and what not.
std::string difference_words(const RayView& view) {
  size_t differ = 0;
  for (size_t i = 0; i < view.now->rays.size(); ++i) {
    const tracer::CastRay& a = view.before->rays[i].cast;
    const tracer::CastRay& b = view.now->rays[i].cast;
    // Any hit is enough for a shadow ray, so another order may find another one.
    const bool shadow = a.ray_class == tracer::RayClass::shadow;
    if (shadow ? is_hit(a.hit) != is_hit(b.hit) : a.hit != b.hit) ++differ;
  }
  if (differ == 0) return "Both trees give the same hits.";
  return fmt::format("The hits of {} of {} rays differ: the shape has changed, or a tree is wrong.",
                     differ, view.now->rays.size());
}

// Breaks lines at spaces only; ImGui would break numbers behind their point.
std::string wrapped(const std::string& text, float width) {
  std::string lines;
  size_t line = 0;  // where the last one begins
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    const std::string longer = lines.substr(line) + " " + word;
    if (lines.size() > line && ImGui::CalcTextSize(longer.c_str()).x > width) {
      lines += '\n';
      line = lines.size();
    } else if (lines.size() > line) {
      lines += ' ';
    }
    lines += word;
    at = end + 1;
  }
  return lines;
}

void draw_words(Frame& frame, const RayView& view, ImVec2 size) {
  const RayLog& log = *stepped_log(frame, view);
  const LoggedRay& ray = *stepped_ray(frame, view);
  if (ImGui::BeginChild("words", size)) {
    if (ray.steps.empty()) {
      hint("This ray takes no step: it has no length, or the scene is empty.");
    } else {
      const std::string words = tracer::explain(*log.bvh, ray, frame.state.ray.step);
      text(wrapped(words, ImGui::GetContentRegionAvail().x),
           "The step in words. t is measured in lengths of the ray's direction; nodes, triangles "
           "and instances by their index in tree, mesh and scene; depth in edges from the root");
      mark("words");
    }
    if (view.before) {
      hint(difference_words(view),
           "The nearest hit of each ray, of shadow rays whether there is one");
      mark("difference");
    }
    if (frame.state.ray.locked) {
      hint(fmt::format("Locked: the rays of pixel {}, {} stay, however the camera moves.",
                       log.pixel.x, log.pixel.y),
           "From the left and from the top");
      mark("locked");
    }
  }
  ImGui::EndChild();
}

void draw_lists(Frame& frame, const RayView& view) {
  const ImVec2 area = ImGui::GetContentRegionAvail();
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float height = std::max(area.y, 5.0f * em());
  if (area.x < 46.0f * em()) {  // a narrow region: one below the other
    draw_words(frame, view, {area.x, 7.5f * em()});
    draw_ray_list(frame, view, {area.x, 9.0f * em()});
    draw_step_list(frame, view, {area.x, std::max(area.y - 18.0f * em(), 12.0f * em())});
    return;
  }
  const float rays = std::floor((view.before ? 0.34f : 0.28f) * area.x);
  const float words = std::floor(0.25f * area.x);
  draw_ray_list(frame, view, {rays, height});
  ImGui::SameLine();
  draw_words(frame, view, {words, height});
  ImGui::SameLine();
  draw_step_list(frame, view, {area.x - rays - words - 2.0f * gap, height});
}

void draw_empty(const Frame& frame) {
  const RayState& state = frame.state.ray;
  if (!frame.snapshot.scene) {
    hint("Rays can be followed once a scene is there: File > Open scene...");
  } else if (!frame.work.rays.error.empty()) {
    hint(frame.work.rays.error);
  } else if (!state.pixel) {
    hint(
        "Click a pixel in the picture: its rays appear here, with every step they take through "
        "the trees, and over the picture.");
  } else if (frame.work.rays.running || frame.requests.log_rays) {
    hint("The rays are being followed.");
  } else {
    hint("The pixel is outside the picture now. Click a pixel in the picture.");
  }
}

}  // namespace

void draw_ray(Frame& frame) {
  RayState& state = frame.state.ray;
  follow_ray(frame);
  const RayView view = ray_view(frame);
  const LoggedRay* ray = stepped_ray(frame, view);
  if (ray == nullptr) {
    draw_empty(frame);
    return;
  }
  draw_controls(frame, *ray);
  const uint32_t hovered = std::exchange(state.hovered_step, tracer::none);
  state.hovered_ray = tracer::none;
  const float available = ImGui::GetContentRegionAvail().y;
  const float strips = std::clamp(0.3f * available, 3.2f * em(), 12.0f * em());
  draw_strips(frame, view, hovered, view.before ? std::max(0.5f * strips, 2.2f * em()) : strips);
  draw_strip_legend();
  draw_lists(frame, view);
}

}  // namespace ui
