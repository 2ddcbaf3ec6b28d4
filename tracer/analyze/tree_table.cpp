// One tree as panels read it.
#include "tracer/analyze/tree_table.h"

#include <algorithm>

namespace tracer {

TreeTable tree_table(const Bvh& tree, bool tlas, float traversal_cost, float intersection_cost) {
  TreeTable table;
  table.tlas = tlas;
  table.traversal_cost = traversal_cost;
  table.intersection_cost = intersection_cost;
  table.references = tree.references;
  table.depth = tree.depth;
  table.nodes.resize(tree.nodes.size());
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const BvhNode& node = tree.nodes[i];
    TableNode& row = table.nodes[i];
    row.box = box_of(node);
    row.first = node.first;
    row.references = node.count;
    if (is_leaf(node)) continue;
    row.children = 2;
    for (uint32_t child = node.first; child < node.first + 2; ++child) {
      table.nodes[child].parent = uint32_t(i);
      table.nodes[child].depth = uint8_t(row.depth + 1);
    }
  }
  // Children come after their parents: sums on the way back, places on the way there.
  for (size_t i = table.nodes.size(); i-- > 0;) {
    TableNode& row = table.nodes[i];
    row.sah = float(own_sah(table, uint32_t(i)));
    for (uint32_t child = row.first; child < row.first + row.children; ++child) {
      row.references += table.nodes[child].references;
      row.sah += table.nodes[child].sah;
    }
  }
  for (const TableNode& row : table.nodes) {
    uint32_t order = row.order;
    for (uint32_t child = row.first; child < row.first + row.children; ++child) {
      table.nodes[child].order = order;
      order += table.nodes[child].references;
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
