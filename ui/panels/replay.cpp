// The build of one tree, split by split or merge by merge, and what the optimizer moved.
#include "ui/replay.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

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
  const size_t last = step_count(replay);
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
  tooltip("Steps done: each makes one inner node or, of an optimizer, moves a subtree");
}

const char* name_of(tracer::BuildStep kind) {
  switch (kind) {
    case tracer::BuildStep::split:
      return "Split";
    case tracer::BuildStep::merge:
      return "Merge";
    case tracer::BuildStep::reinsertion:
      return "Reinsertion";
    case tracer::BuildStep::rotation:
      return "Rotation";
    case tracer::BuildStep::finish:
      break;
  }
  return "Leaves";
}

std::string area_text(const tracer::Replay& replay, const tracer::Box& box) {
  const double root = double(half_area(box_of(replay.log.nodes[0])));
  return fmt::format("{:.3g} %", root > 0.0 ? 100.0 * double(half_area(box)) / root : 100.0);
}

// What a step of the builder has made.
void draw_made(const tracer::Replay& replay, uint32_t node, bool up) {
  const uint32_t same = replay.same[node];
  text_row("Node", same != tracer::none ? grouped(same) : "gone since",
           "Index in the finished binary tree; gone: the optimizer, or making leaves, has left no "
           "such box");
  const uint32_t pair = replay.log.nodes[node].first;
  text_row(replay.mesh == tracer::none ? "Instances" : "Triangles",
           grouped(replay.references[pair]) + " + " + grouped(replay.references[pair + 1]),
           "References on the two sides: blue box, green box");
  text_row("Area", area_text(replay, box_of(replay.log.nodes[node])),
           up ? "A(node) / A(root) of the yellow box, which holds both"
              : "A(node) / A(root) of the yellow box");
}

// What a step of the optimizer has moved.
void draw_move(const tracer::Replay& replay, const tracer::TreeMove& move, bool reinserted) {
  text_row("Moved", area_text(replay, move.moved),
           "A / A(root) of the yellow box: the subtree that is put elsewhere");
  text_row(reinserted ? "Goes beside" : "Changes with", area_text(replay, move.beside),
           reinserted
               ? "A / A(root) of the blue box: both get a new parent, where it stood"
               : "A / A(root) of the blue box, a child of the green one: the yellow box takes "
                 "its place, one level deeper");
  text_row("Leaves behind", area_text(replay, move.left),
           "A / A(root) of the green box, its sibling until now");
}

void draw_kind(const tracer::Replay& replay, size_t step) {
  using tracer::BuildStep;
  const BuildStep kind = kind_of(replay, step);
  if (const tracer::TreeMove* move = move_of(replay, step)) {
    draw_move(replay, *move, kind == BuildStep::reinsertion);
  } else if (kind == BuildStep::finish) {
    hint("Subtrees that cost less as one leaf are leaves now, and the binary tree is finished.");
  } else {
    draw_made(replay, node_of(replay, step), kind == BuildStep::merge);
  }
  if (const auto round = round_of(replay, step)) {
    text_row("Round", fmt::format("{} of {}", round->number, round->of),
             "Which pass over the tree the step belongs to, and how many there are");
  }
  const char* saved = "What the move has taken off the tree's cost; by itself it may cost a little";
  if (kind == BuildStep::merge) saved = "What the merge has taken off the cost of all boxes";
  if (kind == BuildStep::split) saved = "What the split has taken off the tree's cost";
  if (kind == BuildStep::finish) saved = "What making leaves has taken off the tree's cost";
  text_row("SAH saved", short_number(gain_of(replay, step)), saved);
}

void draw_step(Frame& frame, const tracer::Replay& replay) {
  const size_t steps = frame.state.replay.step;
  const bool merging = replay.bottom_up && steps <= replay.log.order.size();
  if (steps == 0) {
    heading("Begin");
    hint(merging ? "Everything is a box of its own." : "Everything is in one box.");
  } else {
    heading(name_of(kind_of(replay, steps - 1)));
    draw_kind(replay, steps - 1);
  }
  text_row("SAH now", short_number(double(replay.sah[steps])),
           merging
               ? "Cost of what there is: the merged trees, and half a Ct for each pair of roots "
                 "that every ray tests"
               : "Cost of what there is: boxes still to be split count as leaves");
  text_row("Boxes", grouped(box_count(replay, steps)),
           merging ? "Without a parent so far" : "Not split so far, leaves among them");
}

// At most this many places of the curve are plotted.
constexpr size_t most_places = 2000;

void draw_curve(Frame& frame, const tracer::Replay& replay, ImVec2 size) {
  const size_t last = step_count(replay);
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

std::string order_text(const tracer::Replay& replay) {
  const tracer::BuildOptions& options = replay.bvh->options;
  const tracer::BuilderRow* builder = tracer::find_row(tracer::builders(), options.builder);
  std::string text = builder != nullptr ? std::string(builder->label) : options.builder;
  text += replay.bottom_up ? " merges boxes from the leaves up, in this order."
                           : " splits boxes from the root down; here as one thread does it, the "
                             "left side first.";
  const tracer::OptimizerRow* optimizer = tracer::find_row(tracer::optimizers(), options.optimizer);
  if (optimizer == nullptr || optimizer->optimize == nullptr) return text;
  text += fmt::format(" {} then makes {} moves.", optimizer->label,
                      grouped(replay.log.moves.size() + replay.log.moves_left_out));
  if (replay.log.moves_left_out > 0) {
    text += fmt::format(" The first {} are shown, the last step makes all others.",
                        grouped(replay.log.moves.size()));
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
      hint(order_text(*replay),
           "A move: one subtree taken out and put in elsewhere, or two that change places");
    } else {
      hint(frame.work.replay.error.empty()
               ? "The tree is being built again, with a log of its steps ..."
               : frame.work.replay.error);
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
