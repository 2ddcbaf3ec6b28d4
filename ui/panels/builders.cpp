// Builders and their options side by side: what is measured, the table, and the plot.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "ui/comparison.h"
#include "ui/panels.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::BuildOptions;
using tracer::ComparedBuild;

void draw_choices(Frame& frame) {
  BuildersState& state = frame.state.builders;
  const Scope scope("choice");
  ImGui::BeginGroup();
  heading("Builders");
  for (const tracer::BuilderRow& row : tracer::builders()) {
    tick(state.left_out, row.id, row.label, row.help, true);
  }
  ImGui::EndGroup();
  ImGui::SameLine(0, 2.0f * em());
  ImGui::BeginGroup();
  heading("each with");
  for (const tracer::OptimizerRow& row : tracer::optimizers()) {
    tick(state.optimizers, row.id, row.optimize == nullptr ? "no optimizer" : row.label, row.help,
         false);
  }
  heading("on");
  ImGui::Checkbox("whole triangles", &state.whole);
  mark("whole");
  tooltip("One reference a triangle, unless the builder splits more");
  ImGui::Checkbox("pre-split ones", &state.presplit);
  mark("presplit");
  tooltip("Large diagonal triangles become several references before the build");
  heading("and");
  ImGui::Checkbox("the Build panel's options", &state.present_options);
  mark("present");
  tooltip("The builder with the options that the Build panel has now");
  ImGui::EndGroup();
  hint(fmt::format("{} builds, with the default options and the Build panel's Ct and Ci",
                   chosen_builds(frame).size()),
       "Builders times optimizers, with and without pre-splitting as chosen");
}

void draw_choice(Frame& frame) {
  if (button("Choose...", "Which builders and optimizers are measured, on what")) {
    ImGui::OpenPopup("choice");
  }
  if (!ImGui::BeginPopup("choice")) return;
  draw_choices(frame);
  ImGui::EndPopup();
}

void draw_running(Frame& frame) {
  const auto& work = frame.work.comparison;
  const std::string text = fmt::format("{}  {:.0f} %", work.doing, 100.0f * work.fraction);
  const float width = std::max(20.0f * em(), ImGui::CalcTextSize(text.c_str()).x + 2.0f * em());
  ImGui::ProgressBar(work.fraction, {width, 0}, text.c_str());
  mark("progress");
  tooltip(
      "Builds are measured one after the other; the picture rests so as not to spoil the times");
  ImGui::SameLine();
  if (button("Cancel", "Stop; what has been measured stays")) {
    frame.requests.cancel_comparison = true;
  }
}

void draw_controls(Frame& frame) {
  BuildersState& state = frame.state.builders;
  if (frame.work.comparison.running) {
    draw_running(frame);
    return;
  }
  const std::vector<BuildOptions> options = chosen_builds(frame);
  const std::string label = fmt::format("Measure {} builds###Measure", options.size());
  if (ImGui::Button(label.c_str()) && !options.empty()) ask_for(frame, options);
  mark("Measure");
  tooltip("Build the scene with each of the chosen builders, and trace the picture's primary rays");
  ImGui::SameLine();
  draw_choice(frame);
  if (state.rows.empty()) return;
  ImGui::SameLine();
  if (button("Measure again", "All rows of the table, for the present picture")) {
    std::vector<BuildOptions> again;
    for (const ComparedBuild& row : state.rows)
      again.push_back(row.options);
    ask_for(frame, again);
  }
  ImGui::SameLine();
  if (button("Clear", "Remove all rows")) state.rows.clear();
}

void draw_blend(const ComparableRows& comparable) {
  const std::string text =
      comparable.blend ? fmt::format("cost = {:.3f} ({:.2f} SAH + {:.2f} EPO), error {:.1f} %",
                                     comparable.blend->scale, 1.0 - comparable.blend->alpha,
                                     comparable.blend->alpha, 100.0 * comparable.blend->mean_error)
                       : "SAH-EPO blend: needs three builds that differ";
  ImGui::SameLine(0, 1.5f * em());
  if (ImGui::GetContentRegionAvail().x < ImGui::CalcTextSize(text.c_str()).x) ImGui::NewLine();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(text.c_str());
  mark("blend");
  tooltip(blend_help);
}

}  // namespace

void draw_builders(Frame& frame) {
  if (!frame.snapshot.bvh) {
    hint("Builders can be compared once a scene is there: File > Open scene...");
    return;
  }
  adopt_rows(frame);
  BuildersState& state = frame.state.builders;
  draw_controls(frame);
  if (state.rows.empty()) {
    hint(
        "Choose builders and measure them: each builds this scene and traces the picture's primary "
        "rays. The rows stay until another scene is loaded, so that options can be compared.");
    return;
  }
  const ComparableRows comparable = comparable_rows(state);
  draw_blend(comparable);
  const ImVec2 area = ImGui::GetContentRegionAvail();
  const bool plot = area.x > 46.0f * em();
  const float plot_width = plot ? std::floor(std::max(0.32f * area.x, 18.0f * em())) : 0.0f;
  const float gap = plot ? ImGui::GetStyle().ItemSpacing.x : 0.0f;
  int under = draw_comparison_table(frame, comparable, {area.x - plot_width - gap, area.y});
  if (plot) {
    ImGui::SameLine();
    ImGui::BeginChild("plot area", {plot_width, area.y});
    under = std::max(under, draw_comparison_plot(frame, comparable));
    ImGui::EndChild();
  }
  state.hovered = under;
}

}  // namespace ui
