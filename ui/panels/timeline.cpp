// Time: playing it, how meshes change their shape with it, how their trees follow, and what the
// ways to follow cost side by side (timeline_curves.h).
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tracer/animation.h"
#include "tracer/choice.h"
#include "ui/actions.h"
#include "ui/panels.h"
#include "ui/registry.h"
#include "ui/timeline_curves.h"
#include "ui/widgets.h"

namespace ui {
namespace {

void draw_transport(Frame& frame) {
  TimelineState& state = frame.state.timeline;
  float& time = frame.edited.settings.time;
  if (button(frame.state.playing ? "Pause" : "Play", "Let the scene's time run (Space)",
             4.5f * em())) {
    toggle_play(frame);
  }
  ImGui::SameLine();
  if (button("Back to 0", "The scene as it was loaded")) time = 0.0f;
  ImGui::SameLine();
  if (button("<", "One frame back")) {
    const float rate = frame.edited.settings.update.frames_per_second;
    time = tracer::time_of(std::max<int64_t>(tracer::frame_at(time, rate) - 1, 0), rate);
  }
  ImGui::SameLine();
  if (button(">", "One frame on")) {
    const float rate = frame.edited.settings.update.frames_per_second;
    time = tracer::time_of(tracer::frame_at(time, rate) + 1, rate);
  }
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1.0f);
  const std::string format = fmt::format(
      "%.2f s, frame {}", tracer::frame_at(time, frame.edited.settings.update.frames_per_second));
  ImGui::SliderFloat("##scrub", &time, state.from, std::max(state.to, state.from + 0.01f),
                     format.c_str());
  time = std::clamp(time, 0.0f, tracer::max_time);
  mark("Scrub");
  tooltip("The moment that is shown, in seconds of the scene's time");
}

void draw_range(Frame& frame) {
  TimelineState& state = frame.state.timeline;
  heading("Playing");
  slider("Speed", frame.state.play_speed, 0.05f, 10.0f, "Scene seconds in a second of playing",
         "%.2f x", true);
  checkbox("Loop", state.loop,
           "Begin again at the left end of the range when its right end is reached");
  bool changed =
      drag("From", state.from, 0.05f, 0.0f, state.to, "Left end of the range, seconds", "%.2f s");
  changed |= drag("To", state.to, 0.05f, state.from + 0.01f, tracer::max_time,
                  "Right end of the range, seconds", "%.2f s");
  if (changed) state.own_range = true;
  if (state.own_range && button("One swing", "The range becomes one swing of the deformer")) {
    state.own_range = false;
  }
  slider("Frame rate", frame.edited.settings.update.frames_per_second, 1.0f, 120.0f,
         "Frames of the animation in a second of scene time: what 'every N frames' counts, and "
         "what is measured",
         "%.0f a second");
}

void draw_deformer(Frame& frame) {
  tracer::Deformer& deformer = frame.edited.settings.deformer;
  heading("Meshes");
  combo("Deformer", deformer.kind, tracer::deformers(),
        "How all meshes change their shape; each by its own size");
  const tracer::DeformerRow* row = tracer::find_row(tracer::deformers(), deformer.kind);
  if (row == nullptr || row->deform == nullptr) return;
  hint(row->help);
  slider("Amount", deformer.amount, -tracer::max_amount, tracer::max_amount,
         fmt::format("How far: {}", row->amount).c_str(), "%.2f");
  combo("Axis", deformer.axis, tracer::axes(), "Axis of the mesh's own space");
  slider("Swings", deformer.speed, 0.0f, tracer::max_speed,
         "Swings a second; 0 holds the shape at its amount", "%.2f a second", true);
  if (tracer::is_active(deformer) &&
      tracer::strength_at(deformer, frame.edited.settings.time) == 0.0) {
    hint("At rest at this moment: press Play, or move the time.");
  }
}

void draw_motion(Frame& frame) {
  tracer::InstanceMotion& motion = frame.edited.settings.motion;
  heading("Instances");
  combo("Motion", motion.kind, tracer::motions(), "How all instances move; costs the top level");
  const tracer::MotionRow* row = tracer::find_row(tracer::motions(), motion.kind);
  if (row != nullptr && row->uses_speed) {
    slider("Motion speed", motion.speed, 0.0f, 4.0f, "Turns or bounces a second", "%.2f a second");
  }
  const bool own = row == nullptr || row->motion == nullptr;
  if (own && frame.snapshot.scene && !frame.state.scene.moves) {
    hint("No instance of this scene moves by itself.");
  }
}

void draw_strategy(Frame& frame) {
  tracer::UpdateOptions& update = frame.edited.settings.update;
  heading("Update of the trees");
  combo("Strategy", update.strategy, tracer::updates(),
        "What happens to the trees of meshes that change their shape");
  const tracer::UpdateRow* row = tracer::find_row(tracer::updates(), update.strategy);
  if (row == nullptr) return;
  hint(row->help);
  // The curves below compare strategies that are not chosen, too.
  slider("N", update.every, 1, 120, "Frames from one build to the next, in 'Rebuild every N'");
  slider("F", update.growth, tracer::min_growth, 5.0f,
         "SAH against that after the last build, in 'Rebuild on growth'", "%.2f");
  const tracer::UpdateFacts& facts = frame.snapshot.update;
  if (!facts.deformed) return;
  text_row("This frame",
           fmt::format("{:.2f} + {:.2f} + {:.2f} ms", facts.deform_ms,
                       facts.refitted ? facts.refit_ms : facts.build_ms,
                       frame.snapshot.bvh ? frame.snapshot.bvh->tlas_ms : 0.0),
           "Wall time to deform the meshes, to refit or build their trees, and to build the top "
           "level");
  text_row("Growth", fmt::format("{:.3f}", frame.snapshot.growth.mean),
           "Area of the nodes' boxes now / when the trees were built, the mean weighted by the "
           "area at the build");
  if (!facts.warning.empty()) hint(facts.warning);
}

tracer::TimelineOptions options_of(const Frame& frame) {
  const TimelineState& state = frame.state.timeline;
  const float rate = frame.edited.settings.update.frames_per_second;
  tracer::TimelineOptions options;
  options.from = std::min(tracer::frame_at(state.from, rate), tracer::last_frame);
  options.to = std::clamp(tracer::frame_at(state.to, rate), options.from, tracer::last_frame);
  const int64_t steps = std::max(state.frames - 1, 1);
  options.step = std::max<int64_t>((options.to - options.from + steps - 1) / steps, 1);
  options.width = state.width;
  options.height = std::max(static_cast<int>(std::lround(float(state.width) / aspect(frame))), 1);
  return options;
}

void draw_measuring(Frame& frame) {
  TimelineState& state = frame.state.timeline;
  const Background<tracer::Timeline>& work = frame.work.timeline;
  heading("Curves");
  slider("Frames", state.frames, 2, 240, "How many frames of the range are measured at most");
  slider("Picture width", state.width, 32, 1920, "Pixels; the height follows the picture's shape");
  if (work.running) {
    ImGui::ProgressBar(work.fraction, {-1, 0}, work.doing.c_str());
    if (button("Cancel", "Stop measuring; the curves so far stay")) {
      frame.requests.cancel_timeline = true;
    }
    return;
  }
  if (!frame.snapshot.scene || !tracer::is_active(frame.edited.settings.deformer)) {
    hint("Choose a deformer, with an amount, to compare refitting with rebuilding.");
    return;
  }
  if (button("Measure",
             "Go through the range under refit, periodic rebuild and rebuild, and measure each "
             "frame. The picture rests meanwhile, so that the times are right")) {
    frame.state.playing = false;
    frame.requests.measure_timeline = options_of(frame);
  }
}

void draw_controls(Frame& frame) {
  draw_deformer(frame);
  draw_strategy(frame);
  draw_measuring(frame);
  draw_motion(frame);
  draw_range(frame);
}

}  // namespace

void draw_timeline(Frame& frame) {
  draw_transport(frame);
  const ImVec2 area = ImGui::GetContentRegionAvail();
  if (area.x < 50.0f * em()) {
    draw_controls(frame);
    draw_timeline_curves(frame);
    return;
  }
  ImGui::BeginChild("controls", {22.0f * em(), area.y});
  draw_controls(frame);
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("curves", {0, area.y});
  draw_timeline_curves(frame);
  ImGui::EndChild();
}

}  // namespace ui
