// The hot path of the wide layouts: closest hit and any hit, one ray at a time. Compiled once for
// each instruction set, hence no #pragma once: see hwy/foreach_target.h.
// The watertight box test is that of box_test.h, with the near and far planes chosen by the ray's
// signs; the triangle test is that of triangle_test.h, bit for bit, so that every layout finds the
// same hits.
#if defined(TRACER_BVH_WIDE_TRAVERSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRACER_BVH_WIDE_TRAVERSE_INL_H_
#undef TRACER_BVH_WIDE_TRAVERSE_INL_H_
#else
#define TRACER_BVH_WIDE_TRAVERSE_INL_H_
#endif

#include <array>
#include <bit>
#include <cassert>
#include <cstring>
#include <type_traits>

#include <hwy/highway.h>

#include "tracer/bvh/block_test-inl.h"
#include "tracer/bvh/traverse.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// As many lanes as a node has slots, or as the instruction set offers: then a node takes several
// vectors.
template <int W>
using SlotLanes = hn::CappedTag<float, W>;

// What the box tests need of a ray is kept in every lane, or spread where it is used.
template <class D>
HWY_INLINE hn::Vec<D> in_lanes(D, hn::Vec<D> value) {
  return value;
}
template <class D>
HWY_INLINE hn::Vec<D> in_lanes(D d, float value) {
  return hn::Set(d, value);
}

// In every lane. For the fast tests from_near is the origin times `inverse`; they need neither
// from_far nor `padded`.
template <int W>
struct WideRay {
  using V = hn::Vec<SlotLanes<W>>;
  V from_near[3], from_far[3], inverse[3], padded[3];
  uint32_t near[3], far[3];  // which planes of a node the ray meets first, and last
};

template <Tests tests, int W>
HWY_INLINE WideRay<W> wide_ray(const BoxRay& box) {
  const SlotLanes<W> d;
  WideRay<W> ray;
  for (int axis = 0; axis < 3; ++axis) {
    const bool backwards = box.inverse[axis] < 0.0f;
    ray.near[axis] = 2 * axis + uint32_t(backwards);
    ray.far[axis] = 2 * axis + uint32_t(!backwards);
    const float lo = box.from_lo[axis];
    const float hi = box.from_hi[axis];
    ray.inverse[axis] = hn::Set(d, box.inverse[axis]);
    if constexpr (tests == Tests::fast) {
      ray.from_near[axis] = hn::Set(d, lo * box.inverse[axis]);
    } else {
      ray.from_near[axis] = hn::Set(d, backwards ? hi : lo);
      ray.from_far[axis] = hn::Set(d, backwards ? lo : hi);
      ray.padded[axis] = hn::Set(d, box.padded[axis]);
    }
  }
  return ray;
}

// Plane p of the slots from `slot` on: where it is, and where along a ray by the fast tests.
template <int W>
struct FloatPlanes {
  const WideNode<W>& node;
  explicit FloatPlanes(const WideNode<W>& of) : node(of) {}
  template <class D>
  HWY_INLINE hn::Vec<D> load(D d, uint32_t plane, size_t slot) const {
    return hn::Load(d, node.planes[plane] + slot);
  }
  template <class D, class V = hn::Vec<D>>
  HWY_INLINE V fast_distance(D d, uint32_t plane, size_t slot, V inverse, V from) const {
    return hn::MulSub(load(d, plane, slot), inverse, from);
  }
  HWY_INLINE uint32_t slots() const { return ~0u; }
};
struct QuantisedPlanes {
  const QuantisedNode& node;
  explicit QuantisedPlanes(const QuantisedNode& of) : node(of) {}
  template <class D>
  HWY_INLINE hn::Vec<D> steps(D d, uint32_t plane, size_t slot) const {
    const hn::RebindToSigned<D> words;
    const hn::Rebind<uint8_t, D> bytes;
    return hn::ConvertTo(d, hn::PromoteTo(words, hn::LoadU(bytes, node.planes[plane] + slot)));
  }
  HWY_INLINE float step(uint32_t plane) const {
    return std::bit_cast<float>(uint32_t(node.exponent[plane / 2]) << 23);
  }
  template <class D>
  HWY_INLINE hn::Vec<D> load(D d, uint32_t plane, size_t slot) const {
    return hn::Add(hn::Set(d, node.origin[plane / 2]),
                   hn::Mul(steps(d, plane, slot), hn::Set(d, step(plane))));
  }
  // The ray goes in steps of the node from its origin.
  template <class D, class V = hn::Vec<D>>
  HWY_INLINE V fast_distance(D d, uint32_t plane, size_t slot, V inverse, V from) const {
    return hn::MulAdd(steps(d, plane, slot), hn::Mul(hn::Set(d, step(plane)), inverse),
                      hn::MulSub(hn::Set(d, node.origin[plane / 2]), inverse, from));
  }
  HWY_INLINE uint32_t slots() const { return node.slots; }
};
template <int W>
FloatPlanes<W> planes_of(const WideNode<W>& node) {
  return FloatPlanes<W>(node);
}
inline QuantisedPlanes planes_of(const QuantisedNode& node) {
  return QuantisedPlanes(node);
}

