// One loop from the last node to the first, since children come after their parents; big trees as
// subtrees beside each other and then the nodes above them.
#include "tracer/bvh/refit.h"

#include <cassert>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace tracer {
namespace {

constexpr size_t min_parallel = 1u << 14;  // nodes; below it one loop is as fast
constexpr size_t tasks_wanted = 128;

void set_box(BvhNode& node, const vec3& lo, const vec3& hi) {
  node.lo = lo;
  node.hi = hi;
}

void unite_children(std::span<BvhNode> nodes, BvhNode& node) {
  const BvhNode& left = nodes[node.first];
  const BvhNode& right = nodes[node.first + 1];
  set_box(node, glm::min(left.lo, right.lo), glm::max(left.hi, right.hi));
}

// The depth of the recursion is the tree's, max_tree_depth at most.
template <class Leaf>
void refit_below(std::span<BvhNode> nodes, uint32_t index, const Leaf& leaf) {
  BvhNode& node = nodes[index];
  if (is_leaf(node)) return leaf(node);
  refit_below(nodes, node.first, leaf);
  refit_below(nodes, node.first + 1, leaf);
  unite_children(nodes, node);
}

// The nodes above the subtrees, parents first, and the roots of the subtrees.
struct Cut {
  std::vector<uint32_t> above, roots;
};
Cut cut(std::span<const BvhNode> nodes) {
  Cut result;
  result.roots = {0};
  bool grows = true;
  while (grows && result.roots.size() < tasks_wanted) {
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

template <class Leaf>
void refit_nodes(std::span<BvhNode> nodes, const Leaf& leaf) {
  if (nodes.size() < min_parallel || tbb::this_task_arena::max_concurrency() == 1) {
    for (size_t i = nodes.size(); i-- > 0;) {
      if (is_leaf(nodes[i])) {
        leaf(nodes[i]);
      } else {
        unite_children(nodes, nodes[i]);
      }
    }
    return;
  }
  const Cut at = cut(nodes);
  tbb::parallel_for(size_t{0}, at.roots.size(),
                    [&](size_t i) { refit_below(nodes, at.roots[i], leaf); });
  for (size_t i = at.above.size(); i-- > 0;)
    unite_children(nodes, nodes[at.above[i]]);
}

}  // namespace

void refit(Bvh& tree, std::span<const Box> boxes) {
  refit_nodes(std::span(tree.nodes), [&](BvhNode& leaf) {
    Box box;
    for (uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
      box = united(box, boxes[tree.references[i]]);
    set_box(leaf, box.lo, box.hi);
  });
}

void refit(Blas& blas, const Mesh& mesh) {
  blas.triangles.resize(blas.tree.references.size() + 1);  // one of padding
  refit_nodes(std::span(blas.tree.nodes), [&](BvhNode& leaf) {
    vec3 lo(infinity);
    vec3 hi(-infinity);
    for (uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
      const uint32_t triangle = blas.tree.references[i];
      assert(triangle < mesh.triangles.size());
      const uvec3& corners = mesh.triangles[triangle];
      LeafTriangle& copy = blas.triangles[i];
      for (int k = 0; k < 3; ++k) {
        const vec3& position = mesh.positions[corners[k]];
        copy.x[k] = position.x;
        copy.y[k] = position.y;
        copy.z[k] = position.z;
        lo = glm::min(lo, position);
        hi = glm::max(hi, position);
      }
    }
    set_box(leaf, lo, hi);
  });
}

std::shared_ptr<Blas> refitted(const Blas& built, const Mesh& mesh) {
  auto blas = std::make_shared<Blas>();
  blas->tree = built.tree;
  blas->build_ms = built.build_ms;
  blas->built_areas = built.built_areas;
  if (!blas->built_areas) {
    auto areas = std::make_shared<std::vector<float>>(built.tree.nodes.size());
    for (size_t i = 0; i < areas->size(); ++i)
      (*areas)[i] = half_area(box_of(built.tree.nodes[i]));
    blas->built_areas = std::move(areas);
  }
  refit(*blas, mesh);
  return blas;
}

bool has_split_references(const Blas& blas, const Mesh& mesh) {
  return blas.tree.references.size() > mesh.triangles.size();
}

}  // namespace tracer
