// The rows of the Builders panel.
#include <algorithm>

#include "ui/comparison.h"

namespace ui {
namespace {

using tracer::BuildOptions;
using tracer::BuildState;
using tracer::ComparedBuild;

ComparedBuild* find_row(BuildersState& state, const BuildOptions& options) {
  for (ComparedBuild& row : state.rows) {
    if (row.options == options) return &row;
  }
  return nullptr;
}

}  // namespace

const char* const blend_help =
    "cost = scale ((1 - alpha) SAH + alpha EPO), fitted to the rows of this table: alpha is the "
    "one "
    "with the largest uncentered Pearson correlation to the measured cost, sum x y / sqrt(sum x x "
    "sum y y); scale is by least squares. The error is the mean of |predicted - measured| / "
    "measured. (Wodniok, Goesele 2017)";

void adopt_rows(Frame& frame) {
  BuildersState& state = frame.state.builders;
  if (state.scene_generation != frame.snapshot.scene_generation) {
    state.scene_generation = frame.snapshot.scene_generation;
    state.rows.clear();
    state.adopted = frame.work.comparison.result;
  }
  const auto& result = frame.work.comparison.result;
  if (!result || result == state.adopted) return;
  state.adopted = result;
  for (const ComparedBuild& row : *result) {
    ComparedBuild* known = find_row(state, row.options);  // nullptr: removed meanwhile
    if (known == nullptr || row.state == BuildState::waiting) continue;
    *known = row;
    state.view = row.view;
  }
}

std::vector<BuildOptions> chosen_builds(const Frame& frame) {
  const BuildersState& state = frame.state.builders;
  std::vector<BuildOptions> all;
  for (const tracer::BuilderRow& builder : tracer::builders()) {
    if (state.left_out.contains(builder.id)) continue;
    for (const tracer::OptimizerRow& optimizer : tracer::optimizers()) {
      if (!state.optimizers.contains(optimizer.id)) continue;
      for (const bool presplit : {false, true}) {
        if (!(presplit ? state.presplit : state.whole)) continue;
        BuildOptions& options = all.emplace_back();
        options.builder = builder.id;
        options.optimizer = optimizer.id;
        options.presplit = presplit;
        options.traversal_cost = frame.edited.settings.build.traversal_cost;
        options.intersection_cost = frame.edited.settings.build.intersection_cost;
      }
    }
  }
  const BuildOptions& present = frame.edited.settings.build;
  if (state.present_options && std::find(all.begin(), all.end(), present) == all.end()) {
    all.push_back(present);
  }
  return all;
}

void ask_for(Frame& frame, const std::vector<BuildOptions>& builds) {
  BuildersState& state = frame.state.builders;
  for (const BuildOptions& of : builds) {
    ComparedBuild* known = find_row(state, of);
    ComparedBuild& row = known != nullptr ? *known : state.rows.emplace_back();
    row = {};
    row.options = of;
  }
  frame.requests.compare = builds;
}

void use_options(Frame& frame, const ComparedBuild& row) {
  frame.edited.settings.build = row.options;
}

ComparableRows comparable_rows(const BuildersState& state) {
  ComparableRows result;
  for (size_t i = 0; i < state.rows.size(); ++i) {
    const ComparedBuild& row = state.rows[i];
    if (row.state != BuildState::done || row.view != state.view) continue;
    result.rows.push_back(i);
    result.builds.push_back(row);
  }
  result.front = tracer::pareto_front(result.builds);
  result.blend = tracer::fit_blend(result.builds);
  return result;
}

double predicted_cost(const ComparableRows& comparable, const ComparedBuild& row) {
  return comparable.blend ? tracer::predicted_cost(*comparable.blend, row.sah, row.epo) : 0.0;
}

}  // namespace ui
