// The hot path of the binary layout: closest hit and any hit in the two-level BVH, front to back.
// Ordered traversal with a stack; the nearer child first, the other one waits with its entry
// distance and is dropped if something nearer has been hit meanwhile.
#pragma once

#include <array>
#include <cassert>
#include <cmath>

#include "tracer/bvh/box_test.h"
#include "tracer/bvh/probe.h"
#include "tracer/bvh/triangle_test.h"
#include "tracer/math/columns.h"

namespace tracer {

// The reciprocal of a shorter one is not finite.
inline constexpr float shortest_direction = 3e-39f;

// False for rays that hit nothing by definition: with NaN or infinity (but for t_max), without
// direction, with an empty interval. Box and triangle tests rely on this.
inline bool is_valid(const Ray& ray) {
  static_assert(sizeof(Ray) == 32);
  const float4 from = load4(&ray.origin.x);          // and t_min
  const float4 direction = load4(&ray.direction.x);  // and t_max
  const float4 zero{};
  const int finite_from = mask_bits(from * zero == zero);
  const int finite_direction = mask_bits(direction * zero == zero) | 8;
  const int long_enough = mask_bits(abs(direction) > broadcast(shortest_direction)) & 7;
  return (finite_from & finite_direction) == 15 && long_enough != 0 && ray.t_min <= ray.t_max;
}

// Makes a choice a branch. The processor guesses which child comes next and reads it ahead; with a
// conditional move it would wait for the box test (measured: 1.2 to 1.4 times the rays a second).
inline void keep_branch() {
  asm volatile("");
}

// Visits the leaves of one tree that the ray may hit. leaf(node) tests what is in it, shortens
// t_max and returns true to end the traversal; then walk returns true, too. Begins before a node,
// or at one whose box was hit: inside.
template <Tests tests = Tests::watertight, class Probe, class Leaf>
inline bool walk(const Bvh& bvh, const BoxRay& ray, const float t_min, const float& t_max,
                 Probe& probe, const Leaf& leaf, uint32_t index = 0, bool inside = false) {
  struct Waiting {
    uint32_t node;
    float entry;
  };
  assert(bvh.depth <= max_tree_depth);
  std::array<Waiting, max_tree_depth> stack;  // one sibling waits for each level above
  uint32_t waiting = 0;

  const BvhNode* nodes = bvh.nodes.data();
  if (!inside) {
    const BoxSpan first = box_span<tests>(nodes[index], ray, t_min, t_max);
    probe.box(index, is_leaf(nodes[index]), first.entry, first.exit, t_max);
    if (!first.hit) return false;
  }
  while (true) {
    const BvhNode& node = nodes[index];
    if (is_leaf(node)) {
      probe.leaf(index);
      if (leaf(node)) return true;
    } else {
      probe.inner(index);
      __builtin_prefetch(nodes + nodes[node.first].first);
      __builtin_prefetch(nodes + nodes[node.first + 1].first);
      const BoxPairSpan span = box_pair_span<tests>(nodes + node.first, ray, t_min, t_max);
      probe.box(node.first, is_leaf(nodes[node.first]), span.entry[0], span.exit[0], t_max);
      probe.box(node.first + 1, is_leaf(nodes[node.first + 1]), span.entry[1], span.exit[1], t_max);
      if (span.hit == 3) {
        uint32_t far = 0;
        if (span.entry[0] <= span.entry[1]) {
          keep_branch();
          far = 1;
        }
        stack[waiting++] = {node.first + far, span.entry[far]};
        probe.pushed(node.first + far);
        index = node.first + 1 - far;
        continue;
      }
      if (span.hit != 0) {
        index = node.first;
        if (span.hit == 2) {
          keep_branch();
          ++index;
        }
        continue;
      }
    }
    while (true) {
      if (waiting == 0) return false;
      const Waiting& next = stack[--waiting];
      probe.popped();
      if (next.entry <= t_max * end_padding<tests>) {
        index = next.node;
        break;
      }
      probe.behind(next.node, next.entry, t_max);
    }
  }
}

// Hits at the same distance: the one with the smaller ids counts, so that the answer does not
// depend on the order of traversal.
inline bool is_before(uint32_t instance, uint32_t triangle, const Hit& hit) {
  return instance != hit.instance ? instance < hit.instance : triangle < hit.triangle;
}

// One ray on its way through the trees of a scene.
template <bool any_hit, class Probe, Tests tests = Tests::watertight>
struct BinaryTraversal {
  const SceneBvh& bvh;
  Probe& probe;
  float t_min, t_max;
  Hit hit;

