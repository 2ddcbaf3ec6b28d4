// Ray-box tests that never miss a box whose content the ray hits.
// Based on: A. Williams et al., An Efficient and Robust Ray-Box Intersection Algorithm, 2005 (near
// and far planes by the sign of the direction, so that 0 * infinity for an axis-parallel ray in the
// plane of a slab can be ignored), and T. Ize, Robust BVH Ray Traversal, 2013 (the exit distance is
// padded by two rounding errors). We pad the nearest hit so far as well, so that of two hits a
// rounding error apart the nearer one is found.
#pragma once

#include <algorithm>
#include <cmath>

#include "tracer/bvh/bvh.h"
#include "tracer/math/ray.h"
#include "tracer/math/simd.h"

namespace tracer {

// 1 + 2 gamma(3), gamma(n) = n e / (1 - n e), e half a unit in the last place.
inline constexpr float exit_padding = 1.0f + 7.0f * 5.9604645e-8f;

// What a box test needs of a ray. The fourth lanes turn whatever a node keeps there into 0.
struct BoxRay {
  float4 origin;
  float4 inverse;  // of the direction; infinite for 0, with its sign
  int4 swap;       // all bits of a lane where the direction is negative: the near plane is `hi`
};

inline BoxRay box_ray(const vec3& origin, const vec3& direction) {
  BoxRay ray;
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = origin[axis];
    ray.inverse[axis] = 1.0f / direction[axis];
    ray.swap[axis] = std::signbit(direction[axis]) ? -1 : 0;
  }
  ray.origin[3] = 1.0f;
  ray.inverse[3] = 0.0f;
  ray.swap[3] = 0;
  return ray;
}

// Distances to the near and far planes of a box, NaN where a ray runs in one.
struct PlaneDistances {
  float4 near, far;
};

inline PlaneDistances plane_distances(const BvhNode& node, const BoxRay& ray) {
  const float4 lo = load4(&node.lo.x);
  const float4 hi = load4(&node.hi.x);
  const int4 exchanged = (bits(lo) ^ bits(hi)) & ray.swap;
  const float4 near_plane = floats(bits(lo) ^ exchanged);
  const float4 far_plane = floats(bits(hi) ^ exchanged);
  return {(near_plane - ray.origin) * ray.inverse, (far_plane - ray.origin) * ray.inverse};
}

// Where the ray is inside the box, the exit not yet cut off by the nearest hit.
struct BoxSpan {
  float entry, exit;
  bool hit;
};

inline BoxSpan box_span(const BvhNode& node, const BoxRay& ray, float t_min, float t_max) {
  const PlaneDistances planes = plane_distances(node, ray);
  const float4 near = max(planes.near, broadcast(t_min));  // NaN out
  const float4 far = min(planes.far, broadcast(infinity));
  const float entry = std::max(std::max(near[0], near[1]), near[2]);
  const float exit = std::min(std::min(far[0], far[1]), far[2]) * exit_padding;
  return {entry, exit, entry <= std::min(exit, t_max * exit_padding)};
}

// Both children of an inner node at once: lanes 0 and 1. hit has a bit for each.
struct BoxPairSpan {
  float4 entry, exit;
  int hit;
};

inline BoxPairSpan box_pair_span(const BvhNode* pair, const BoxRay& ray, float t_min, float t_max) {
  const PlaneDistances planes0 = plane_distances(pair[0], ray);
  const PlaneDistances planes1 = plane_distances(pair[1], ray);
  const float4 entry0 = max(planes0.near, broadcast(t_min));  // NaN out
  const float4 entry1 = max(planes1.near, broadcast(t_min));
  const float4 exit0 = min(planes0.far, broadcast(infinity));
  const float4 exit1 = min(planes1.far, broadcast(infinity));
  // (x0, x1, y0, y1) and (z0, z1, ...): three values a child, reduced in lanes 0 and 1.
  const float4 entry_xy = __builtin_shufflevector(entry0, entry1, 0, 4, 1, 5);
  const float4 entry_z = __builtin_shufflevector(entry0, entry1, 2, 6, 2, 6);
  const float4 exit_xy = __builtin_shufflevector(exit0, exit1, 0, 4, 1, 5);
  const float4 exit_z = __builtin_shufflevector(exit0, exit1, 2, 6, 2, 6);
  const float4 entry_y = __builtin_shufflevector(entry_xy, entry_xy, 2, 3, 2, 3);
  const float4 exit_y = __builtin_shufflevector(exit_xy, exit_xy, 2, 3, 2, 3);
  BoxPairSpan span;
  span.entry = max(max(entry_xy, entry_y), entry_z);
  span.exit = min(min(exit_xy, exit_y), exit_z) * broadcast(exit_padding);
  span.hit = mask_bits(span.entry <= min(span.exit, broadcast(t_max * exit_padding))) & 3;
  return span;
}

}  // namespace tracer
