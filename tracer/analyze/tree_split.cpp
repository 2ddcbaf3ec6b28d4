// The plane with the most room around it, of those that tell the children apart.
#include "tracer/analyze/tree_split.h"

#include <algorithm>
#include <limits>

namespace tracer {
namespace {

// For each of `all` which of two lists have it: bit 0 the left, bit 1 the right one. All ascend.
std::vector<uint8_t> sides_of(std::span<const uint32_t> all, std::span<const uint32_t> left,
                              std::span<const uint32_t> right) {
  std::vector<uint8_t> sides(all.size(), 0);
  size_t l = 0, r = 0;
  for (size_t i = 0; i < all.size(); ++i) {
    const bool in_left = l < left.size() && left[l] == all[i];
    const bool in_right = r < right.size() && right[r] == all[i];
    l += in_left ? 1 : 0;
    r += in_right ? 1 : 0;
    sides[i] = uint8_t((in_left ? 1 : 0) | (in_right ? 2 : 0));
  }
  return sides;
}

// A plane of an axis that tells two sides apart, and how much room it has.
struct Plane {
  float at = 0.0f;
  float room = -1.0f;  // below 0: there is none
};

// All of one child's centres are on one side, all of the other's on the other. The children may
// have changed places.
Plane plane_between(const SplitNode& node, std::span<const uint8_t> sides, int axis) {
  Bounds left, right;
  for (uint32_t i = 0; i < node.range.size(); ++i) {
    const float4 centroid = centroid2(node.references[i]);
    ((sides[i] & 1) != 0 ? left : right).grow(centroid, centroid);
  }
  const bool swapped = left.lo[axis] > right.lo[axis];
  const float below = swapped ? right.hi[axis] : left.hi[axis];
  const float above = swapped ? left.lo[axis] : right.lo[axis];
  return {0.25f * (below + above), 0.5f * (above - below)};
}

// A plane through all that both children refer to, with nothing beyond it that only the other one
// has. Builders cut boxes at it, so it is where one of them ends if that agrees.
Plane plane_through(const SplitNode& node, std::span<const uint8_t> sides, int axis, float left_end,
                    float right_begin) {
  float lo = -infinity, hi = infinity;
  for (uint32_t i = 0; i < node.range.size(); ++i) {
    const Reference& reference = node.references[i];
    if ((sides[i] & 1) != 0) lo = std::max(lo, reference.lo[axis]);
    if ((sides[i] & 2) != 0) hi = std::min(hi, reference.hi[axis]);
  }
  for (const float end : {left_end, right_begin}) {
    if (lo <= end && end <= hi) return {end, hi - lo};
  }
  return {0.5f * (lo + hi), hi - lo};
}

void find_plane(SplitChoice& choice, const Box& left, const Box& right, const SplitNode& node,
                std::span<const uint8_t> sides) {
  choice.space = std::find(sides.begin(), sides.end(), 3) != sides.end();
  float widest = -1.0f;
  for (int axis = 0; axis < 3; ++axis) {
    const Plane plane = choice.space
                            ? plane_through(node, sides, axis, left.hi[axis], right.lo[axis])
                            : plane_between(node, sides, axis);
    if (!(plane.room >= 0.0f && plane.room > widest)) continue;
    widest = plane.room;
    choice.axis = axis;
    choice.at = double(plane.at);
  }
}

}  // namespace

SplitChoice tree_split(const TreeTable& table, uint32_t id, const SplitNode& node) {
  SplitChoice choice;
  choice.id = "tree";
  choice.leaf = is_leaf(table.nodes[id]);
  choice.cost = std::numeric_limits<double>::quiet_NaN();
  if (choice.leaf) return choice;
  std::vector<std::vector<uint32_t>> children;
  double sum = 0.0;
  for (const uint32_t child : children_of(table, id)) {
    children.push_back(primitives_below(table, child));
    sum += double(half_area(table.nodes[child].box)) * double(children.back().size());
  }
  choice.cost = node.cost(sum);
  choice.children = uint32_t(children.size());
  if (children.size() != 2) return choice;
  choice.left = uint32_t(children[0].size());
  choice.right = uint32_t(children[1].size());
  const std::span<const uint32_t> ids = children_of(table, id);
  find_plane(choice, table.nodes[ids[0]].box, table.nodes[ids[1]].box, node,
             sides_of(node.input.primitives, children[0], children[1]));
  return choice;
}

}  // namespace tracer
