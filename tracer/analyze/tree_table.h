// One tree as panels read it: nodes that know their parent, their children and their figures,
// however the tree is stored.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "tracer/bvh/scene_bvh.h"

namespace tracer {

struct TableNode {
  Box box;
  uint32_t parent = none;   // of the root: none
  uint32_t first = 0;       // inner: its first place in TreeTable::children; leaf: in references
  uint32_t references = 0;  // in the leaves below, or in the leaf
  uint32_t order = 0;    // references in the leaves to the left of it: its place from left to right
  float sah = 0.0f;      // cost of its subtree, its own included, in units of the costs
  uint8_t children = 0;  // 0: a leaf, or not in the layout
  uint8_t depth = 0;     // edges from the root
  bool in_layout = true;
};

// Node ids are those of the canonical tree in every layout; 0 is the root. A wide layout has fewer
// nodes. The others are not in_layout: they have no children and no references, their parent is the
// node that has taken them in, and their depth is that node's.
struct TreeTable {
  std::vector<TableNode> nodes;
  std::vector<uint32_t> children;    // siblings are adjacent, from left to right
  std::vector<uint32_t> references;  // triangles, or instances in the TLAS; a leaf's are adjacent
  std::vector<uint32_t> entries;     // beside them, the node at which each instance is entered;
                                     // none: the roots, or the table is of a BLAS
  uint32_t depth = 0;                // of the deepest leaf
  bool tlas = false;                 // references are instances
  float traversal_cost = 0.0f;       // Ct
  float intersection_cost = 0.0f;    // Ci
};

// Of a tree that keeps the rules of structure (tree_rules.h), in the layout that it was widened to.
// Linear in the nodes; of a million triangles in about 0.1 s.
// `entries` are those of a TLAS (scene_bvh.h).
TreeTable tree_table(const Bvh& tree, bool tlas, float traversal_cost, float intersection_cost,
                     const WideTree& wide = {}, std::span<const EntryPoint> entries = {});

inline bool is_leaf(const TableNode& node) {
  return node.children == 0 && node.in_layout;
}

// What the references are, in words.
inline std::string_view references_name(const TreeTable& table) {
  if (!table.tlas) return "triangles";
  return table.entries.empty() ? "instances" : "parts of instances";
}

inline std::span<const uint32_t> children_of(const TreeTable& table, uint32_t node) {
  const TableNode& row = table.nodes[node];
  return {table.children.data() + (row.children > 0 ? row.first : 0), row.children};
}

// Of the layout.
inline size_t node_count(const TreeTable& table) {
  return table.nodes.empty() ? 0 : table.children.size() + 1;
}

// The node itself, or the node of the layout that has taken it in.
inline uint32_t holder(const TreeTable& table, uint32_t node) {
  return table.nodes[node].in_layout ? node : table.nodes[node].parent;
}

// A(node) / A(root): how often a random line through the root meets the node; 1 where the root has
// no area.
double area_share(const TreeTable& table, uint32_t node);

// What the node costs itself: area share times Ct of an inner node, or times count * Ci of a leaf.
double own_sah(const TreeTable& table, uint32_t node);

// From the root to the node, both included.
std::vector<uint32_t> path_to(const TreeTable& table, uint32_t node);

// The leaves that refer to a triangle or instance, in ascending order. Linear in the references.
std::vector<uint32_t> leaves_of(const TreeTable& table, uint32_t reference);

}  // namespace tracer
