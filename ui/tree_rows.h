// The rows of the tree list: what is open of a tree, from top to bottom. Kept from frame to frame
// and changed where something is opened or closed, so that a frame costs what is on the screen.
#pragma once

#include <cstdint>
#include <vector>

#include "tracer/analyze/node_measures.h"

namespace ui {

// A row is a node, or with this bit a place in TreeTable::references, below its leaf.
inline constexpr uint32_t reference_bit = 1u << 31;
inline bool is_reference(uint32_t row) {
  return (row & reference_bit) != 0;
}
inline uint32_t reference_place(uint32_t row) {
  return row & ~reference_bit;
}

struct TreeRows {
  std::vector<uint32_t> rows;
  std::vector<bool> open;  // by node; those below a closed one keep theirs
};

// How siblings are ordered: by a measure, NaN last, or (nullptr) as in the tree.
struct SiblingOrder {
  const tracer::NodeMeasureRow* measure = nullptr;
  bool descending = true;
};

// The root, opened. `facts` of this and the following are of the same tree.
TreeRows tree_rows(const tracer::TreeFacts& facts, const SiblingOrder& order);

// `at` is a row of a node. Opening one that is open, or closing one that is closed, does nothing.
void open_row(TreeRows& rows, const tracer::TreeFacts& facts, const SiblingOrder& order, size_t at);
void close_row(TreeRows& rows, const tracer::TreeFacts& facts, size_t at);

// All nodes below it, too; leaves only if asked for.
void open_below(TreeRows& rows, const tracer::TreeFacts& facts, const SiblingOrder& order,
                size_t at, bool leaves);
void close_all(TreeRows& rows, const tracer::TreeFacts& facts, const SiblingOrder& order);

// Opens what is above a node; the place of its row.
size_t reveal_node(TreeRows& rows, const tracer::TreeFacts& facts, const SiblingOrder& order,
                   uint32_t node);
// Likewise of a reference of a leaf; the leaf's row if it does not have it.
size_t reveal_reference(TreeRows& rows, const tracer::TreeFacts& facts, const SiblingOrder& order,
                        uint32_t leaf, uint32_t reference);

// After the order, or what it goes by, has changed.
void sort_rows(TreeRows& rows, const tracer::TreeFacts& facts, const SiblingOrder& order);

// The leaf that a row's reference is in, or the row's node.
uint32_t node_of_row(const TreeRows& rows, size_t at);

}  // namespace ui
