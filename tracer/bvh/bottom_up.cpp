// Cutting a tree into subtrees that can be visited beside each other.
#include "tracer/bvh/bottom_up.h"

namespace tracer {

TreeCut cut(std::span<const BvhNode> nodes, size_t roots_wanted) {
  TreeCut result;
  result.roots = {0};
  bool grows = true;
  while (grows && result.roots.size() < roots_wanted) {
    grows = false;
    std::vector<uint32_t> next;
    for (const uint32_t root : result.roots) {
      if (is_leaf(nodes[root])) {
        next.push_back(root);
        continue;
      }
      result.above.push_back(root);
      next.push_back(nodes[root].first);
      next.push_back(nodes[root].first + 1);
      grows = true;
    }
    result.roots = std::move(next);
  }
  return result;
}

}  // namespace tracer
