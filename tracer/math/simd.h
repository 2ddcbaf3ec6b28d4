// Four floats at a time, in the vector extensions that GCC and Clang share: SSE on x86-64, NEON on
// aarch64, plain code elsewhere.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "tracer/math/types.h"

namespace tracer {

using float4 = float __attribute__((vector_size(16)));
using int4 = int32_t __attribute__((vector_size(16)));

// Where an operand is NaN the second one is the result. (GCC 12 does not see minps in the plain
// form when an operand is a constant.)
inline float4 min(float4 a, float4 b) {
#ifdef __SSE__
  return __builtin_ia32_minps(a, b);
#else
  return a < b ? a : b;
#endif
}
inline float4 max(float4 a, float4 b) {
#ifdef __SSE__
  return __builtin_ia32_maxps(a, b);
#else
  return a > b ? a : b;
#endif
}
inline float4 broadcast(float value) {
  return float4{value, value, value, value};
}
inline float4 abs(float4 a) {
  return __builtin_bit_cast(float4, __builtin_bit_cast(int4, a) & 0x7fffffff);
}
// 16 bytes from any address.
inline float4 load4(const float* from) {
  float4 value;
  std::memcpy(&value, from, sizeof value);
  return value;
}
inline float4 load3(const vec3& v) {
  return float4{v.x, v.y, v.z, 0.0f};
}
inline float4 sqrt(float4 a) {
#ifdef __SSE__
  return __builtin_ia32_sqrtps(a);
#else
  return float4{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
#endif
}
// Of numbers between -2^31 and 2^31.
inline float4 floor(float4 a) {
  const float4 whole = __builtin_convertvector(__builtin_convertvector(a, int4), float4);
  return whole > a ? whole - broadcast(1.0f) : whole;
}
// Bit i is the sign bit of lane i.
inline int sign_bits(float4 value) {
#ifdef __SSE__
  return __builtin_ia32_movmskps(value);
#else
  const int4 lanes = __builtin_bit_cast(int4, value);
  return ((lanes[0] >> 31) & 1) | ((lanes[1] >> 31) & 2) | ((lanes[2] >> 31) & 4) |
         ((lanes[3] >> 31) & 8);
#endif
}
// Bit i is set where the comparison that gave `mask` (0 or -1 a lane) holds in lane i.
inline int mask_bits(int4 mask) {
  return sign_bits(__builtin_bit_cast(float4, mask));
}
inline vec3 xyz(float4 value) {
  return {value[0], value[1], value[2]};
}

}  // namespace tracer
