// Random numbers that are the same on every machine and for every number of threads.
// M. O'Neill, PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for Random
// Number Generation, 2014 (PCG32, and RXS-M-XS as a hash).
#pragma once

#include <algorithm>
#include <cmath>

#include "tracer/math/types.h"

namespace tracer {

// A permutation of the 32-bit numbers that looks random.
inline uint32_t hash(uint32_t value) {
  const uint32_t state = value * 747796405u + 2891336453u;
  const uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
  return (word >> 22) ^ word;
}
inline uint32_t hash(uint32_t a, uint32_t b) {
  return hash(a ^ hash(b));
}

struct Rng {
  uint64_t state = 0;
  uint64_t increment = 1;  // odd; chooses the sequence
};

inline uint32_t next(Rng& rng) {
  const uint64_t old = rng.state;
  rng.state = old * 6364136223846793005u + rng.increment;
  const auto shifted = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
  const auto turn = static_cast<uint32_t>(old >> 59);
  return (shifted >> turn) | (shifted << ((32 - turn) & 31));
}

// Work that runs in parallel takes one stream an item, so the order of the items does not matter.
inline Rng make_rng(uint64_t seed, uint64_t stream = 0) {
  Rng rng{0, 2 * stream + 1};
  next(rng);
  rng.state += seed;
  next(rng);
  return rng;
}

// In [0, 1), with 24 bits.
inline float uniform(Rng& rng) {
  return static_cast<float>(next(rng) >> 8) * 0x1p-24f;
}
inline float uniform(Rng& rng, float lo, float hi) {
  return lo + (hi - lo) * uniform(rng);
}

// A direction of unit length, evenly over the sphere.
inline vec3 direction_on_sphere(Rng& rng) {
  const float y = 1.0f - 2.0f * uniform(rng);
  const float angle = 2.0f * pi * uniform(rng);
  const float radius = std::sqrt(std::max(0.0f, 1.0f - y * y));
  return {radius * std::cos(angle), y, radius * std::sin(angle)};
}

}  // namespace tracer
