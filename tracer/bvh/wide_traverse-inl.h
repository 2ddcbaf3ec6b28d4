// The hot path of the wide layouts: closest hit and any hit, one ray at a time. Compiled once for
// each instruction set, hence no #pragma once: see hwy/foreach_target.h.
// The near and far planes of a box are chosen by the ray's signs. With probes the box test is that
// of box_test.h, bit for bit, so that they see the same on every processor; without, it is that of
// slab_ray.h. The triangle test is that of triangle_test.h, bit for bit, so that every layout finds
// the same hits.
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
#include "tracer/bvh/slab_ray.h"
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

// BoxRay in every lane.
template <int W>
struct WideBoxRay {
  using V = hn::Vec<SlotLanes<W>>;
  V from_near[3], from_far[3], inverse[3], padded[3];
  uint32_t near[3], far[3];  // which planes of a node the ray meets first, and last
};

template <int W>
HWY_INLINE WideBoxRay<W> wide_ray(const BoxRay& box) {
  const SlotLanes<W> d;
  WideBoxRay<W> ray;
  for (int axis = 0; axis < 3; ++axis) {
    const bool backwards = box.inverse[axis] < 0.0f;
    ray.near[axis] = 2 * axis + uint32_t(backwards);
    ray.far[axis] = 2 * axis + uint32_t(!backwards);
    ray.inverse[axis] = hn::Set(d, box.inverse[axis]);
    ray.padded[axis] = hn::Set(d, box.padded[axis]);
    ray.from_near[axis] = hn::Set(d, backwards ? box.from_hi[axis] : box.from_lo[axis]);
    ray.from_far[axis] = hn::Set(d, backwards ? box.from_lo[axis] : box.from_hi[axis]);
  }
  return ray;
}

// SlabRay in every lane.
template <int W>
struct WideSlabRay {
  using V = hn::Vec<SlotLanes<W>>;
  V from_near[3], from_far[3], near_inverse[3], far_inverse[3];
  uint32_t near[3], far[3];
};

template <int W>
HWY_INLINE WideSlabRay<W> wide_ray(const SlabRay& slab) {
  const SlotLanes<W> d;
  WideSlabRay<W> ray;
  const auto backwards = uint32_t(sign_bits(slab.near_inverse));
  for (int axis = 0; axis < 3; ++axis) {
    ray.near[axis] = 2 * axis + (backwards >> axis & 1);
    ray.far[axis] = ray.near[axis] ^ 1;
    ray.near_inverse[axis] = hn::Set(d, slab.near_inverse[axis]);
    ray.far_inverse[axis] = hn::Set(d, slab.far_inverse[axis]);
    ray.from_near[axis] = hn::Set(d, slab.from_near[axis]);
    ray.from_far[axis] = hn::Set(d, slab.from_far[axis]);
  }
  return ray;
}

