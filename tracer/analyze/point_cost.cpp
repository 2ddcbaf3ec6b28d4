// Boxes around one point of the surface.
#include "tracer/analyze/point_cost.h"

#include <algorithm>

namespace tracer {
namespace {

bool holds(const BvhNode& node, const vec3& point) {
  return glm::all(glm::lessThanEqual(node.lo, point)) &&
         glm::all(glm::greaterThanEqual(node.hi, point));
}

class Walk {
 public:
  Walk(const SceneBvh& bvh, const Hit& hit) : bvh_(bvh), hit_(hit) {}

  // Whether what is looked for is below the node, in a leaf that holds the point: leaf(node) says
  // whether it is there.
  template <class Leaf>
  bool visit(const Bvh& tree, uint32_t index, const vec3& point, const Leaf& leaf) {
    const BvhNode& node = tree.nodes[index];
    if (!holds(node, point)) return false;
    ++cost.boxes;
    bool above = false;
    double own = double(bvh_.options.traversal_cost);
    if (is_leaf(node)) {
      own = node.count * double(bvh_.options.intersection_cost);
      above = leaf(node);
    } else {
      above = visit(tree, node.first, point, leaf);
      above |= visit(tree, node.first + 1, point, leaf);
    }
    if (!above) {
      ++cost.useless;
      cost.cost += own;
    }
    return above;
  }

  // Whether the triangle is in this part of an instance, or may be: the whole one has it.
  bool instance(size_t place, const vec3& world, const vec3& object) {
    const uint32_t id = bvh_.tlas.references[place];
    const PlacedInstance& placed = bvh_.instances[id];
    const Bvh& tree = bvh_.blases[placed.mesh]->tree;
    if (tree.nodes.empty()) return false;
    const bool own = id == hit_.instance;
    const vec3 point = own ? object : vec3(placed.to_object * vec4(world, 1.0f));
    const uint32_t from = entry_at(bvh_, place).node;
    const bool found = visit(tree, from, point, [&](const BvhNode& leaf) {
      const auto begin = tree.references.begin() + leaf.first;
      return own && std::find(begin, begin + leaf.count, hit_.triangle) != begin + leaf.count;
    });
    return found || (own && from == 0);
  }

  PointCost cost;

 private:
  const SceneBvh& bvh_;
  const Hit& hit_;
};

// Never outside the triangle's box, whatever is rounded.
vec3 hit_point(const Mesh& mesh, const Hit& hit) {
  const uvec3 corners = mesh.triangles[hit.triangle];
  const vec3 a = mesh.positions[corners.x];
  const vec3 b = mesh.positions[corners.y];
  const vec3 c = mesh.positions[corners.z];
  const vec3 point = (1.0f - hit.u - hit.v) * a + hit.u * b + hit.v * c;
  return glm::clamp(point, glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)));
}

}  // namespace

PointCost point_cost(const Scene& scene, const SceneBvh& bvh, const Hit& hit) {
  const PlacedInstance& placed = bvh.instances[hit.instance];
  const vec3 object = hit_point(scene.meshes[placed.mesh], hit);
  const vec3 world(placed.to_world * vec4(object, 1.0f));
  Walk walk(bvh, hit);
  walk.visit(bvh.tlas, 0, world, [&](const BvhNode& leaf) {
    bool found = false;
    for (uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
      found |= walk.instance(i, world, object);
    return found;
  });
  return walk.cost;
}

}  // namespace tracer
