// The plot of the Builders panel: build time against what rays cost, or predicted against measured.
#include <algorithm>

#include "ui/comparison.h"
#include "ui/scatter.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::ComparedBuild;

constexpr Choice plots[] = {
    {"cost", "Cost by build time", "Up is slower to trace, right is slower to build"},
    {"prediction", "Measured by predicted cost", "On the line the blend of SAH and EPO is right"},
};

}  // namespace

int draw_comparison_plot(Frame& frame, const ComparableRows& comparable) {
  BuildersState& state = frame.state.builders;
  const bool prediction = state.plot == "prediction";
  combo("Plot", state.plot, std::span<const Choice>(plots), "What is plotted");
  std::vector<ScatterPoint> points;
  Scatter scatter;
  for (size_t i = 0; i < comparable.builds.size(); ++i) {
    const ComparedBuild& row = comparable.builds[i];
    ScatterPoint point;
    point.x = prediction ? predicted_cost(comparable, row) : std::max(row.build_ms, 1e-4);
    point.y = tracer::measured_cost(row);
    point.label = describe(row.options);
    point.front = comparable.front[i];
    point.present = row.options == frame.edited.settings.build;
    if (state.hovered == static_cast<int>(comparable.rows[i])) scatter.lit = static_cast<int>(i);
    points.push_back(point);
  }
  if (points.empty() || (prediction && !comparable.blend)) {
    hint(prediction ? "Three builds that differ are needed." : "No build has been measured yet.");
    return -1;
  }
  scatter.points = points;
  scatter.x_title = prediction ? "predicted cost of a primary ray" : "build time, ms (log)";
  scatter.y_title = "measured cost of a primary ray";
  scatter.logarithmic_x = !prediction;
  scatter.diagonal = prediction;
  const ScatterMouse mouse = plot_scatter(
      "plot", scatter, ImGui::GetContentRegionAvail(),
      prediction ? "Measured cost against the blend of SAH and EPO; on the line they are the same"
                 : "Build time against the measured cost of a primary ray. The line joins the "
                   "Pareto front: what no other build beats in both. A click adopts the options");
  if (mouse.hovered < 0) return -1;
  if (mouse.clicked) use_options(frame, comparable.builds[mouse.hovered]);
  return static_cast<int>(comparable.rows[mouse.hovered]);
}

}  // namespace ui
