// A colour bar with its range, numbers and title, drawn into a picture.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tracer/render/image.h"
#include "tracer/settings.h"

namespace tracer {

struct ColorBar {
  std::string title, note;  // above and below; a note that it is logarithmic is added
  ValueRange range;
  bool counts = false;  // the values are whole numbers
  bool logarithmic = false;
  bool more = false;                 // there are values above the range
  std::function<vec3(float)> color;  // sRGB 0..1, of a place 0..1 in the range
  std::vector<std::string> names;    // of the numbers, from the range's lower end on; empty: digits
};

enum class Side { left, right };

// At the bottom; nothing if the picture is too small for it.
void draw_color_bar(Image& image, const ColorBar& bar, Side side);

}  // namespace tracer