// Where the ray is inside the children's boxes.
template <int W>
struct alignas(64) ChildSpans {
  float entry[W], exit[W];
};

// The children that the ray (WideRay, or with floats in place of vectors) enters before `end`: a
// bit for each slot.
template <Tests tests, class Node, class BoxRayOf, int W = Node::width>
HWY_INLINE uint32_t hit_children(const Node& node, const BoxRayOf& ray, float t_min, float end,
                                 ChildSpans<W>& spans) {
  const SlotLanes<W> d;
  const auto planes = planes_of(node);
  uint32_t hits = 0;
  for (size_t slot = 0; slot < W; slot += hn::Lanes(d)) {
    const auto fast_distance = [&](uint32_t plane, int axis) HWY_ATTR {
      return planes.fast_distance(d, plane, slot, in_lanes(d, ray.inverse[axis]),
                                  in_lanes(d, ray.from_near[axis]));
    };
    const auto entry_of = [&](int axis) HWY_ATTR {
      if constexpr (tests == Tests::fast) return fast_distance(ray.near[axis], axis);
      const auto near = planes.load(d, ray.near[axis], slot);
      return hn::Mul(hn::Sub(near, in_lanes(d, ray.from_near[axis])),
                     in_lanes(d, ray.inverse[axis]));
    };
    const auto exit_of = [&](int axis) HWY_ATTR {
      if constexpr (tests == Tests::fast) return fast_distance(ray.far[axis], axis);
      const auto far = planes.load(d, ray.far[axis], slot);
      return hn::Mul(hn::Sub(far, in_lanes(d, ray.from_far[axis])), in_lanes(d, ray.padded[axis]));
    };
    const auto entry =
        hn::Max(hn::Max(entry_of(0), entry_of(1)), hn::Max(entry_of(2), hn::Set(d, t_min)));
    const auto exit = hn::Min(hn::Min(exit_of(0), exit_of(1)), exit_of(2));
    hits |= bits_of(d, hn::Le(entry, hn::Min(exit, hn::Set(d, end)))) << slot;
    hn::Store(entry, d, spans.entry + slot);
    hn::Store(exit, d, spans.exit + slot);
  }
  return hits & planes.slots();
}

// Probes get the nodes of the canonical tree that the slots came from.
template <class Probe>
inline constexpr bool watches = !std::is_same_v<Probe, NoProbe>;

template <class Node>
HWY_INLINE void prefetch(const WideNodes<Node>& tree, WideChild child) {
  constexpr uintptr_t line = 64;
  const uintptr_t at = is_leaf(child)
                           ? reinterpret_cast<uintptr_t>(tree.blocks.data()) +
                                 (child & ~leaf_bit) * sizeof(TriangleBlock)
                           : reinterpret_cast<uintptr_t>(tree.nodes.data()) + child * sizeof(Node);
  for (uintptr_t i = 0; i < sizeof(Node) / line; ++i)
    __builtin_prefetch(reinterpret_cast<const void*>(at + i * line));
}

// False: a root over a single leaf, which is no node of the canonical tree.
template <class Node>
HWY_INLINE bool is_canonical(const Node& node) {
  return node.binary[0] != 0;
}

