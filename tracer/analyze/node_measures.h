// What can be said of each node of a tree, as a table: the columns of the tree panel, and what the
// icicle and the boxes are coloured by.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "tracer/analyze/tree_table.h"

namespace tracer {

// One tree and what is known of its nodes so far, by node; empty: not known.
struct TreeFacts {
  const TreeTable* table = nullptr;
  std::span<const uint32_t> visits;  // frame_visits.h, of the rays that are asked about
  std::span<const float> epo;        // shares of raw EPO, in units of the costs
  std::span<const float> growth;     // area now / area at the build
  // Rays that enter the tree (inspection.h); nothing: the visits of the root.
  std::optional<double> root_visits = {};
};

// sequential: from 0 up. diverging: log2 of a ratio, 0 in the middle. category: whole numbers that
// only tell apart.
enum class MeasureScale { sequential, diverging, category };

// What the values come from: the tree itself, or what somebody has to take first.
enum class MeasureSource { tree, visits, epo, growth };

struct NodeMeasureRow {
  std::string_view id, label, help, unit;
  MeasureScale scale;
  double (*value)(const TreeFacts&, uint32_t node);  // NaN: not known, or it has none
  int digits;                                        // behind the point, where it is written
  MeasureSource source = MeasureSource::tree;
};
std::span<const NodeMeasureRow> node_measures();

// Whether the measure with this id is from there; an unknown one is from nowhere.
bool is_from(MeasureSource source, std::string_view measure);

// Whether the measure has a value for some node of the tree.
bool is_known(const TreeFacts& facts, const NodeMeasureRow& measure);

}  // namespace tracer
