// One tree as panels read it.
#include "tracer/analyze/tree_table.h"

#include <algorithm>

namespace tracer {
namespace {

void take_children(TreeTable& table, const Bvh& tree, std::span<const EntryPoint> entries) {
  table.children.resize(tree.nodes.size() - 1);
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const BvhNode& node = tree.nodes[i];
    TableNode& row = table.nodes[i];
    row.box = box_of(node);
    row.first = node.first;
    row.references = node.count;
    if (is_leaf(node)) continue;
    row.children = 2;
    row.first = node.first - 1;
    for (uint32_t child = node.first; child < node.first + 2; ++child) {
      table.children[child - 1] = child;
      table.nodes[child].parent = uint32_t(i);
    }
  }
  table.references = tree.references;
  for (const EntryPoint& entry : entries)
    table.entries.push_back(entry.node);
}

void take_children(TreeTable& table, const Bvh& tree, std::span<const WideSlot> slots,
                   std::span<const EntryPoint> entries) {
  for (TableNode& row : table.nodes)
    row.in_layout = false;
  table.nodes[0].in_layout = true;
  table.nodes[0].box = box_of(tree.nodes[0]);
  table.children.reserve(slots.size());
  table.references.reserve(tree.references.size());
  for (const WideSlot& slot : slots) {
    TableNode& parent = table.nodes[slot.parent];
    if (parent.children++ == 0) parent.first = uint32_t(table.children.size());
    table.children.push_back(slot.node);
    TableNode& row = table.nodes[slot.node];
    row.box = slot.box;
    row.parent = slot.parent;
    row.in_layout = true;
    if (!slot.leaf) continue;
    row.first = uint32_t(table.references.size());
    for_references_below(tree, slot.node, [&](uint32_t place) {
      table.references.push_back(tree.references[place]);
      if (!entries.empty()) table.entries.push_back(entries[place].node);
    });
    row.references = uint32_t(table.references.size()) - row.first;
  }
  // The layout's lacking nodes.
  for (uint32_t i = 0; i < tree.nodes.size(); ++i) {
    if (is_leaf(tree.nodes[i])) continue;
    for (uint32_t child = tree.nodes[i].first; child < tree.nodes[i].first + 2; ++child) {
      TableNode& row = table.nodes[child];
      if (row.in_layout) continue;
      row.box = box_of(tree.nodes[child]);
      row.parent = holder(table, i);
    }
  }
}

}  // namespace

TreeTable tree_table(const Bvh& tree, bool tlas, float traversal_cost, float intersection_cost,
                     const WideTree& wide, std::span<const EntryPoint> entries) {
  TreeTable table;
  table.tlas = tlas;
  table.traversal_cost = traversal_cost;
  table.intersection_cost = intersection_cost;
  table.nodes.resize(tree.nodes.size());
  if (tree.nodes.empty()) return table;
  const std::vector<WideSlot> wide_slots = slots(wide);
  if (wide_slots.empty()) {
    take_children(table, tree, entries);
  } else {
    take_children(table, tree, wide_slots, entries);
  }
  // Children come after their parents: sums on the way back, places on the way there.
  for (uint32_t i = uint32_t(table.nodes.size()); i-- > 0;) {
    TableNode& row = table.nodes[i];
    row.sah = float(own_sah(table, i));
    for (const uint32_t child : children_of(table, i)) {
      row.references += table.nodes[child].references;
      row.sah += table.nodes[child].sah;
    }
  }
  for (uint32_t i = 0; i < table.nodes.size(); ++i) {
    if (!table.nodes[i].in_layout) table.nodes[i].depth = table.nodes[holder(table, i)].depth;
    uint32_t order = table.nodes[i].order;
    for (const uint32_t child : children_of(table, i)) {
      TableNode& row = table.nodes[child];
      row.depth = uint8_t(table.nodes[i].depth + 1);
      table.depth = std::max(table.depth, uint32_t(row.depth));
      row.order = order;
      order += row.references;
    }
  }
  return table;
}

double area_share(const TreeTable& table, uint32_t node) {
  const double root = half_area(table.nodes[0].box);
  return root > 0.0 ? half_area(table.nodes[node].box) / root : 1.0;
}

double own_sah(const TreeTable& table, uint32_t node) {
  const TableNode& row = table.nodes[node];
  if (!row.in_layout) return 0.0;
  const double cost = is_leaf(row) ? double(row.references) * double(table.intersection_cost)
                                   : double(table.traversal_cost);
  return area_share(table, node) * cost;
}

std::vector<uint32_t> path_to(const TreeTable& table, uint32_t node) {
  std::vector<uint32_t> path;
  for (; node != none; node = table.nodes[node].parent)
    path.push_back(node);
  std::reverse(path.begin(), path.end());
  return path;
}

std::vector<uint32_t> leaves_of(const TreeTable& table, uint32_t reference) {
  std::vector<uint32_t> leaves;
  for (uint32_t i = 0; i < table.nodes.size(); ++i) {
    const TableNode& row = table.nodes[i];
    if (!is_leaf(row)) continue;
    const auto begin = table.references.begin() + row.first;
    if (std::find(begin, begin + row.references, reference) != begin + row.references) {
      leaves.push_back(i);
    }
  }
  return leaves;
}

}  // namespace tracer