// Visits the leaves that the ray may hit. leaf(first block or entry) tests what is in it,
// shortens t_max and returns true to end the traversal; then the walk returns true, too. The
// nearest child first, of several as near the first slot; any hit: the last slot first. Begins at
// the root, or at what is `id` in the canonical tree: where an instance is entered, or where a
// packet has left off.
template <bool any_hit, Tests tests, class Node, class Probe, class Leaf>
HWY_INLINE bool walk_wide(const WideNodes<Node>& tree, const WideRay<Node::width>& ray,
                          const float t_min, const float& t_max, Probe& probe, const Leaf& leaf,
                          WideChild child = 0, [[maybe_unused]] uint32_t id = 0) {
  constexpr int W = Node::width;
  struct Waiting {
    WideChild child;
    float entry;
  };
  constexpr size_t capacity = (W - 1) * (max_tree_depth + 1) + 1;
  assert(tree.depth <= max_tree_depth);
  std::array<Waiting, capacity> stack;
  [[maybe_unused]] std::array<uint32_t, watches<Probe> ? capacity : 1> stack_ids;
  size_t waiting = 0;
  const Node* nodes = tree.nodes.data();

  if constexpr (watches<Probe>)
    if (is_leaf(child) || is_canonical(nodes[child]))
      probe.box(id, is_leaf(child), t_min, t_max, t_max);
  while (true) {
    if (!is_leaf(child)) {
      if constexpr (watches<Probe>)
        if (is_canonical(nodes[child])) probe.inner(id);
      const Node& node = nodes[child];
      ChildSpans<W> spans;
      uint32_t hits = hit_children<tests>(node, ray, t_min, t_max * end_padding<tests>, spans);
      if constexpr (watches<Probe>) {
        for (int slot = 0; slot < W && node.child[slot] != no_child; ++slot) {
          probe.box(node.binary[slot], is_leaf(node.child[slot]), spans.entry[slot],
                    spans.exit[slot], t_max);
        }
      }
      if (hits != 0) {
        const int first = std::countr_zero(hits);
        hits &= hits - 1;
        child = node.child[first];
        if constexpr (watches<Probe>) id = node.binary[first];
        prefetch(tree, child);
        if (hits == 0) [[likely]]
          continue;
        float entry = spans.entry[first];
        const size_t bottom = waiting;
        do {
          const int slot = std::countr_zero(hits);
          hits &= hits - 1;
          Waiting other = {node.child[slot], spans.entry[slot]};
          prefetch(tree, other.child);
          [[maybe_unused]] uint32_t other_id = watches<Probe> ? node.binary[slot] : 0;
          // The nearest of those that wait is on top.
          size_t place = waiting++;
          if (any_hit || other.entry < entry) {
            std::swap(child, other.child);
            std::swap(entry, other.entry);
            std::swap(id, other_id);
          } else {
            for (; place > bottom && stack[place - 1].entry <= other.entry; --place) {
              stack[place] = stack[place - 1];
              if constexpr (watches<Probe>) stack_ids[place] = stack_ids[place - 1];
            }
          }
          stack[place] = other;
          if constexpr (watches<Probe>) stack_ids[place] = other_id;
        } while (hits != 0);
        if constexpr (watches<Probe>) {
          for (size_t place = bottom; place < waiting; ++place)
            probe.pushed(stack_ids[place]);
        }
        continue;
      }
    } else {
      if constexpr (watches<Probe>) probe.leaf(id);
      if (leaf(child & ~leaf_bit)) return true;
    }
    while (true) {
      if (waiting == 0) return false;
      const Waiting& next = stack[--waiting];
      if constexpr (watches<Probe>) {
        id = stack_ids[waiting];
        probe.popped();
      }
      if (next.entry <= t_max * end_padding<tests>) {
        child = next.child;
        break;
      }
      if constexpr (watches<Probe>) probe.behind(id, next.entry, t_max);
    }
  }
}

// One ray on its way through the trees of a scene.
template <bool any_hit, class Nodes, class Probe, Tests tests = Tests::watertight>
struct WideTraversal {
  static constexpr int width = std::remove_reference_t<decltype(Nodes().nodes[0])>::width;
  const SceneBvh& bvh;
  const Ray& ray;
  Probe& probe;
  float t_min, t_max;
  Hit hit;

