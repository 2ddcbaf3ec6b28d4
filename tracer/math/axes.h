// Four vectors at once, axis by axis, and back: by shuffling. (Vectors that are put together float
// by float go through memory, and what reads them waits.)
#pragma once

#include <array>

#include "tracer/math/simd.h"

namespace tracer {

struct Axes {
  float4 x, y, z;
};

inline Axes four_times(const vec3& v) {
  return {broadcast(v.x), broadcast(v.y), broadcast(v.z)};
}

// Of vectors that follow each other.
inline Axes axes_of(const vec3* four) {
  const float* from = &four->x;
  const float4 a = load4(from), b = load4(from + 4), c = load4(from + 8);
  const float4 xy23 = __builtin_shufflevector(b, c, 2, 3, 5, 6);
  const float4 yz01 = __builtin_shufflevector(a, b, 1, 2, 4, 5);
  return {__builtin_shufflevector(a, xy23, 0, 3, 4, 6),
          __builtin_shufflevector(yz01, xy23, 0, 2, 5, 7),
          __builtin_shufflevector(yz01, c, 1, 3, 4, 7)};
}

// One vector a row, with `fourth` in the last lane.
inline std::array<float4, 4> rows(const Axes& axes, float fourth) {
  const float4 w = broadcast(fourth);
  const float4 xy01 = __builtin_shufflevector(axes.x, axes.y, 0, 4, 1, 5);
  const float4 xy23 = __builtin_shufflevector(axes.x, axes.y, 2, 6, 3, 7);
  const float4 zw01 = __builtin_shufflevector(axes.z, w, 0, 4, 1, 5);
  const float4 zw23 = __builtin_shufflevector(axes.z, w, 2, 6, 3, 7);
  return {__builtin_shufflevector(xy01, zw01, 0, 1, 4, 5),
          __builtin_shufflevector(xy01, zw01, 2, 3, 6, 7),
          __builtin_shufflevector(xy23, zw23, 0, 1, 4, 5),
          __builtin_shufflevector(xy23, zw23, 2, 3, 6, 7)};
}

}  // namespace tracer
