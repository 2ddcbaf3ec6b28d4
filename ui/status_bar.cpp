// One line at the bottom: what is shown, what is being done, how fast.
#include <fmt/format.h>
#include <imgui.h>

#include "tracer/bvh/counters.h"
#include "ui/frame_parts.h"
#include "ui/registry.h"
#include "ui/speed.h"
#include "ui/widgets.h"

namespace ui {
namespace {

// A text of the line, with a thin line before it; false if there is no room left.
bool item(const char* label, const std::string& text, const char* help, float reserve) {
  const float width = ImGui::CalcTextSize(text.c_str()).x + 1.6f * em();
  ImGui::SameLine(0, 1.6f * em());
  if (ImGui::GetContentRegionAvail().x < width + reserve) return false;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float x = at.x - 0.8f * em();
  ImGui::GetWindowDrawList()->AddLine({x, at.y + 0.2f * em()}, {x, at.y + 1.2f * em()},
                                      ImGui::GetColorU32(ImGuiCol_Separator));
  ImGui::TextUnformatted(text.c_str());
  mark(label);
  tooltip(help);
  return true;
}

void draw_progress(Frame& frame) {
  const tracer::Snapshot& snapshot = frame.snapshot;
  ImGui::SameLine(0, 1.6f * em());
  const std::string text =
      snapshot.doing.empty() ? std::string(tracer::name(snapshot.stage)) : snapshot.doing;
  const std::string shown = fmt::format("{}  {:.0f} %", text, 100.0f * snapshot.progress);
  const ImVec2 size = {std::max(14.0f * em(), ImGui::CalcTextSize(shown.c_str()).x + 2.0f * em()),
                       1.25f * em()};
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(0.3f * em(), 0));
  ImGui::ProgressBar(snapshot.progress, size, shown.c_str());
  mark("progress");
  tooltip("The stage that is running, and how far it is");
  ImGui::SameLine(0, 0.5f * em());
  if (ImGui::SmallButton("Cancel")) frame.requests.cancel = true;
  ImGui::PopStyleVar();
  mark("Cancel");
  tooltip("Stop what is running; what is there stays");
}

}  // namespace

void draw_status_bar(Frame& frame) {
  const Scope scope("status");
  const tracer::Snapshot& snapshot = frame.snapshot;
  const std::string frame_time = fmt::format("window {:.1f} ms", frame.frame_ms);
  const float reserve = ImGui::CalcTextSize(frame_time.c_str()).x + 2.0f * em();
  ImGui::SetCursorPos({0.6f * em(), 0.3f * em()});
  ImGui::TextUnformatted(snapshot.scene ? snapshot.scene->name.c_str() : "no scene");
  mark("scene");
  tooltip("The scene in the picture");
  if (snapshot.scene) {
    item("triangles", grouped(frame.state.scene.instanced_triangles) + " triangles",
         "Triangles of all instances together", reserve);
  }
  if (frame.work.measuring_time) {
    item("paused", "the picture rests: times are being measured",
         "Tracing would spoil the times that a panel is measuring; it goes on afterwards", reserve);
  } else if (snapshot.stage != tracer::Stage::none) {
    draw_progress(frame);
  }
  if (snapshot.samples > 0) {
    item("passes",
         fmt::format("pass {} of {}", snapshot.samples, frame.edited.settings.render.samples),
         "Complete passes in the picture: samples of each pixel", reserve);
    item("pass time", fmt::format("{:.0f} ms a pass", snapshot.pass_ms),
         "Wall time of the last complete pass", reserve);
  }
  for (int i = 0; i < tracer::ray_class_count; ++i) {
    const double speed = mrays_per_second(snapshot.rates[i]);
    if (speed <= 0.0) continue;
    item("speed", fmt::format("{} {:.1f} Mrays/s", tracer::ray_classes()[i].id, speed), speed_help,
         reserve);
  }
  ImGui::SameLine(ImGui::GetWindowWidth() - reserve + em());
  hint(frame_time, "Time between two frames of this window, smoothed");
  mark("frame time");
}

}  // namespace ui