  HWY_INLINE bool visit_blocks(const TriangleBlock* block, const TriangleRayOf<tests>& test,
                               uint32_t id) {
    while (true) {
      BlockHits found;
      uint32_t hits = hit_triangles(*block, test, t_min, t_max, found);
      const bool more = (block->triangle[0] & more_bit) != 0;
      if constexpr (watches<Probe>) {
        for (int lane = 0; lane < block_size; ++lane) {
          const uint32_t triangle = block->triangle[lane] & ~more_bit;
          if (lane > 0 && triangle == (block->triangle[lane - 1] & ~more_bit)) continue;
          const bool is_hit = (hits >> lane & 1) != 0 && found.t[lane] <= t_max;
          probe.triangle(triangle, is_hit, is_hit ? found.t[lane] : 0.0f);
          if (is_hit && take(found, lane, triangle, id) && any_hit) return true;
        }
      } else {
        for (; hits != 0; hits &= hits - 1) {
          const int lane = std::countr_zero(hits);
          take(found, lane, block->triangle[lane] & ~more_bit, id);
          if (any_hit) return true;
        }
      }
      if (!more) return false;
      ++block;
    }
  }

  HWY_INLINE bool take(const BlockHits& found, int lane, uint32_t triangle, uint32_t id) {
    const float t = found.t[lane];
    if (t > t_max || (t == hit.t && !is_before(id, triangle, hit))) return false;
    hit = {t, found.u[lane], found.v[lane], triangle, id};
    if (!any_hit) t_max = t;
    return true;
  }

  HWY_INLINE bool visit_tree(uint32_t id, const Nodes& tree, const vec3& origin,
                             const vec3& direction, const BoxRay& box, WideChild from = 0,
                             uint32_t from_id = 0) {
    const auto test = triangle_ray<tests>(origin, direction, box);
    return walk_wide<any_hit, tests>(
        tree, wide_ray<tests, width>(box), t_min, t_max, probe,
        [&](uint32_t first) HWY_ATTR { return visit_blocks(tree.blocks.data() + first, test, id); },
        from, from_id);
  }

  HWY_INLINE bool visit_instance(const WideEntry& entry) {
    const uint32_t id = entry.instance & ~more_bit;
    const PlacedInstance& instance = bvh.instances[id];
    const Nodes& tree = std::get<Nodes>(bvh.blases[instance.mesh]->wide);
    vec3 origin = ray.origin;
    vec3 direction = ray.direction;
    if (!instance.in_place) {
      origin = moved(instance.to_object, ray.origin);
      direction = turned(instance.to_object, ray.direction);
    }
    probe.enter_instance(id, instance.mesh, entry.at);
    const bool done = visit_tree(id, tree, origin, direction, box_ray<tests>(origin, direction),
                                 entry.at.child, entry.at.node);
    probe.leave_instance();
    return done;
  }

  HWY_INLINE Hit run(const Nodes& tlas) {
    if (!watches<Probe> && tlas.entries.size() == 1) {
      visit_instance(tlas.entries[0]);
      return hit;
    }
    walk_wide<any_hit, tests>(
        tlas, wide_ray<tests, width>(box_ray<tests>(ray.origin, ray.direction)), t_min, t_max,
        probe, [&](uint32_t first) HWY_ATTR {
          for (const WideEntry* entry = tlas.entries.data() + first;; ++entry) {
            if (visit_instance(*entry)) return true;
            if ((entry->instance & more_bit) == 0) return false;
          }
        });
    return hit;
  }
};

template <bool any_hit, class Nodes, Tests tests = Tests::watertight, class Probe>
HWY_INLINE Hit traverse_wide(const SceneBvh& bvh, const Ray& ray, Probe& probe) {
  const Nodes* tlas = std::get_if<Nodes>(&bvh.wide_tlas);  // none over an empty scene
  if (tlas == nullptr || !is_valid(ray) || ray.t_max < 0.0f) return {};
  const float t_min = std::max(0.0f, ray.t_min);
  WideTraversal<any_hit, Nodes, Probe, tests> traversal{bvh, ray, probe, t_min, ray.t_max, {}};
  return traversal.run(*tlas);
}

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
