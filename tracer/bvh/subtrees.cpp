#include "tracer/bvh/subtrees.h"

#include <tbb/parallel_for.h>

namespace tracer {

void join(Bvh& top, std::span<const uint32_t> places, std::span<const Subtree> subtrees) {
  // Entry k > 0 of a subtree becomes node base + k - 1; its root takes the place kept for it.
  struct Base {
    uint32_t node, reference;
  };
  std::vector<Base> base(subtrees.size());
  Base total{static_cast<uint32_t>(top.nodes.size()), static_cast<uint32_t>(top.references.size())};
  for (size_t i = 0; i < subtrees.size(); ++i) {
    base[i] = total;
    total.node += static_cast<uint32_t>(subtrees[i].nodes.size()) - 1;
    total.reference += static_cast<uint32_t>(subtrees[i].references.size());
    top.depth = std::max(top.depth, subtrees[i].depth);
  }
  top.nodes.resize(total.node);
  top.references.resize(total.reference);
  tbb::parallel_for(size_t{0}, subtrees.size(), [&](size_t i) {
    const std::vector<BvhNode>& nodes = subtrees[i].nodes;
    for (size_t k = 0; k < nodes.size(); ++k) {
      BvhNode node = nodes[k];
      node.first += is_leaf(node) ? base[i].reference : base[i].node - 1;
      top.nodes[k == 0 ? places[i] : base[i].node + k - 1] = node;
    }
    const std::vector<uint32_t>& references = subtrees[i].references;
    std::copy(references.begin(), references.end(), top.references.begin() + base[i].reference);
  });
}

}  // namespace tracer
