// Trees made in parts: the top by all threads together, then each subtree by one, in any order.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "tracer/bvh/build.h"

namespace tracer {

struct Subtree {
  std::vector<BvhNode> nodes;        // its root is entry 0
  std::vector<uint32_t> references;  // as its leaves come
  uint32_t depth = 0;                // of its deepest leaf in the whole tree
};

// Primitives of a part: some dozens of parts keep the threads of a large build busy.
inline uint32_t part_size_of(uint32_t primitives) {
  return std::max(1u << 10, primitives / 32);
}

// The root of subtrees[i] becomes node places[i] of `top`, which has kept it free; all else is
// appended.
void join(Bvh& top, std::span<const uint32_t> places, std::span<const Subtree> subtrees);

}  // namespace tracer
