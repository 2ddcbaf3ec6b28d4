// Points over two axes, with numbers, labels and the point under the mouse.
#pragma once

#include <span>
#include <string>

#include <imgui.h>

namespace ui {

struct ScatterPoint {
  double x = 0.0, y = 0.0;  // x above 0 on a logarithmic axis
  std::string label;
  bool front = false;    // drawn bright, and joined to the next one of the front
  bool present = false;  // drawn with a ring
};

struct Scatter {
  std::span<const ScatterPoint> points;
  std::string x_title, y_title;  // with units
  bool logarithmic_x = false;
  bool diagonal = false;  // a line where x = y
  int lit = -1;           // this point is drawn as if the mouse were over it
};

struct ScatterMouse {
  int hovered = -1;  // point under the mouse
  bool clicked = false;
};

// Fills `size`. Points are marked "point 1", "point 2", ... in the registry.
ScatterMouse plot_scatter(const char* label, const Scatter& scatter, ImVec2 size, const char* help);

}  // namespace ui
