// The ways from the primitives of a tree up to its root.
#pragma once

#include <span>
#include <vector>

#include "tracer/bvh/bvh.h"

namespace tracer {

class Ancestry {
 public:
  Ancestry() = default;
  Ancestry(const Bvh& tree, size_t primitives);

  uint32_t parent(uint32_t node) const { return parents_[node]; }  // of the root: none

  // Where the primitive is referenced: several leaves if spatial splits have cut it.
  std::span<const uint32_t> leaves(uint32_t primitive) const {
    return std::span(leaves_).subspan(first_[primitive], first_[primitive + 1] - first_[primitive]);
  }

 private:
  std::vector<uint32_t> parents_;  // by node
  std::vector<uint32_t> first_;    // by primitive: where its leaves begin in leaves_; one more
  std::vector<uint32_t> leaves_;   // nodes
};

}  // namespace tracer
