// New boxes, from the leaves up.
#include "tracer/bvh/refit.h"

#include <cassert>

#include "tracer/bvh/bottom_up.h"
#include "tracer/bvh/leaf_order.h"

namespace tracer {
namespace {

void set_box(BvhNode& node, const vec3& lo, const vec3& hi) {
  node.lo = lo;
  node.hi = hi;
}

void unite_children(std::span<BvhNode> nodes, BvhNode& node) {
  const BvhNode& left = nodes[node.first];
  const BvhNode& right = nodes[node.first + 1];
  set_box(node, glm::min(left.lo, right.lo), glm::max(left.hi, right.hi));
}

// A leaf gets its box by leaf(node), an inner node that of its children.
template <class Leaf>
void refit_nodes(std::span<BvhNode> nodes, const Leaf& leaf) {
  for_nodes_bottom_up(nodes, [&](BvhNode& node) {
    if (is_leaf(node)) {
      leaf(node);
    } else {
      unite_children(nodes, node);
    }
  });
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
      prefetch_ahead(mesh, blas.tree.references, i);
      copy_corners(blas.triangles[i], mesh, triangle);
      for (int k = 0; k < 3; ++k) {
        const vec3& position = mesh.positions[mesh.triangles[triangle][k]];
        lo = glm::min(lo, position);
        hi = glm::max(hi, position);
      }
    }
    set_box(leaf, lo, hi);
  });
  refit(blas.wide, blas.tree, blas.triangles);
}

std::shared_ptr<Blas> refitted(const Blas& built, const Mesh& mesh) {
  auto blas = std::make_shared<Blas>();
  blas->tree = built.tree;
  blas->wide = built.wide;
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
