// What the box tests of kernels that record nothing need of a ray: the distance to plane p of an
// axis is p * inverse - from, one multiply-add in place of the difference and product of
// box_test.h, and as watertight (T. Ize, Robust BVH Ray Traversal, 2013). With u = 2^-24 the
// inverse is off by one u of itself, and so are product and difference, unless they are one
// instruction: 3 u of the distance for entries, 4 u for exits, whose inverse is a product, too;
// slab_padding covers both. In proportion to origin * inverse it is 4 u at most: origin_error.
#pragma once

#include "tracer/bvh/box_test.h"

namespace tracer {

inline constexpr float origin_error = 3e-7f;  // a little more than 5 u
inline constexpr float slab_padding = 1.0f + 9.0f * 5.9604645e-8f;

// Where planes are seen from: those that the ray meets first, and last. Exits are yet to be padded.
struct SlabOrigin {
  float4 inverse;              // of the direction, finite
  float4 from_near, from_far;  // the origin times it
  bool is_usual;               // the inverse is that of the direction, and finite
};

// For the planes that the ray meets first, and last.
struct SlabRay {
  float4 near_inverse, far_inverse;  // of the direction, finite; the far one padded unless fast
  float4 from_near, from_far;        // the origin times them
};

// A ray that is parallel to a slab sees it a little wider, as in box_test.h: its direction counts
// as 1e-25 of its longest component, or so much that origin * inverse stays finite. Where that
// would not do (origins beyond 1e37 lengths of the direction) planes are not a number of lengths
// away, and the box test leaves them out.
inline float4 finite_inverse(float4 from, float4 inverse) {
  const float4 size = abs(inverse);
  const float4 next = min(size, __builtin_shufflevector(size, size, 1, 2, 0, 1));
  const float4 least = min(next, __builtin_shufflevector(size, size, 2, 0, 1, 2));
  const float4 limit =
      max(least, min(least * broadcast(1e25f), broadcast(1e37f) / max(abs(from), broadcast(0.1f))));
  return max(min(inverse, limit), -limit);
}

template <Tests tests>
inline SlabOrigin slab_origin(const vec3& origin, const vec3& direction) {
  const float4 usual = broadcast(1e30f);
  const float4 from{origin.x, origin.y, origin.z, 1.0f};
  const float4 way{direction.x, direction.y, direction.z, direction.x};
  float4 inverse = broadcast(1.0f) / way;
  float4 at = from * inverse;
  float4 slack = abs(at) * broadcast(origin_error);
  const bool is_usual = mask_bits((abs(inverse) < usual) & (abs(at) < usual)) == 15;
  if (!is_usual) [[unlikely]] {
    inverse = finite_inverse(from, inverse);
    at = from * inverse;
    slack = max(abs(at) * broadcast(origin_error), abs(inverse) * broadcast(1e-20f));
  }
  if constexpr (tests == Tests::fast) return {inverse, at, at, is_usual};
  return {inverse, at + slack, at - slack, is_usual};
}

template <Tests tests>
inline SlabRay slab_ray(const vec3& origin, const vec3& direction) {
  const SlabOrigin slab = slab_origin<tests>(origin, direction);
  if constexpr (tests == Tests::fast)
    return {slab.inverse, slab.inverse, slab.from_near, slab.from_far};
  const float4 padding = broadcast(slab_padding);
  return {slab.inverse, slab.inverse * padding, slab.from_near, slab.from_far * padding};
}

}  // namespace tracer
