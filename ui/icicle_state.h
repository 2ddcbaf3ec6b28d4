// What the Icicle panel remembers from frame to frame.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tracer/analyze/icicle.h"
#include "tracer/analyze/treemap.h"

namespace ui {

struct IcicleState {
  uint32_t mesh = 0;               // whose BLAS; none: the TLAS
  std::string drawing = "icicle";  // or "treemap"
  int level = 8;                   // that the whole treemap ends at; zooming shows deeper ones
  std::string width = "references", color = "sah", ray_class = "all";
  bool logarithmic = true;      // colours; a node has about half of what its parent has
  double from = 0.0, to = 1.0;  // the part of the width that is shown
  float scroll = 0.0f;          // pixels above the upper border
  bool dragged = false;         // since the button went down
  std::optional<tracer::NodePlace> selected;  // seen last

  // The cells of each level, and what they were made of; kept while nothing changes.
  std::shared_ptr<const tracer::Icicle> cells_of;
  double cells_from = 0.0, cells_to = 0.0;
  int cells_pixels = 0;
  std::vector<std::vector<tracer::IcicleCell>> cells;

  // The same of the treemap.
  tracer::TreemapView view;  // the part of it that is shown
  std::shared_ptr<const tracer::Icicle> tiles_of;
  int tiles_level = 0;
  tracer::ivec2 tiles_size{0};
  tracer::TreemapView tiles_view;
  std::vector<tracer::TreemapTile> tiles;
};

}  // namespace ui
