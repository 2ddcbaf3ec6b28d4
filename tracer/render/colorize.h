// From facts to colours: the last step before a picture is shown or written. Traces no ray.
#pragma once

#include <string>
#include <vector>

#include "tracer/pipeline.h"

namespace tracer {

// 8-bit RGBA, row 0 on top, sRGB.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<uint32_t> pixels;
};

struct Histogram {
  ValueRange range;            // of the values in the picture
  std::vector<uint32_t> bars;  // 64 of them, over the shown range
  double mean = 0.0;
  uint64_t values = 0;
};

struct Picture {
  Image image;
  ValueRange range;  // shown; as given or fitted
  bool has_range = false;
  Histogram histogram;  // of a `value` view
  std::string title;    // of the legend: "nodes visited, primary rays"
  std::string unit;
};

// Throws Error for an unknown id in the options. Pixels without a value are a checkerboard.
Picture colorize(const Snapshot& snapshot, const ViewOptions& options);

// The value that a `value` view shows at a pixel; NaN: none.
float value_at(const Snapshot& snapshot, const ViewOptions& options, int x, int y);

// Draws the colour bar with its numbers, unit, "log" mark and title into the picture's lower left.
void draw_legend(Picture& picture, const ViewOptions& options);

}  // namespace tracer
