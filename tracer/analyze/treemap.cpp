#include "tracer/analyze/treemap.h"

#include <algorithm>
#include <cmath>

namespace tracer {
namespace {

constexpr double least_area = 9.0;  // pixels, of a node that is divided
constexpr double least_side = 2.0;

// A node that is still to be divided.
struct Part {
  uint32_t node = 0;
  uint32_t level = 0;
  uint32_t place = 0;           // in its level
  glm::dvec2 lo{0.0}, hi{1.0};  // in the whole map
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

// Across the side that is the longer one in pixels of the whole map: zooming changes no division.
void divide(const Icicle& icicle, const TreeTable& table, const Part& part, ivec2 size,
            std::vector<Part>& parts) {
  const IcicleLevel& below = icicle.levels[part.level + 1];
  const std::span<const uint32_t> children = children_of(table, part.node);
  const std::optional<uint32_t> first = icicle_place(icicle, children.front());
  const double whole = weight(icicle.levels[part.level], part.place);
  if (!first || whole <= 0.0) return;
  const glm::dvec2 extent = (part.hi - part.lo) * glm::dvec2(size);
  const int axis = extent.x >= extent.y ? 0 : 1;
  double at = part.lo[axis];
  for (uint32_t i = 0; i < children.size(); ++i) {
    Part child{children[i], part.level + 1, *first + i, part.lo, part.hi};
    child.lo[axis] = at;
    at += weight(below, child.place) / whole * (part.hi[axis] - part.lo[axis]);
    child.hi[axis] = std::min(at, part.hi[axis]);
    if (child.hi[axis] > child.lo[axis]) parts.push_back(child);
  }
}

}  // namespace

std::vector<TreemapTile> treemap(const Icicle& icicle, uint32_t level, ivec2 size,
                                 const TreemapView& view) {
  std::vector<TreemapTile> tiles;
  if (icicle.levels.empty() || size.x < 1 || size.y < 1) return tiles;
  const TreeTable& table = *table_of(*icicle.inspection, icicle.options.mesh);
  const uint32_t last = std::min(level, uint32_t(icicle.levels.size() - 1));
  const glm::dvec2 scale = glm::dvec2(size) / view.length;
  std::vector<Part> parts = {{}};
  while (!parts.empty()) {
    const Part part = parts.back();
    parts.pop_back();
    const vec2 lo(glm::max((part.lo - view.lo) * scale, glm::dvec2(0.0)));
    const vec2 hi(glm::min((part.hi - view.lo) * scale, glm::dvec2(size)));
    if (lo.x >= hi.x || lo.y >= hi.y) continue;  // outside of the view
    const TableNode& row = table.nodes[part.node];
    const glm::dvec2 extent = (part.hi - part.lo) * scale;
    const bool small =
        extent.x * extent.y < least_area || std::max(extent.x, extent.y) < least_side;
    if (part.level < last && !is_leaf(row) && !small) {
      divide(icicle, table, part, size, parts);
    } else {
      tiles.push_back({lo, hi, part.node, value_of(icicle, part, last)});
    }
  }
  return tiles;
}

TreemapView treemap_view_of(const Icicle& icicle, uint32_t node, ivec2 size) {
  if (icicle.levels.empty() || !icicle_place(icicle, node)) return {};
  const TreeTable& table = *table_of(*icicle.inspection, icicle.options.mesh);
  node = holder(table, node);
  Part part;
  std::vector<Part> children;
  for (const uint32_t next : path_to(table, node)) {
    if (next == part.node) continue;  // the root
    children.clear();
    divide(icicle, table, part, size, children);
    const auto found = std::find_if(children.begin(), children.end(),
                                    [&](const Part& child) { return child.node == next; });
    if (found == children.end()) return {};  // it weighs nothing
    part = *found;
  }
  const glm::dvec2 extent = part.hi - part.lo;
  TreemapView view;
  view.length = std::max(extent.x, extent.y);
  view.lo = glm::clamp(0.5 * (part.lo + part.hi - view.length), glm::dvec2(0.0),
                       glm::dvec2(1.0 - view.length));
  return view;
}

}  // namespace tracer
