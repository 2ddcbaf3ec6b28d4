// A whole tree at once: its levels below each other, its nodes side by side in the order of the
// leaves, each as wide as what it and its subtree weigh. J. B. Kruskal, J. M. Landwehr, Icicle
// Plots: Better Displays for Hierarchical Clustering, 1983. Of nodes that are narrower than a pixel
// the one with the largest value is shown, by a pyramid of maxima.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tracer/analyze/inspection.h"
#include "tracer/settings.h"

namespace tracer {

// What a node's width stands for. `own` is what it weighs without its children.
struct IcicleWidthRow {
  std::string_view id, label, help;
  double (*own)(const TreeFacts&, uint32_t node);
};
std::span<const IcicleWidthRow> icicle_widths();

struct IcicleOptions {
  uint32_t mesh = 0;                 // whose BLAS; none: the TLAS
  std::string width = "references";  // id of an IcicleWidthRow
  std::string color = "sah";         // id of a NodeMeasureRow
  int ray_class = ray_class_count;   // whose visits; ray_class_count: all

  bool operator==(const IcicleOptions&) const = default;
};

// Whether the widths or colours are of visits, which somebody has to count.
bool needs_visits(const IcicleOptions& options);

// What it is made of. What its options do not ask about is left out (nullptr).
struct IcicleSources {
  IcicleOptions options;
  std::shared_ptr<const Inspection> inspection;
  std::shared_ptr<const CountedVisits> visits;
  std::shared_ptr<const Measures> measures;
  bool operator==(const IcicleSources&) const = default;
};
IcicleSources icicle_sources(const IcicleOptions& options,
                             std::shared_ptr<const Inspection> inspection,
                             std::shared_ptr<const CountedVisits> visits,
                             std::shared_ptr<const Measures> measures);

// From left to right.
struct IcicleLevel {
  std::vector<uint32_t> nodes;       // ids
  std::vector<uint32_t> begin, end;  // in units of 2^-32 of the root's width
  std::vector<float> values;         // of the colour; NaN: none
  // pyramid[k][i]: the place in `nodes` of the largest value among those from i * 4^(k+1) on,
  // 4^(k+1) of them. Of a diverging measure the one farthest from 0.
  std::vector<std::vector<uint32_t>> pyramid;
};

struct Icicle {
  std::shared_ptr<const Inspection> inspection;  // of whose tree; its table has the nodes
  IcicleOptions options;
  const NodeMeasureRow* measure = nullptr;
  std::vector<IcicleLevel> levels;
  ValueRange range;         // of the values; around 0 where they diverge
  bool has_values = false;  // else the measure is not known yet
  bool has_width = false;   // else the widths are not known yet, and those of triangles are used
};

// Of a tree that has a table. Unknown ids: the default. Linear in the nodes. Stopped: without
// levels.
Icicle make_icicle(const std::shared_ptr<const Inspection>& inspection, const TreeFacts& facts,
                   const IcicleOptions& options, const Job& job);
Icicle make_icicle(const IcicleSources& sources, const Job& job);

inline constexpr double icicle_width = 4294967296.0;  // of the root, in units of begin and end

// What is to be drawn of a level: one node, or several that share a column of pixels.
struct IcicleCell {
  float x0 = 0.0f, x1 = 0.0f;  // pixels
  uint32_t place = 0;          // in the level's nodes: of the one with the largest value
  uint32_t count = 1;          // nodes that it stands for
};

// The part [from, to) of the width, 0..1, over `pixels` columns; from left to right. At most two
// cells a column.
std::vector<IcicleCell> icicle_cells(const Icicle& icicle, size_t level, double from, double to,
                                     int pixels);

// The place of the largest value of a level among the nodes that begin in [begin, end); nothing if
// there are none.
std::optional<uint32_t> icicle_largest(const Icicle& icicle, size_t level, uint32_t begin,
                                       uint32_t end);

// The place in its level of a node, or of the one that has taken it in; nothing if the icicle has
// no such node.
std::optional<uint32_t> icicle_place(const Icicle& icicle, uint32_t node);

}  // namespace tracer
