// Opens and closes rows.
#include "ui/tree_rows.h"

#include <algorithm>
#include <cmath>

namespace ui {
namespace {

using tracer::TableNode;
using tracer::TreeFacts;

// The children of a node in order, the first one last: as a stack takes them.
void push_children(std::vector<uint32_t>& stack, const TreeFacts& facts, const SiblingOrder& order,
                   uint32_t node) {
  const std::span<const uint32_t> children = children_of(*facts.table, node);
  stack.insert(stack.end(), children.rbegin(), children.rend());
  if (order.measure == nullptr) return;
  const auto value = [&](uint32_t child) {
    const double found = order.measure->value(facts, child);
    return std::isnan(found) ? -INFINITY : order.descending ? found : -found;
  };
  // Few: by insertion, equal ones keep their order.
  const auto begin = stack.end() - ptrdiff_t(children.size());
  for (auto child = begin; child != stack.end(); ++child) {
    const double own = value(*child);
    for (auto at = child; at != begin && value(*(at - 1)) > own; --at)
      std::swap(*at, *(at - 1));
  }
}

// What is opened on the way down.
enum class Opening { nothing, inner_nodes, everything };

// Appends what is visible below a node.
void append_below(std::vector<uint32_t>& to, TreeRows& rows, const TreeFacts& facts,
                  const SiblingOrder& order, uint32_t node, Opening opening) {
  std::vector<uint32_t> stack;
  const auto enter = [&](uint32_t id) {
    const TableNode& row = facts.table->nodes[id];
    const bool opened = is_leaf(row) ? opening == Opening::everything : opening != Opening::nothing;
    if (opened) rows.open[id] = true;
    if (!opened && !rows.open[id]) return;
    if (!is_leaf(row)) {
      push_children(stack, facts, order, id);
      return;
    }
    for (uint32_t i = 0; i < row.references; ++i)
      to.push_back((row.first + i) | reference_bit);
  };
  enter(node);
  while (!stack.empty()) {
    const uint32_t id = stack.back();
    stack.pop_back();
    to.push_back(id);
    enter(id);
  }
}

size_t end_below(const TreeRows& rows, const TreeFacts& facts, size_t at) {
  const uint32_t depth = facts.table->nodes[rows.rows[at]].depth;
  size_t end = at + 1;
  while (end < rows.rows.size() &&
         (is_reference(rows.rows[end]) || facts.table->nodes[rows.rows[end]].depth > depth))
    ++end;
  return end;
}

// Replaces what is visible below a row.
void remake_below(TreeRows& rows, const TreeFacts& facts, const SiblingOrder& order, size_t at,
                  Opening opening = Opening::nothing) {
  const uint32_t node = rows.rows[at];
  const auto begin = rows.rows.begin() + std::ptrdiff_t(at) + 1;
  const auto end = rows.rows.begin() + std::ptrdiff_t(end_below(rows, facts, at));
  if (end == rows.rows.end()) {  // of the root most of all: without a copy
    rows.rows.resize(at + 1);
    append_below(rows.rows, rows, facts, order, node, opening);
    return;
  }
  std::vector<uint32_t> below;
  append_below(below, rows, facts, order, node, opening);
  const auto common = std::min(below.end() - below.begin(), end - begin);
  std::copy(below.begin(), below.begin() + common, begin);
  if (end - begin > common) {
    rows.rows.erase(begin + common, end);
  } else {
    rows.rows.insert(begin + common, below.begin() + common, below.end());
  }
}

size_t place_of(const TreeRows& rows, size_t from, uint32_t row) {
  return size_t(std::find(rows.rows.begin() + std::ptrdiff_t(from), rows.rows.end(), row) -
                rows.rows.begin());
}

}  // namespace

TreeRows tree_rows(const TreeFacts& facts, const SiblingOrder& order) {
  TreeRows rows;
  if (facts.table->nodes.empty()) return rows;
  rows.rows = {0};
  rows.open.resize(facts.table->nodes.size());
  open_row(rows, facts, order, 0);
  return rows;
}

void open_row(TreeRows& rows, const TreeFacts& facts, const SiblingOrder& order, size_t at) {
  if (rows.open[rows.rows[at]]) return;
  rows.open[rows.rows[at]] = true;
  remake_below(rows, facts, order, at);
}

void close_row(TreeRows& rows, const TreeFacts& facts, size_t at) {
  rows.open[rows.rows[at]] = false;
  const auto begin = rows.rows.begin() + std::ptrdiff_t(at) + 1;
  rows.rows.erase(begin, rows.rows.begin() + std::ptrdiff_t(end_below(rows, facts, at)));
}

void open_below(TreeRows& rows, const TreeFacts& facts, const SiblingOrder& order, size_t at,
                bool leaves) {
  remake_below(rows, facts, order, at, leaves ? Opening::everything : Opening::inner_nodes);
}

void close_all(TreeRows& rows, const TreeFacts& facts, const SiblingOrder& order) {
  rows = tree_rows(facts, order);
}

size_t reveal_node(TreeRows& rows, const TreeFacts& facts, const SiblingOrder& order,
                   uint32_t node) {
  node = holder(*facts.table, node);
  const std::vector<uint32_t> path = path_to(*facts.table, node);
  size_t closed = 0;  // of the path, the first one that is
  while (closed + 1 < path.size() && rows.open[path[closed]])
    ++closed;
  for (size_t i = closed; i + 1 < path.size(); ++i)
    rows.open[path[i]] = true;
  const size_t at = place_of(rows, 0, path[closed]);
  if (closed + 1 == path.size()) return at;
  remake_below(rows, facts, order, at);
  return place_of(rows, at, node);
}

size_t reveal_reference(TreeRows& rows, const TreeFacts& facts, const SiblingOrder& order,
                        uint32_t leaf, uint32_t reference) {
  const size_t at = reveal_node(rows, facts, order, leaf);
  open_row(rows, facts, order, at);
  const TableNode& row = facts.table->nodes[leaf];
  for (uint32_t i = 0; is_leaf(row) && i < row.references; ++i) {
    if (facts.table->references[row.first + i] == reference) return at + 1 + i;
  }
  return at;
}

void sort_rows(TreeRows& rows, const TreeFacts& facts, const SiblingOrder& order) {
  if (!rows.rows.empty()) remake_below(rows, facts, order, 0);
}

uint32_t node_of_row(const TreeRows& rows, size_t at) {
  while (is_reference(rows.rows[at]))
    --at;
  return rows.rows[at];
}

}  // namespace ui
