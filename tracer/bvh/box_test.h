// Ray-box tests that never miss a box whose content the ray hits.
// Based on: A. Williams et al., An Efficient and Robust Ray-Box Intersection Algorithm, 2005, and
// T. Ize, Robust BVH Ray Traversal, 2013 (the exit distance is padded by two rounding errors).
// Where we differ: the inverse direction is clamped to finite values, so that an axis-parallel ray
// in the plane of a slab gives 0 * large = 0 instead of NaN, and no test by sign is needed.
#pragma once

#include <algorithm>
#include <cmath>

#include "tracer/bvh/bvh.h"
#include "tracer/math/ray.h"
#include "tracer/math/simd.h"

namespace tracer {

// 1 + 2 gamma(3), gamma(n) = n e / (1 - n e), e half a unit in the last place.
inline constexpr float exit_padding = 1.0f + 6.0f * 5.9604645e-8f * 1.0000003f + 5.9604645e-8f;

// What a box test needs of a ray. The fourth lanes turn whatever a node keeps there into 0.
struct BoxRay {
  float4 origin;
  float4 inverse;  // of the direction, finite
};

inline BoxRay box_ray(const vec3& origin, const vec3& direction) {
  constexpr float largest = std::numeric_limits<float>::max();
  BoxRay ray;
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = origin[axis];
    ray.inverse[axis] = std::clamp(1.0f / direction[axis], -largest, largest);
  }
  ray.origin[3] = 1.0f;
  ray.inverse[3] = 0.0f;
  return ray;
}

// Where the ray is inside the box, the exit not yet cut off by the nearest hit.
struct BoxSpan {
  float entry, exit;
  bool hit;
};

inline BoxSpan box_span(const BvhNode& node, const BoxRay& ray, float t_min, float t_max) {
  const float4 a = (load4(&node.lo.x) - ray.origin) * ray.inverse;
  const float4 b = (load4(&node.hi.x) - ray.origin) * ray.inverse;
  const float4 entry3 = min(a, b);
  const float4 exit3 = max(a, b);
  const float entry = std::max(std::max(std::max(entry3[0], entry3[1]), entry3[2]), t_min);
  const float exit = std::min(std::min(exit3[0], exit3[1]), exit3[2]) * exit_padding;
  return {entry, exit, entry <= std::min(exit, t_max)};
}

// Both children of an inner node at once: lanes 0 and 1. hit has a bit for each.
struct BoxPairSpan {
  float4 entry, exit;
  int hit;
};

inline BoxPairSpan box_pair_span(const BvhNode* pair, const BoxRay& ray, float t_min, float t_max) {
  const float4 a0 = (load4(&pair[0].lo.x) - ray.origin) * ray.inverse;
  const float4 b0 = (load4(&pair[0].hi.x) - ray.origin) * ray.inverse;
  const float4 a1 = (load4(&pair[1].lo.x) - ray.origin) * ray.inverse;
  const float4 b1 = (load4(&pair[1].hi.x) - ray.origin) * ray.inverse;
  const float4 entry0 = min(a0, b0);
  const float4 entry1 = min(a1, b1);
  const float4 exit0 = max(a0, b0);
  const float4 exit1 = max(a1, b1);
  // (x0, x1, y0, y1) and (z0, z1, ...): three values a child, reduced in lanes 0 and 1.
  const float4 entry_xy = __builtin_shufflevector(entry0, entry1, 0, 4, 1, 5);
  const float4 entry_z = __builtin_shufflevector(entry0, entry1, 2, 6, 2, 6);
  const float4 exit_xy = __builtin_shufflevector(exit0, exit1, 0, 4, 1, 5);
  const float4 exit_z = __builtin_shufflevector(exit0, exit1, 2, 6, 2, 6);
  const float4 entry_y = __builtin_shufflevector(entry_xy, entry_xy, 2, 3, 2, 3);
  const float4 exit_y = __builtin_shufflevector(exit_xy, exit_xy, 2, 3, 2, 3);
  BoxPairSpan span;
  span.entry = max(max(entry_xy, entry_y), max(entry_z, broadcast(t_min)));
  span.exit = min(min(exit_xy, exit_y), exit_z) * broadcast(exit_padding);
  span.hit = mask_bits(span.entry <= min(span.exit, broadcast(t_max))) & 3;
  return span;
}

}  // namespace tracer
