// The build of one tree, split by split or merge by merge.
#include "ui/replay.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tracer/analyze/inspection.h"
#include "tracer/choice.h"
#include "ui/panels.h"
#include "ui/places.h"
#include "ui/plot_lines.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

void draw_transport(Frame& frame, const tracer::Replay& replay) {
  ReplayState& state = frame.state.replay;
  const size_t last = replay.order.size();
  if (button("|<", "Before the first step")) go_to_build_step(frame, 0);
  ImGui::SameLine();
  if (button("<", "One step back") && state.step > 0) go_to_build_step(frame, state.step - 1);
  ImGui::SameLine();
  if (button(state.playing ? "Pause" : "Play", "Step on and on, at the chosen speed",
             4.5f * em())) {
    if (!state.playing && state.step == last) go_to_build_step(frame, 0);
    state.playing = !state.playing;
  }
  ImGui::SameLine();
  if (button(">", "One step on")) go_to_build_step(frame, state.step + 1);
  ImGui::SameLine();
  if (button(">|", "The finished tree")) go_to_build_step(frame, last);
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1.0f);
  int step = int(std::min<size_t>(state.step, INT32_MAX));
  const std::string format = fmt::format("%d of {}", grouped(last));
  if (ImGui::SliderInt("##step", &step, 0, int(std::min<size_t>(last, INT32_MAX)), format.c_str(),
                       ImGuiSliderFlags_AlwaysClamp)) {
    go_to_build_step(frame, size_t(step));
  }
  mark("Step");
  tooltip("Steps done: each makes one inner node");
}

void draw_step(Frame& frame, const tracer::Replay& replay) {
  ReplayState& state = frame.state.replay;
  const bool up = replay.bottom_up;
  heading(up ? "Merge" : "Split");
  if (state.step == 0) {
    hint(up ? "Every leaf is a box of its own." : "All triangles are in one box.");
  } else {
    const uint32_t node = replay.order[state.step - 1];
    const tracer::TableNode& row = replay.table->nodes[node];
    text_row("Node", fmt::format("{}, depth {}", node, row.depth),
             "Index in the tree; edges from the root");
    std::string parts;
    for (uint32_t child = row.first; child < row.first + row.children; ++child) {
      parts += (parts.empty() ? "" : " + ") + grouped(replay.table->nodes[child].references);
    }
    text_row(replay.table->tlas ? "Instances" : "Triangles", parts,
             "References on the two sides: blue box, green box");
    text_row("Area", fmt::format("{:.3g} %", 100.0 * area_share(*replay.table, node)),
             "A(node) / A(root) of the yellow box");
    text_row("SAH saved", short_number(gain_of(replay, state.step - 1)),
             up ? "What the merge has taken off the cost of all boxes"
                : "What the split has taken off the tree's cost");
  }
  text_row(
      "SAH now", short_number(double(replay.sah[state.step])),
      up ? "Cost of what there is: the merged trees, and half a Ct for each pair of roots that "
           "every ray tests"
         : "Cost of what there is: boxes still to be split count as leaves");
  text_row("Boxes", grouped(replay.boxes[state.step]),
           up ? "Without a parent so far" : "Not split so far, leaves among them");
}

// At most this many places of the curve are plotted.
constexpr size_t most_places = 2000;

void draw_curve(Frame& frame, const tracer::Replay& replay, ImVec2 size) {
  const size_t last = replay.order.size();
  const size_t count = std::min(last + 1, most_places);
  std::vector<double> at(count);
  const double finished = std::max(double(replay.sah.back()), 1e-9);
  Line line{"log2", IM_COL32(255, 200, 60, 255), std::vector<double>(count)};
  for (size_t i = 0; i < count; ++i) {
    // Steps are worth less and less: places are closer together at the begin.
    const double share = count > 1 ? double(i) / double(count - 1) : 0.0;
    const auto step = size_t(std::llround(share * share * double(last)));
    at[i] = double(step);
    line.values[i] = std::max(std::log2(double(replay.sah[step]) / finished), 0.0);
  }
  LinePlot plot;
  plot.title = "SAH against the finished tree's";
  plot.unit = "log2";
  plot.at = at;
  plot.axis_unit = "steps";
  plot.hi = std::max(double(last), 1.0);
  plot.lines = {line};
  plot.now = double(frame.state.replay.step);
  const auto clicked = plot_lines(
      "curve", plot, size,
      "log2 of the SAH of what there is after each step over that of the finished tree: 1 is twice "
      "its cost, 0 the finished tree. A click goes to the step");
  if (clicked)
    go_to_build_step(frame, size_t(std::clamp(std::llround(*clicked), 0LL, (long long)last)));
}

std::string order_text(const Frame& frame, const tracer::Replay& replay) {
  const tracer::BuildOptions& options = frame.snapshot.bvh->options;
  const tracer::BuilderRow* row = tracer::find_row(tracer::builders(), options.builder);
  std::string text = row != nullptr ? std::string(row->label) : options.builder;
  text +=
      replay.bottom_up
          ? " merges boxes from the leaves up; here the smallest merge that is possible comes "
            "first."
          : " splits boxes from the root down; here as one thread does it, the left side first.";
  if (options.optimizer != "none") {
    text += " The optimizer has changed the tree afterwards: the steps lead to what it made.";
  }
  return text;
}

}  // namespace

void draw_replay_panel(Frame& frame) {
  if (!frame.snapshot.bvh) {
    hint("A build can be replayed once a scene is there: File > Open scene...");
    return;
  }
  follow_replay(frame);
  const tracer::Replay* replay = shown_replay(frame);
  const ImVec2 area = ImGui::GetContentRegionAvail();
  const float side = std::min(24.0f * em(), 0.45f * area.x);
  if (ImGui::BeginChild("step", {side, area.y})) {
    row_label("Tree", "Whose build is replayed");
    tree_combo(frame, "Tree", frame.state.replay.mesh, "Whose build is replayed");
    if (replay != nullptr) {
      slider("Speed", frame.state.replay.speed, 0.5f, 5000.0f, "Steps in a second of playing",
             "%.1f a second", true);
      draw_step(frame, *replay);
      hint(order_text(frame, *replay));
    } else {
      hint(frame.work.replay.error.empty() ? "Listing the steps ..." : frame.work.replay.error);
    }
  }
  ImGui::EndChild();
  if (replay == nullptr) return;
  ImGui::SameLine();
  if (ImGui::BeginChild("steps", {area.x - side - ImGui::GetStyle().ItemSpacing.x, area.y})) {
    draw_transport(frame, *replay);
    draw_curve(frame, *replay, ImGui::GetContentRegionAvail());
  }
  ImGui::EndChild();
}

}  // namespace ui
