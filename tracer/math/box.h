// Axis-aligned boxes.
#pragma once

#include "tracer/math/types.h"

namespace tracer {

// Empty as constructed (lo > hi); growing an empty box by a point gives that point.
struct Box {
  vec3 lo{infinity};
  vec3 hi{-infinity};

  bool operator==(const Box&) const = default;
};

inline bool is_empty(const Box& box) {
  return box.lo.x > box.hi.x || box.lo.y > box.hi.y || box.lo.z > box.hi.z;
}
inline Box grown(const Box& box, const vec3& point) {
  return {glm::min(box.lo, point), glm::max(box.hi, point)};
}
inline Box united(const Box& a, const Box& b) {
  return {glm::min(a.lo, b.lo), glm::max(a.hi, b.hi)};
}
// Empty (lo > hi) when the two do not touch.
inline Box intersected(const Box& a, const Box& b) {
  return {glm::max(a.lo, b.lo), glm::min(a.hi, b.hi)};
}
inline vec3 extent(const Box& box) {
  return is_empty(box) ? vec3(0.0f) : box.hi - box.lo;
}
inline vec3 center(const Box& box) {
  return 0.5f * box.lo + 0.5f * box.hi;
}
// Half of the surface; 0 for an empty box. SAH needs ratios only, so the factor two is left out.
inline float half_area(const Box& box) {
  const vec3 e = extent(box);
  return e.x * e.y + e.y * e.z + e.z * e.x;
}
inline bool contains(const Box& outer, const Box& inner) {
  return glm::all(glm::lessThanEqual(outer.lo, inner.lo)) &&
         glm::all(glm::greaterThanEqual(outer.hi, inner.hi));
}

}  // namespace tracer
