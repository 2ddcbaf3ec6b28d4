// The parts of the Builders panel: its rows, their table, and the plot.
#pragma once

#include <vector>

#include "ui/workspace_state.h"

namespace ui {

extern const char* const blend_help;

// Rows of another scene go; what has been measured since comes in.
void adopt_rows(Frame& frame);

// One build for each ticked builder and optimizer, and the present options.
std::vector<tracer::BuildOptions> chosen_builds(const Frame& frame);

// Asks for these builds; they get a row that waits, unless they have one.
void ask_for(Frame& frame, const std::vector<tracer::BuildOptions>& builds);

// Makes the row's options those of the scene.
void use_options(Frame& frame, const tracer::ComparedBuild& row);

// The rows that can be compared: measured, and for the same rays as the newest.
struct ComparableRows {
  std::vector<size_t> rows;  // of the state
  std::vector<tracer::ComparedBuild> builds;
  std::vector<bool> front;  // the Pareto front of build time and cost
  std::optional<tracer::Blend> blend;
};
ComparableRows comparable_rows(const BuildersState& state);
double predicted_cost(const ComparableRows& comparable, const tracer::ComparedBuild& row);

// Both give the row under the mouse, or -1. A click uses its options.
int draw_comparison_table(Frame& frame, const ComparableRows& comparable, ImVec2 size);
int draw_comparison_plot(Frame& frame, const ComparableRows& comparable);  // fills the window

}  // namespace ui
