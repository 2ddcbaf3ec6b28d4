// Parts of triangles: what lies on either side of a plane, as boxes. What spatial splits and
// pre-splitting are made of (M. Stich, H. Friedrich, A. Dietrich, Spatial Splits in Bounding Volume
// Hierarchies, 2009).
#pragma once

#include "tracer/bvh/build_parts.h"
#include "tracer/scene/mesh.h"

namespace tracer {

struct Corners {
  float4 a, b, c;
};
inline Corners corners_of(const Mesh& mesh, uint32_t triangle) {
  const auto load = [&](uint32_t corner) {
    const vec3& p = mesh.positions[corner];
    return float4{p.x, p.y, p.z, 0.0f};
  };
  const uvec3 corners = mesh.triangles[triangle];
  return {load(corners.x), load(corners.y), load(corners.z)};
}

// The fourth lanes mean nothing.
struct Clipped {
  Bounds left, right;  // empty where nothing of the triangle is on that side
};

inline bool is_empty(const Bounds& box) {
  return (mask_bits(box.lo > box.hi) & 7) != 0;
}

// `value` in the lane of an axis, `others` in all others: by comparing, as a lane that is written
// alone goes through memory, and what reads the vector then waits.
inline float4 in_lane(int axis, float value, float others) {
  return (int4{0, 1, 2, 3} == axis) ? broadcast(value) : broadcast(others);
}

// The part of a triangle inside `box` on both sides of the plane `axis` = at, which goes through
// the box. Where an edge meets the plane the boxes are widened by what rounding may hide, so that
// no ray finds a gap between them.
inline Clipped clip(const Corners& triangle, const Bounds& box, int axis, float at) {
  constexpr float rounding = 4.0f * std::numeric_limits<float>::epsilon();
  Clipped parts;
  const auto edge = [&](float4 from, float4 to) {
    const float a = from[axis], b = to[axis];
    if (a <= at) parts.left.grow(from, from);
    if (a >= at) parts.right.grow(from, from);
    if ((a < at) == (b < at)) return;
    const float4 point = from + (to - from) * broadcast((at - a) / (b - a));
    const float4 pad = (abs(from) + abs(to)) * broadcast(rounding);
    parts.left.grow(point - pad, point + pad);
    parts.right.grow(point - pad, point + pad);
  };
  edge(triangle.a, triangle.b);
  edge(triangle.b, triangle.c);
  edge(triangle.c, triangle.a);
  parts.left.hi = min(parts.left.hi, in_lane(axis, at, infinity));
  parts.right.lo = max(parts.right.lo, in_lane(axis, at, -infinity));
  for (Bounds* part : {&parts.left, &parts.right}) {
    part->lo = max(part->lo, box.lo);
    part->hi = min(part->hi, box.hi);
  }
  return parts;
}

}  // namespace tracer
