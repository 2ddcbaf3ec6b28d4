// Curves over a common axis, with numbers, the values under the cursor and marks.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <imgui.h>

namespace ui {

struct Line {
  std::string name;
  ImU32 color = 0;
  std::vector<double> values;  // one for each of LinePlot::at; shorter: not yet known
};

// A place on the axis that has a meaning.
struct PlotMark {
  double at = 0.0;
  std::string what;  // "rebuild pays"
};

struct LinePlot {
  std::string title, unit;     // "Frame", "ms"
  std::span<const double> at;  // ascending
  std::string axis_unit;       // "s"
  double lo = 0.0, hi = 1.0;   // of the axis
  std::vector<Line> lines;
  std::optional<double> now;  // the current place
  std::vector<PlotMark> marks;
};

// Fills `size`. The values' axis begins at 0. A click or drag gives the place on the axis.
std::optional<double> plot_lines(const char* label, const LinePlot& plot, ImVec2 size,
                                 const char* help);

}  // namespace ui
