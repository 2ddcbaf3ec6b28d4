#include "tracer/analyze/treemap.h"

#include <algorithm>
#include <cmath>

namespace tracer {
namespace {

constexpr float least_area = 9.0f;  // pixels, of a node that is divided
constexpr float least_side = 2.0f;

// A node that is still to be divided.
struct Part {
  uint32_t node = 0;
  uint32_t level = 0;
  uint32_t place = 0;  // in its level
  vec2 lo{0.0f}, hi{0.0f};
};

double weight(const IcicleLevel& level, uint32_t place) {
  return double(level.end[place]) - double(level.begin[place]);
}

// Of a node that is not divided though it is above the level: what is most at the level.
float value_of(const Icicle& icicle, const Part& part, uint32_t last) {
  const IcicleLevel& own = icicle.levels[part.level];
  const float value = own.values[part.place];
  if (part.level >= last) return value;
  const auto below = icicle_largest(icicle, last, own.begin[part.place], own.end[part.place]);
  return below ? icicle.levels[last].values[*below] : value;
}

void divide(const Icicle& icicle, const TableNode& row, const Part& part,
            std::vector<Part>& parts) {
  const IcicleLevel& below = icicle.levels[part.level + 1];
  const std::optional<uint32_t> first = icicle_place(icicle, row.first);
  const double whole = weight(icicle.levels[part.level], part.place);
  if (!first || whole <= 0.0) return;
  const vec2 size = part.hi - part.lo;
  const int axis = size.x >= size.y ? 0 : 1;
  float at = part.lo[axis];
  for (uint32_t i = 0; i < row.children; ++i) {
    Part child{row.first + i, part.level + 1, *first + i, part.lo, part.hi};
    child.lo[axis] = at;
    at += float(weight(below, child.place) / whole) * size[axis];
    child.hi[axis] = std::min(at, part.hi[axis]);
    if (child.hi[axis] > child.lo[axis]) parts.push_back(child);
  }
}

}  // namespace

std::vector<TreemapTile> treemap(const Icicle& icicle, uint32_t level, ivec2 size) {
  std::vector<TreemapTile> tiles;
  if (icicle.levels.empty() || size.x < 1 || size.y < 1) return tiles;
  const TreeTable& table = *table_of(*icicle.inspection, icicle.options.mesh);
  const uint32_t last = std::min(level, uint32_t(icicle.levels.size() - 1));
  std::vector<Part> parts = {{0, 0, 0, vec2(0.0f), vec2(size)}};
  while (!parts.empty()) {
    const Part part = parts.back();
    parts.pop_back();
    const TableNode& row = table.nodes[part.node];
    const vec2 extent = part.hi - part.lo;
    const bool small =
        extent.x * extent.y < least_area || std::max(extent.x, extent.y) < least_side;
    if (part.level < last && !is_leaf(row) && !small) {
      divide(icicle, row, part, parts);
    } else {
      tiles.push_back({part.lo, part.hi, part.node, value_of(icicle, part, last)});
    }
  }
  return tiles;
}

}  // namespace tracer
