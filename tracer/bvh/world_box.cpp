// Transforming boxes, and covering a tree with them.
#include "tracer/bvh/world_box.h"

#include <algorithm>
#include <limits>

#include "tracer/math/normalize.h"
#include "tracer/math/simd.h"

namespace tracer {

Box world_box(std::span<const Box> boxes, const mat4& to_world) {
  constexpr float rounding = 8.0f * std::numeric_limits<float>::epsilon();
  float4 column[4];
  for (int axis = 0; axis < 4; ++axis)
    column[axis] = load4(&to_world[axis][0]);
  float4 lo = broadcast(infinity), hi = broadcast(-infinity), magnitude = broadcast(0.0f);
  for (const Box& box : boxes) {
    float4 from = column[3], to = column[3], size = abs(column[3]);
    for (int axis = 0; axis < 3; ++axis) {
      const float4 a = column[axis] * broadcast(box.lo[axis]);
      const float4 b = column[axis] * broadcast(box.hi[axis]);
      from += min(a, b);
      to += max(a, b);
      size += max(abs(a), abs(b));
    }
    lo = min(lo, from);
    hi = max(hi, to);
    magnitude = max(magnitude, size);
  }
  // A turned instance's axes mix what is rounded away.
  const float wider = rounding * max_component(xyz(magnitude));
  return {xyz(lo) - wider, xyz(hi) + wider};
}

std::vector<Box> cover(const Bvh& tree, uint32_t top) {
  constexpr size_t enough = 64;
  const auto size = [&](uint32_t node) {
    const BvhNode& of = tree.nodes[node];
    return of.count > 0 ? 0.0f : half_area(box_of(of));
  };
  const auto is_smaller = [&](uint32_t a, uint32_t b) { return size(a) < size(b); };
  std::vector<uint32_t> nodes = {top};  // a heap
  while (nodes.size() < enough && tree.nodes[nodes.front()].count == 0) {
    std::pop_heap(nodes.begin(), nodes.end(), is_smaller);
    const uint32_t left = tree.nodes[nodes.back()].first;
    nodes.back() = left;
    std::push_heap(nodes.begin(), nodes.end(), is_smaller);
    nodes.push_back(left + 1);
    std::push_heap(nodes.begin(), nodes.end(), is_smaller);
  }
  std::vector<Box> boxes;
  boxes.reserve(nodes.size());
  for (const uint32_t node : nodes)
    boxes.push_back(box_of(tree.nodes[node]));
  return boxes;
}

}  // namespace tracer
