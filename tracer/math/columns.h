// Matrices as four columns of four floats, for the hot paths. Sums are taken in GLM's order: the
// result is that of mat4 * vec4, to the bit.
#pragma once

#include "tracer/math/simd.h"

namespace tracer {

template <int lane>
float4 spread(float4 v) {
  return __builtin_shufflevector(v, v, lane, lane, lane, lane);
}

struct Columns {
  float4 x, y, z, w;

  // Directions ...
  float4 turned(float4 v) const { return (x * spread<0>(v) + y * spread<1>(v)) + z * spread<2>(v); }
  // ... and points; both have anything in the fourth lane.
  float4 moved(float4 v) const {
    return (x * spread<0>(v) + y * spread<1>(v)) + (z * spread<2>(v) + w);
  }
  Columns absolute() const { return {abs(x), abs(y), abs(z), abs(w)}; }
};

inline Columns columns(const mat4& m) {
  return {load4(&m[0].x), load4(&m[1].x), load4(&m[2].x), load4(&m[3].x)};
}
inline Columns columns(const mat3& m) {
  return {load3(m[0]), load3(m[1]), load3(m[2]), float4{}};
}

inline vec3 moved(const mat4& m, const vec3& point) {
  return xyz(columns(m).moved(load3(point)));
}
inline vec3 turned(const mat4& m, const vec3& direction) {
  return xyz(columns(m).turned(load3(direction)));
}

}  // namespace tracer
