// Primitives in the order of a space-filling curve (G. Morton, 1966).
#pragma once

#include <span>
#include <vector>

#include "tracer/bvh/build_parts.h"

namespace tracer {

struct MortonCode {
  uint64_t code;       // 21 bits an axis, x highest
  uint32_t primitive;  // index
};

// By code, equal ones by primitive. The grid is a cube over all centroids.
UntouchedVector<MortonCode> morton_order(std::span<const Box> boxes);

// Where the highest bit that differs in codes[begin, end) becomes 1; the middle of equal codes.
uint32_t first_change(std::span<const MortonCode> codes, uint32_t begin, uint32_t end);

}  // namespace tracer
