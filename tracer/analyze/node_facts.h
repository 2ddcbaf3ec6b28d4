// What a tree says of one of its nodes.
#pragma once

#include <optional>

#include "tracer/bvh/bvh.h"

namespace tracer {

struct NodeFacts {
  Box box;
  bool leaf = false;
  uint32_t parent = none;   // of the root: none
  uint32_t depth = 0;       // edges from the root
  uint64_t references = 0;  // in the leaves below, or in the leaf
  double area_share = 0.0;  // A(node) / A(root): how often a random line through the root meets it
};

// Nothing for a node that is not there. Ends for damaged trees too. Linear in the nodes.
std::optional<NodeFacts> node_facts(const Bvh& tree, uint32_t node);

}  // namespace tracer
