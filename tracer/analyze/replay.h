// A build, step by step: the order in which a builder makes the inner nodes of a tree, and what the
// tree is worth on the way.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "tracer/analyze/tree_table.h"

namespace tracer {

struct Replay {
  std::shared_ptr<const TreeTable> table;
  bool bottom_up = false;         // steps are merges of boxes instead of splits
  std::vector<uint32_t> order;    // inner nodes, by step
  std::vector<uint32_t> step_of;  // by node: of an inner one; none for a leaf
  // Of what there is before the first step and after each, so one value more than steps:
  std::vector<float> sah;       // its cost, in units of the costs
  std::vector<uint32_t> boxes;  // how many there are to be split, or without a parent
};

// Top down a node is split before its children, the left one with all below it before the right
// one, as one thread goes. Bottom up the smallest box that can be merged comes first; a node's
// children come before it. Steps of an optimizer are not among them: the finished tree is replayed.
// Top down, boxes still to be split count as leaves; bottom up, boxes without a parent as roots
// that every ray tests.
Replay replay(std::shared_ptr<const TreeTable> table, bool bottom_up);

// The boxes there are after so many steps that have none above them (bottom up) or below them (top
// down): at most `most`, those of the largest area first.
std::vector<uint32_t> boxes_after(const Replay& replay, size_t steps, size_t most);

// Of the finished tree's SAH: what splitting the box has saved; bottom up, what merging has.
double gain_of(const Replay& replay, size_t step);

}  // namespace tracer
