#include "tracer/analyze/node_facts.h"

namespace tracer {
namespace {

double half_area(const BvhNode& node) {
  const glm::dvec3 e = glm::dvec3(node.hi) - glm::dvec3(node.lo);
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

bool is_child(const BvhNode& parent, uint32_t node) {
  return !is_leaf(parent) && node - parent.first < 2;
}

// Below `node`; a cycle is left after as many steps as there are nodes.
uint64_t reachable_references(const Bvh& tree, uint32_t node) {
  uint64_t references = 0;
  std::vector<uint32_t> stack = {node};
  for (size_t steps = 0; !stack.empty() && steps <= tree.nodes.size(); ++steps) {
    const uint32_t index = stack.back();
    stack.pop_back();
    if (index >= tree.nodes.size()) continue;
    const BvhNode& at = tree.nodes[index];
    references += at.count;
    if (is_leaf(at)) continue;
    stack.push_back(at.first);
    stack.push_back(at.first + 1);
  }
  return references;
}

}  // namespace

std::optional<NodeFacts> node_facts(const Bvh& tree, uint32_t node) {
  if (node >= tree.nodes.size()) return {};
  NodeFacts facts;
  facts.box = box_of(tree.nodes[node]);
  facts.leaf = is_leaf(tree.nodes[node]);
  facts.references = reachable_references(tree, node);
  const double root = half_area(tree.nodes[0]);
  facts.area_share = root > 0.0 ? half_area(tree.nodes[node]) / root : 1.0;
  // Parents come before their children: one way back meets all ancestors.
  uint32_t child = node;
  for (uint32_t i = node; i-- > 0;) {
    if (!is_child(tree.nodes[i], child)) continue;
    if (child == node) facts.parent = i;
    ++facts.depth;
    child = i;
  }
  return facts;
}

}  // namespace tracer
