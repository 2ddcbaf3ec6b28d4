// Opening the largest nodes first.
#include "tracer/bvh/blas_top.h"

#include <queue>

namespace tracer {
namespace {

constexpr size_t enough = 64;  // boxes

template <class Node>
void add_children(const WideNodes<Node>& wide, const EntryPoint& parent,
                  std::vector<EntryPoint>& children) {
  if (is_leaf(parent.child)) return;
  const Node& node = wide.nodes[parent.child];
  for (int slot = 0; slot < Node::width && node.binary[slot] != none; ++slot) {
    if (node.binary[slot] == parent.node) return;  // the root is a leaf
    children.push_back({node.binary[slot], node.child[slot], parent.depth + 1});
  }
}

std::vector<EntryPoint> children_of(const Blas& blas, const EntryPoint& parent) {
  std::vector<EntryPoint> children;
  std::visit(
      [&](const auto& wide) {
        if constexpr (requires { wide.nodes; }) {
          add_children(wide, parent, children);
        } else if (const BvhNode& node = blas.tree.nodes[parent.node]; !is_leaf(node)) {
          children.push_back({node.first, 0, parent.depth + 1});
          children.push_back({node.first + 1, 0, parent.depth + 1});
        }
      },
      blas.wide);
  return children;
}

// From left to right.
void add_boxes(const Bvh& tree, uint32_t index, BlasTop& top) {
  BlasTop::Node& node = top.nodes[index];
  node.first_box = uint32_t(top.boxes.size());
  if (node.children == 0) top.boxes.push_back(box_of(tree.nodes[node.at.node]));
  for (uint32_t child = node.first; child < node.first + node.children; ++child)
    add_boxes(tree, child, top);
  node.box_end = uint32_t(top.boxes.size());
}

}  // namespace

BlasTop top_of(const Blas& blas) {
  struct Waiting {
    float area;
    uint32_t index;
    bool operator<(const Waiting& other) const {
      return area != other.area ? area < other.area : index > other.index;
    }
  };
  BlasTop top;
  std::priority_queue<Waiting> waiting;
  const auto add = [&](const EntryPoint& at) {
    waiting.push({half_area(box_of(blas.tree.nodes[at.node])), uint32_t(top.nodes.size())});
    top.nodes.push_back({at, 0, 0, 0, 0});
  };
  add({});
  for (size_t boxes = 1; boxes < enough && !waiting.empty();) {
    const uint32_t index = waiting.top().index;
    waiting.pop();
    const std::vector<EntryPoint> children = children_of(blas, top.nodes[index].at);
    if (children.empty()) continue;
    top.nodes[index].first = uint32_t(top.nodes.size());
    top.nodes[index].children = uint32_t(children.size());
    for (const EntryPoint& child : children)
      add(child);
    boxes += children.size() - 1;
  }
  add_boxes(blas.tree, 0, top);
  return top;
}

}  // namespace tracer
