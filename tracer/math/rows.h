// Components to vectors, by shuffling. (Vectors that are put together float by float go through
// memory, and what reads them waits.)
#pragma once

#include <array>

#include "tracer/math/simd.h"

namespace tracer {

// One vector a row of the components of four.
inline std::array<float4, 4> rows(float4 x, float4 y, float4 z, float4 w) {
  const float4 xy01 = __builtin_shufflevector(x, y, 0, 4, 1, 5);
  const float4 xy23 = __builtin_shufflevector(x, y, 2, 6, 3, 7);
  const float4 zw01 = __builtin_shufflevector(z, w, 0, 4, 1, 5);
  const float4 zw23 = __builtin_shufflevector(z, w, 2, 6, 3, 7);
  return {__builtin_shufflevector(xy01, zw01, 0, 1, 4, 5),
          __builtin_shufflevector(xy01, zw01, 2, 3, 6, 7),
          __builtin_shufflevector(xy23, zw23, 0, 1, 4, 5),
          __builtin_shufflevector(xy23, zw23, 2, 3, 6, 7)};
}

}  // namespace tracer
