// Ray-box tests that never miss a box whose content the ray hits.
// Based on: T. Kay, J. Kajiya, Ray Tracing Complex Scenes, 1986 (slabs), and T. Ize, Robust BVH Ray
// Traversal, 2013 (the exit distance is padded by two rounding errors). Where we differ: a ray that
// is parallel to a slab sees it a little wider, so that 0 * infinity cannot happen and a ray in the
// plane of a slab is inside; and the nearest hit so far is padded as well, so that of two hits a
// rounding error apart the nearer one is found. The fast tests leave all of that out.
#pragma once

#include <algorithm>
#include <cmath>

#include "tracer/bvh/bvh.h"
#include "tracer/math/ray.h"
#include "tracer/math/simd.h"

namespace tracer {

// 1 + 2 gamma(3), gamma(n) = n e / (1 - n e), e half a unit in the last place.
inline constexpr float exit_padding = 1.0f + 7.0f * 5.9604645e-8f;

// What rays are held against boxes and triangles with. Watertight: nothing that a ray meets is
// lost. Fast: a ray may slip through at edges and vertices, or past the side of a box.
enum class Tests { watertight, fast };

// How far behind the nearest hit so far boxes are still worth a visit.
template <Tests tests>
inline constexpr float end_padding = tests == Tests::fast ? 1.0f : exit_padding;

// What a box test needs of a ray. The fourth lanes keep whatever a node has there from being slow.
struct BoxRay {
  float4 from_lo;  // the origin, as the planes of `lo` are seen from it
  float4 from_hi;  // and those of `hi`
  float4 inverse;  // of the direction, finite
  float4 padded;   // the same times exit_padding, unless fast
};

// Shorter ones count as this long in the fast tests: with their reciprocal planes stay finite.
inline constexpr float least_component = 1e-18f;

template <Tests tests = Tests::watertight>
inline BoxRay box_ray(const vec3& origin, const vec3& direction) {
  constexpr float largest = std::numeric_limits<float>::max();
  const float4 from{origin.x, origin.y, origin.z, 1.0f};
  const float4 way{direction.x, direction.y, direction.z, 1.0f};
  if constexpr (tests == Tests::fast) {
    const float4 least = broadcast(least_component);
    const float4 inverse =
        broadcast(1.0f) / (abs(way) < least ? (way < float4{} ? -least : least) : way);
    return {from, from, inverse, inverse};
  }
  const float4 inverse = broadcast(1.0f) / way;
  const float4 padded = inverse * broadcast(exit_padding);
  const int4 parallel = !(abs(padded) <= broadcast(largest));
  const float4 wider = max(abs(from) * broadcast(2.4e-7f), broadcast(1e-20f));
  const float4 none{};
  return {from + (parallel ? wider : none), from - (parallel ? wider : none),
          parallel ? broadcast(largest) : inverse, parallel ? broadcast(largest) : padded};
}

// Where the ray enters and leaves the three slabs of a box, the exit padded.
struct Slabs {
  float4 entry, exit;
};

template <Tests tests = Tests::watertight>
inline Slabs slabs(const BvhNode& node, const BoxRay& ray) {
  const bool fast = tests == Tests::fast;
  const float4 lo = load4(&node.lo.x) - ray.from_lo;
  const float4 hi = load4(&node.hi.x) - (fast ? ray.from_lo : ray.from_hi);
  const float4 padded = fast ? ray.inverse : ray.padded;
  return {min(lo * ray.inverse, hi * ray.inverse), max(lo * padded, hi * padded)};
}

// Where the ray is inside the box, the exit not yet cut off by the nearest hit.
struct BoxSpan {
  float entry, exit;
  bool hit;
};

template <Tests tests = Tests::watertight>
inline BoxSpan box_span(const BvhNode& node, const BoxRay& ray, float t_min, float t_max) {
  const Slabs box = slabs<tests>(node, ray);
  const float entry = std::max(std::max(std::max(box.entry[0], box.entry[1]), box.entry[2]), t_min);
  const float exit = std::min(std::min(box.exit[0], box.exit[1]), box.exit[2]);
  return {entry, exit, entry <= std::min(exit, t_max * end_padding<tests>)};
}

// Both children of an inner node at once: lanes 0 and 1. hit has a bit for each.
struct BoxPairSpan {
  float4 entry, exit;
  int hit;
};

template <Tests tests = Tests::watertight>
inline BoxPairSpan box_pair_span(const BvhNode* pair, const BoxRay& ray, float t_min, float t_max) {
  const Slabs left = slabs<tests>(pair[0], ray);
  const Slabs right = slabs<tests>(pair[1], ray);
  // (x0, x1, y0, y1) and (z0, z1, ...): three values a child, reduced in lanes 0 and 1.
  const float4 entry_xy = __builtin_shufflevector(left.entry, right.entry, 0, 4, 1, 5);
  const float4 entry_z = __builtin_shufflevector(left.entry, right.entry, 2, 6, 2, 6);
  const float4 exit_xy = __builtin_shufflevector(left.exit, right.exit, 0, 4, 1, 5);
  const float4 exit_z = __builtin_shufflevector(left.exit, right.exit, 2, 6, 2, 6);
  const float4 entry_y = __builtin_shufflevector(entry_xy, entry_xy, 2, 3, 2, 3);
  const float4 exit_y = __builtin_shufflevector(exit_xy, exit_xy, 2, 3, 2, 3);
  BoxPairSpan span;
  span.entry = max(max(entry_xy, entry_y), max(entry_z, broadcast(t_min)));
  const float4 exit_of_xy = min(exit_xy, exit_y);
  span.exit = min(exit_of_xy, exit_z);
  const float4 end = min(exit_of_xy, min(exit_z, broadcast(t_max * end_padding<tests>)));
  span.hit = mask_bits(span.entry <= end) & 3;
  return span;
}

}  // namespace tracer