// Where plane p of the slots from `slot` on is.
template <int W>
struct FloatPlanes {
  const WideNode<W>& node;
  explicit FloatPlanes(const WideNode<W>& of) : node(of) {}
  template <class D>
  HWY_INLINE hn::Vec<D> load(D d, uint32_t plane, size_t slot) const {
    return hn::Load(d, node.planes[plane] + slot);
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

// The children that the ray enters before `end`: a bit for each slot. The ray is a WideBoxRay, a
// WideSlabRay, or one that has floats in place of vectors.
template <class Node, class RayOf, int W = Node::width>
HWY_INLINE uint32_t hit_children(const Node& node, const RayOf& ray, float t_min, float end,
                                 ChildSpans<W>& spans) {
  constexpr bool by_difference = requires {
    ray.padded;
  };
  const SlotLanes<W> d;
  const auto planes = planes_of(node);
  uint32_t hits = 0;
  for (size_t slot = 0; slot < W; slot += hn::Lanes(d)) {
    const auto entry_of = [&](int axis) HWY_ATTR {
      const auto near = planes.load(d, ray.near[axis], slot);
      const auto from = in_lanes(d, ray.from_near[axis]);
      if constexpr (by_difference)
        return hn::Mul(hn::Sub(near, from), in_lanes(d, ray.inverse[axis]));
      else
        return hn::MulSub(near, in_lanes(d, ray.near_inverse[axis]), from);
    };
    const auto exit_of = [&](int axis) HWY_ATTR {
      const auto far = planes.load(d, ray.far[axis], slot);
      const auto from = in_lanes(d, ray.from_far[axis]);
      if constexpr (by_difference)
        return hn::Mul(hn::Sub(far, from), in_lanes(d, ray.padded[axis]));
      else
        return hn::MulSub(far, in_lanes(d, ray.far_inverse[axis]), from);
    };
    const auto entry =
        hn::Max(hn::Max(entry_of(0), entry_of(1)), hn::Max(entry_of(2), hn::Set(d, t_min)));
    // Two minima after another, not three: a ray alone waits for them.
    const auto first_exit = hn::Min(exit_of(0), exit_of(1));
    const auto last_exit = exit_of(2);
    const auto last = hn::Min(first_exit, hn::Min(last_exit, hn::Set(d, end)));
    hits |= bits_of(d, hn::Le(entry, last)) << slot;
    hn::Store(entry, d, spans.entry + slot);
    hn::Store(hn::Min(first_exit, last_exit), d, spans.exit + slot);
  }
  return hits & planes.slots();
}

// Probes get the nodes of the canonical tree that the slots came from.
template <class Probe>
inline constexpr bool watches = !std::is_same_v<Probe, NoProbe>;

template <class Node>
HWY_INLINE void prefetch(const WideNodes<Node>& tree, WideChild child) {
  constexpr size_t line = 64;
  const char* at = is_leaf(child)
                       ? reinterpret_cast<const char*>(tree.blocks.data()) +
                             (child & ~leaf_bit) * sizeof(TriangleBlock)
                       : reinterpret_cast<const char*>(tree.nodes.data()) + child * sizeof(Node);
  for (size_t i = 0; i < sizeof(Node) / line; ++i)
    __builtin_prefetch(at + i * line);
}

// False: a root over a single leaf, which is no node of the canonical tree.
template <class Node>
HWY_INLINE bool is_canonical(const Node& node) {
  return node.binary[0] != 0;
}

// What waits on the stack of a walk without probes: the bits of where the ray enters (nearest hits
// only), and below them the child. Entry distances are not negative, so that keys sort as they do.
using WaitingKey = uint64_t;
HWY_INLINE WaitingKey waiting_key(float entry, WideChild child) {
  return WaitingKey(std::bit_cast<uint32_t>(entry)) << 32 | child;
}
// The greatest key of what is still worth a visit.
HWY_INLINE WaitingKey last_key(float end) {
  return waiting_key(end, ~WideChild(0));
}
// That of the first of `slots`, which is taken out.
template <bool any_hit, class Node, int W = Node::width>
HWY_INLINE WaitingKey take_slot(const Node& node, const ChildSpans<W>& spans, uint32_t& slots) {
  const int slot = std::countr_zero(slots) % W;  // of none: slot 0
  slots &= slots - 1;
  if constexpr (any_hit) return node.child[slot];
  return waiting_key(spans.entry[slot], node.child[slot]);
}
// In bits: a compiler would rather branch on a comparison, which rays make hard to guess.
HWY_INLINE void sort_pair(WaitingKey& near, WaitingKey& far) {
  const WaitingKey exchanged = (near ^ far) & -WaitingKey(far < near);
  near ^= exchanged;
  far ^= exchanged;
}

// Visits the leaves that the ray may hit before `end`. leaf(first block or entry) tests what is in
// it, shortens `end` and returns true to end the walk; then the walk returns true, too. The nearest
// child first; any hit: the last slot first. Begins at `child`: at the root, where an instance is
// entered, or where a packet has left off.
template <bool any_hit, class Node, class Leaf>
HWY_INLINE bool walk(const WideNodes<Node>& tree, const WideSlabRay<Node::width>& ray,
                     const float t_min, const float& end, const Leaf& leaf, WideChild child = 0) {
  constexpr int W = Node::width;
  constexpr size_t capacity = (W - 1) * (max_tree_depth + 1) + 1;
  assert(tree.depth <= max_tree_depth);
  std::array<WaitingKey, capacity> stack;
  WaitingKey* const bottom = stack.data();
  WaitingKey* top = bottom;
  const Node* const nodes = tree.nodes.data();
  while (true) {
    if (!is_leaf(child)) {
      const Node& node = nodes[child];
      ChildSpans<W> spans;
      uint32_t hits = hit_children(node, ray, t_min, end, spans);
      const auto wait = [&](WaitingKey key) HWY_ATTR {
        prefetch(tree, WideChild(key));
        *top++ = key;
      };
      if (hits != 0) {
        WaitingKey nearest = take_slot<any_hit>(node, spans, hits);
        if constexpr (any_hit) {
          while (hits != 0) {
            wait(nearest);
            nearest = take_slot<any_hit>(node, spans, hits);
          }
        } else if (hits != 0) {
          WaitingKey second = take_slot<any_hit>(node, spans, hits);
          sort_pair(nearest, second);
          if (hits == 0) {
            wait(second);
          } else {
            WaitingKey third = take_slot<any_hit>(node, spans, hits);
            sort_pair(second, third);
            sort_pair(nearest, second);
            WaitingKey* const first = top;
            wait(third);
            wait(second);
            while (hits != 0) {
              WaitingKey other = take_slot<any_hit>(node, spans, hits);
              sort_pair(nearest, other);
              wait(other);
              for (WaitingKey* place = top - 1; place > first && place[-1] < place[0]; --place)
                std::swap(place[-1], place[0]);
            }
          }
        }
        child = WideChild(nearest);
        continue;
      }
    } else if (leaf(child & ~leaf_bit)) {
      return true;
    }
    const WaitingKey last = last_key(end);
    do {
      if (top == bottom) return false;
      --top;
    } while (!any_hit && *top > last);
    child = WideChild(*top);
  }
}

// The same with a probe, which hears of every box and what becomes of it. Of children that are as
// near the first slot comes first. `id` is what the child is in the canonical tree.
template <bool any_hit, class Node, class Probe, class Leaf>
HWY_INLINE bool walk_watched(const WideNodes<Node>& tree, const WideBoxRay<Node::width>& ray,
                             const float t_min, const float& t_max, Probe& probe, const Leaf& leaf,
                             WideChild child = 0, uint32_t id = 0) {
  constexpr int W = Node::width;
  struct Waiting {
    WideChild child;
    uint32_t id;
    float entry;
  };
  constexpr size_t capacity = (W - 1) * (max_tree_depth + 1) + 1;
  assert(tree.depth <= max_tree_depth);
  std::array<Waiting, capacity> stack;
  size_t waiting = 0;
  const Node* nodes = tree.nodes.data();

  if (is_leaf(child) || is_canonical(nodes[child]))
    probe.box(id, is_leaf(child), t_min, t_max, t_max);
  while (true) {
    if (!is_leaf(child)) {
      if (is_canonical(nodes[child])) probe.inner(id);
      const Node& node = nodes[child];
      ChildSpans<W> spans;
      uint32_t hits = hit_children(node, ray, t_min, t_max * exit_padding, spans);
      for (int slot = 0; slot < W && node.child[slot] != no_child; ++slot) {
        probe.box(node.binary[slot], is_leaf(node.child[slot]), spans.entry[slot], spans.exit[slot],
                  t_max);
      }
      if (hits != 0) {
        const auto next = [&](uint32_t& slots) HWY_ATTR {
          const int slot = std::countr_zero(slots);
          slots &= slots - 1;
          return Waiting{node.child[slot], node.binary[slot], spans.entry[slot]};
        };
        Waiting nearest = next(hits);
        const size_t bottom = waiting;
        while (hits != 0) {
          Waiting other = next(hits);
          // The nearest of those that wait is on top.
          size_t place = waiting++;
          if (any_hit || other.entry < nearest.entry) {
            std::swap(nearest, other);
          } else {
            for (; place > bottom && stack[place - 1].entry <= other.entry; --place)
              stack[place] = stack[place - 1];
          }
          stack[place] = other;
        }
        for (size_t place = bottom; place < waiting; ++place)
          probe.pushed(stack[place].id);
        child = nearest.child;
        id = nearest.id;
        continue;
      }
    } else {
      probe.leaf(id);
      if (leaf(child & ~leaf_bit)) return true;
    }
    while (true) {
      if (waiting == 0) return false;
      const Waiting& next = stack[--waiting];
      child = next.child;
      id = next.id;
      probe.popped();
      if (next.entry <= t_max * exit_padding) break;
      probe.behind(id, next.entry, t_max);
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
  float end = t_max * end_padding<tests>;  // of boxes that are worth a visit

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
    if (any_hit) return true;
    t_max = t;
    end = t * end_padding<tests>;
    return true;
  }

  // leaf(first block or entry), as the walks want it.
  template <class Leaf>
  HWY_INLINE bool walk_from(const EntryPoint& from, const Nodes& tree, const vec3& origin,
                            const vec3& direction, const Leaf& leaf) {
    if constexpr (watches<Probe>) {
      return walk_watched<any_hit>(tree, wide_ray<width>(box_ray(origin, direction)), t_min, t_max,
                                   probe, leaf, from.child, from.node);
    } else {
      return walk<any_hit>(tree, wide_ray<width>(slab_ray<tests>(origin, direction)), t_min, end,
                           leaf, from.child);
    }
  }

  HWY_INLINE bool visit_tree(uint32_t id, const Nodes& tree, const vec3& origin,
                             const vec3& direction, const EntryPoint& from) {
    TriangleRayOf<tests> test;
    bool is_made = false;  // many rays never meet a leaf
    return walk_from(from, tree, origin, direction, [&](uint32_t first) HWY_ATTR {
      if (!is_made) {
        test = triangle_ray<tests>(origin, direction, box_ray<tests>(origin, direction));
        is_made = true;
      }
      return visit_blocks(tree.blocks.data() + first, test, id);
    });
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
    const bool done = visit_tree(id, tree, origin, direction, entry.at);
    probe.leave_instance();
    return done;
  }

  HWY_INLINE Hit run(const Nodes& tlas) {
    if (!watches<Probe> && tlas.entries.size() == 1) {
      visit_instance(tlas.entries[0]);
      return hit;
    }
    walk_from({}, tlas, ray.origin, ray.direction, [&](uint32_t first) HWY_ATTR {
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
