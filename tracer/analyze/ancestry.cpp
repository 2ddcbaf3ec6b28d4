// The parent of each node, and the leaves of each primitive.
#include "tracer/analyze/ancestry.h"

namespace tracer {

Ancestry::Ancestry(const Bvh& tree, size_t primitives)
    : parents_(tree.nodes.size(), none), first_(primitives + 2), leaves_(tree.references.size()) {
  for (uint32_t i = 0; i < tree.nodes.size(); ++i) {
    const BvhNode& node = tree.nodes[i];
    if (!is_leaf(node)) parents_[node.first] = parents_[node.first + 1] = i;
  }
  // The lists one after the other; while they are filled, first_[p + 1] is where p's next leaf
  // goes.
  for (const uint32_t primitive : tree.references)
    ++first_[primitive + 2];
  for (size_t p = 2; p < first_.size(); ++p)
    first_[p] += first_[p - 1];
  for (uint32_t i = 0; i < tree.nodes.size(); ++i) {
    const BvhNode& node = tree.nodes[i];
    for (uint32_t k = node.first; k < node.first + node.count; ++k)
      leaves_[first_[tree.references[k] + 1]++] = i;
  }
}

}  // namespace tracer
