// Bars over a linear axis, with numbers and the value under the cursor.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <imgui.h>

namespace ui {

struct Bars {
  std::string title;
  std::span<const double> heights;
  double first = 0.0;        // value at the left edge of the first bar
  double step = 1.0;         // width of a bar
  bool whole = false;        // a bar stands for one whole number: `first`, `first` + step ...
  bool logarithmic = false;  // heights by log(1 + n)
  std::string unit;          // of the axis
  std::string what;          // is counted: "leaves"
};

// Fills `size`; zero takes the rest of the line.
void plot_bars(const char* label, const Bars& bars, ImVec2 size, const char* help);

// Steps of 1, 2 or 5 times a power of ten, so that at most `most` of them fit into the length.
double tick_step(double length, int most);

}  // namespace ui
