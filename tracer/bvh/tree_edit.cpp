#include "tracer/bvh/tree_edit.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace tracer {

namespace {

float half_area(const BvhNode& node) {
  const vec3 e = node.hi - node.lo;
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

// The references below each node: depth-first order has them in one piece.
struct Piece {
  uint32_t first = 0, count = 0;
};
std::vector<Piece> pieces(const Bvh& bvh) {
  std::vector<Piece> result(bvh.nodes.size());
  for (size_t i = bvh.nodes.size(); i-- > 0;) {
    const BvhNode& node = bvh.nodes[i];
    if (is_leaf(node)) {
      result[i] = {node.first, node.count};
    } else {
      const Piece &left = result[node.first], &right = result[node.first + 1];
      result[i] = {left.first, left.count + right.count};
    }
  }
  return result;
}

// Halves [first, first + count) of the references below nodes[node] until depth or leaf size say
// stop. Appends what it makes.
void halve(std::vector<BvhNode>& nodes, uint32_t node, Piece piece, uint32_t depth,
           std::span<const uint32_t> references, std::span<const Box> boxes,
           const BuildOptions& options) {
  if (piece.count <= options.max_leaf_size || depth >= options.max_depth) {
    Box box;
    for (uint32_t i = piece.first; i < piece.first + piece.count; ++i)
      box = united(box, boxes[references[i]]);
    nodes[node] = {box.lo, piece.first, box.hi, piece.count};
    return;
  }
  const auto pair = static_cast<uint32_t>(nodes.size());
  nodes.resize(nodes.size() + 2);
  const uint32_t left = piece.count / 2;
  halve(nodes, pair, {piece.first, left}, depth + 1, references, boxes, options);
  halve(nodes, pair + 1, {piece.first + left, piece.count - left}, depth + 1, references, boxes,
        options);
  const Box box = united(box_of(nodes[pair]), box_of(nodes[pair + 1]));
  nodes[node] = {box.lo, pair, box.hi, 0};
}

}  // namespace

Bvh depth_first(std::span<const BvhNode> nodes, std::span<const uint32_t> references) {
  Bvh bvh;
  if (nodes.empty()) return bvh;
  bvh.nodes.reserve(nodes.size());
  bvh.references.reserve(references.size());
  struct Task {
    uint32_t from, to, depth;
  };
  std::vector<Task> stack{{0, 0, 0}};
  bvh.nodes.resize(1);
  while (!stack.empty()) {
    const Task task = stack.back();
    stack.pop_back();
    BvhNode node = nodes[task.from];
    if (is_leaf(node)) {
      const auto begin = references.begin() + node.first;
      node.first = static_cast<uint32_t>(bvh.references.size());
      bvh.references.insert(bvh.references.end(), begin, begin + node.count);
      bvh.depth = std::max(bvh.depth, task.depth);
    } else {
      const auto pair = static_cast<uint32_t>(bvh.nodes.size());
      bvh.nodes.resize(bvh.nodes.size() + 2);
      stack.push_back({node.first + 1, pair + 1, task.depth + 1});
      stack.push_back({node.first, pair, task.depth + 1});
      node.first = pair;
    }
    bvh.nodes[task.to] = node;
  }
  return bvh;
}

void collapse_leaves(Bvh& bvh, const BuildOptions& options) {
  if (bvh.nodes.empty()) return;
  const std::vector<Piece> below = pieces(bvh);
  std::vector<float> cost(bvh.nodes.size());  // of the subtree, times its area
  bool changed = false;
  for (size_t i = bvh.nodes.size(); i-- > 0;) {
    BvhNode& node = bvh.nodes[i];
    const float area = half_area(node);
    const float as_leaf = options.intersection_cost * static_cast<float>(below[i].count) * area;
    if (is_leaf(node)) {
      cost[i] = as_leaf;
      continue;
    }
    cost[i] = options.traversal_cost * area + cost[node.first] + cost[node.first + 1];
    if (below[i].count > options.max_leaf_size || as_leaf > cost[i]) continue;
    cost[i] = as_leaf;
    node.first = below[i].first;
    node.count = below[i].count;
    changed = true;
  }
  if (changed) bvh = depth_first(bvh.nodes, bvh.references);
}

void limit_depth(Bvh& bvh, std::span<const Box> boxes, const BuildOptions& options) {
  if (bvh.depth <= options.max_depth) return;
  const std::vector<Piece> below = pieces(bvh);
  std::vector<uint32_t> height(bvh.nodes.size());
  for (size_t i = bvh.nodes.size(); i-- > 0;) {
    const BvhNode& node = bvh.nodes[i];
    if (!is_leaf(node)) height[i] = 1 + std::max(height[node.first], height[node.first + 1]);
  }
  std::vector<BvhNode> nodes(bvh.nodes.begin(), bvh.nodes.end());
  std::vector<uint32_t> depth(nodes.size());
  std::vector<uint8_t> gone(nodes.size());  // replaced together with a node above
  for (uint32_t i = 0; i < depth.size(); ++i) {
    if (is_leaf(bvh.nodes[i])) continue;
    const uint32_t pair = bvh.nodes[i].first;
    depth[pair] = depth[pair + 1] = depth[i] + 1;
    gone[pair] = gone[pair + 1] = gone[i];
    if (gone[i] || depth[i] + height[i] <= options.max_depth) continue;
    // As high as halving still reaches small leaves, or where it is too late for that.
    const bool last = options.max_depth - depth[i] <= std::bit_width(below[i].count) + 1u;
    if (!last) continue;
    halve(nodes, i, below[i], depth[i], bvh.references, boxes, options);
    gone[pair] = gone[pair + 1] = 1;
  }
  bvh = depth_first(nodes, bvh.references);
}

void name_primitives(Bvh& bvh, const BuildInput& input) {
  if (bvh.references.size() <= input.mesh->triangles.size()) return;
  std::vector<uint32_t> kept;
  kept.reserve(bvh.references.size());
  for (BvhNode& node : bvh.nodes) {
    if (!is_leaf(node)) continue;
    const auto first = static_cast<std::ptrdiff_t>(kept.size());
    for (uint32_t i = node.first; i < node.first + node.count; ++i) {
      const uint32_t primitive = primitive_of(input, bvh.references[i]);
      if (std::find(kept.begin() + first, kept.end(), primitive) == kept.end()) {
        kept.push_back(primitive);
      }
    }
    node.first = static_cast<uint32_t>(first);
    node.count = static_cast<uint32_t>(kept.size()) - node.first;
  }
  bvh.references = std::move(kept);
}

}  // namespace tracer
