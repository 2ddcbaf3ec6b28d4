// From facts to colours: the last step before a picture is shown or written. Traces no ray.
#pragma once

#include <string>
#include <vector>

#include "tracer/pipeline.h"
#include "tracer/render/image.h"

namespace tracer {

struct Histogram {
  ValueRange range;            // of the values in the picture
  std::vector<uint32_t> bars;  // 64 over the shown range; fewer for a short range of counts, so
                               // that each bar stands for as many whole numbers as the next
  double mean = 0.0;
  uint64_t values = 0;
};

// Of the boxes drawn over a picture (overlay.h).
struct DrawnBoxes {
  uint64_t drawn = 0;
  uint64_t found = 0;     // that were asked for
  bool at_least = false;  // there are more, which were not counted
  ValueRange range;       // of the colours
  bool has_range = false;
};

struct Picture {
  Image image;
  ValueRange range;  // shown; as given or fitted
  bool has_range = false;
  bool counts = false;  // the values are whole numbers
  Histogram histogram;  // of a `value` view
  std::string title;    // of the legend: "Nodes visited, primary rays"
  std::string unit;
  std::optional<DrawnBoxes> boxes;
};

// Throws Error for an unknown id in the options. Pixels without a value are a checkerboard, pixels
// not traced yet dark grey. Without a range in the options it goes from the smallest to the largest
// value; if that is more than twice what 99.5 % of the pixels stay below, it ends there.
Picture colorize(const Snapshot& snapshot, const ViewOptions& options);

// The value that a `value` view shows at a pixel; NaN: none.
float value_at(const Snapshot& snapshot, const ViewOptions& options, int x, int y);

// Draws the colour bar with its numbers, unit, "log" mark and title into the picture's lower left;
// nothing if the picture shows no values or is too small for it.
void draw_legend(Picture& picture, const ViewOptions& options);

}  // namespace tracer