  // From before a node of a BLAS on, or from inside of it; the ray is in its space.
  bool visit_tree(uint32_t id, const Blas& blas, const vec3& origin, const vec3& direction,
                  const BoxRay& box, uint32_t from, bool inside = false) {
    const auto triangle_test = triangle_ray<tests>(origin, direction, box);
    const LeafTriangle* triangles = blas.triangles.data();
    const auto visit_leaf = [&](const BvhNode& leaf) {
      for (uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
        const TriangleHit found = intersect(triangles[i], triangle_test, t_min, t_max);
        probe.triangle(blas.tree.references[i], found.hit, found.t);
        if (!found.hit) continue;
        const uint32_t triangle = blas.tree.references[i];
        if (found.t == hit.t && !is_before(id, triangle, hit)) continue;
        hit = {found.t, found.u, found.v, triangle, id};
        if (any_hit) return true;
        t_max = found.t;
      }
      return false;
    };
    return walk<tests>(blas.tree, box, t_min, t_max, probe, visit_leaf, from, inside);
  }

  void visit_scene(const Ray& ray) {
    const BoxRay world = box_ray<tests>(ray.origin, ray.direction);
    const auto visit_blas = [&](uint32_t id, const PlacedInstance& instance, uint32_t from) {
      const Blas& blas = *bvh.blases[instance.mesh];
      if (instance.in_place) return visit_tree(id, blas, ray.origin, ray.direction, world, from);
      const vec3 origin = moved(instance.to_object, ray.origin);
      const vec3 direction = turned(instance.to_object, ray.direction);
      return visit_tree(id, blas, origin, direction, box_ray<tests>(origin, direction), from);
    };
    const auto visit_instance = [&](uint32_t place) {
      const uint32_t id = bvh.tlas.references[place];
      const EntryPoint entry = entry_at(bvh, place);
      const PlacedInstance& instance = bvh.instances[id];
      probe.enter_instance(id, instance.mesh, entry);
      const bool done = visit_blas(id, instance, entry.node);
      probe.leave_instance();
      return done;
    };
    const auto visit_leaf = [&](const BvhNode& leaf) {
      for (uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
        if (visit_instance(i)) return true;
      return false;
    };
    walk<tests>(bvh.tlas, world, t_min, t_max, probe, visit_leaf);
  }
};

template <bool any_hit, Tests tests = Tests::watertight, class Probe>
inline Hit traverse(const SceneBvh& bvh, const Ray& ray, Probe& probe) {
  if (bvh.tlas.nodes.empty() || !is_valid(ray)) return {};
  const float t_min = std::max(0.0f, ray.t_min);
  BinaryTraversal<any_hit, Probe, tests> traversal{bvh, probe, t_min, ray.t_max, {}};
  traversal.visit_scene(ray);
  return traversal.hit;
}

// The nearest hit in [t_min, t_max]; a negative t_min counts as 0. Watertight.
template <class Probe>
inline Hit intersect(const SceneBvh& bvh, const Ray& ray, Probe& probe) {
  return traverse<false>(bvh, ray, probe);
}

// Whether there is any.
template <class Probe>
inline bool occluded(const SceneBvh& bvh, const Ray& ray, Probe& probe) {
  return is_hit(traverse<true>(bvh, ray, probe));
}

}  // namespace tracer
