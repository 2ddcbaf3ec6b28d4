// Packets in the wide layouts: the rays go down the tree together. An interval that holds all of
// them culls the children of a node at once (S. Boulos et al., Packet-based Whitted and
// Distribution Ray Tracing, 2007), a vector test of one child by all rays decides which of them
// enter it. Few rays that are left go on by themselves (C. Benthin et al., Combining Single and
// Packet-Ray Tracing for Arbitrary Ray Distributions on the Intel MIC Architecture, 2012). Compiled
// once for each instruction set.
#if defined(TRACER_BVH_WIDE_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRACER_BVH_WIDE_PACKET_INL_H_
#undef TRACER_BVH_WIDE_PACKET_INL_H_
#else
#define TRACER_BVH_WIDE_PACKET_INL_H_
#endif

#include "tracer/bvh/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

// The intervals that hold all rays: of the origins as the near and far planes are seen from there,
// and of the reciprocals of the directions.
struct PacketBounds {
  float near_origin[3], far_origin[3], least[3], most[3];
};
HWY_INLINE PacketBounds bounds_of(const PacketRays& rays) {
  const PacketLanes d;
  PacketBounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const bool backwards = (rays.near[axis] & 1) != 0;
    const PacketVector near = rays.from_near[axis].get();
    const PacketVector far = rays.from_far[axis].get();
    const PacketVector inverse = rays.inverse[axis].get();
    // Of a ray that goes forwards the least distance is that from the largest origin.
    bounds.near_origin[axis] =
        hn::GetLane(backwards ? hn::MinOfLanes(d, near) : hn::MaxOfLanes(d, near));
    bounds.far_origin[axis] =
        hn::GetLane(backwards ? hn::MaxOfLanes(d, far) : hn::MinOfLanes(d, far));
    bounds.least[axis] = hn::GetLane(hn::MinOfLanes(d, inverse));
    bounds.most[axis] = hn::GetLane(hn::MaxOfLanes(d, inverse));
  }
  return bounds;
}

// The children that any of the rays may enter, each with a lower bound of where.
template <int W>
HWY_INLINE uint32_t cull_children(const float (*planes)[W], const PacketRays& rays,
                                  const PacketBounds& bounds, float end, float* entry_bound) {
  const SlotLanes<W> d;
  uint32_t hits = 0;
  for (size_t slot = 0; slot < W; slot += hn::Lanes(d)) {
    auto entry = hn::Zero(d);
    auto exit = hn::Set(d, end);
    for (int axis = 0; axis < 3; ++axis) {
      const auto least = hn::Set(d, bounds.least[axis]);
      const auto most = hn::Set(d, bounds.most[axis]);
      const auto near = hn::Sub(hn::Load(d, planes[rays.near[axis]] + slot),
                                hn::Set(d, bounds.near_origin[axis]));
      const auto far = hn::Mul(
          hn::Sub(hn::Load(d, planes[rays.far[axis]] + slot), hn::Set(d, bounds.far_origin[axis])),
          hn::Set(d, exit_padding * exit_padding));
      entry = hn::Max(entry, hn::Min(hn::Mul(near, least), hn::Mul(near, most)));
      exit = hn::Min(exit, hn::Max(hn::Mul(far, least), hn::Mul(far, most)));
    }
    hits |= bits_of(d, hn::Le(entry, exit)) << slot;
    hn::Store(entry, d, entry_bound + slot);
  }
  return hits;
}

// One packet on its way through a scene.
template <bool any_hit, class Nodes>
class WidePacket : public Packet<any_hit> {
  using Packet<any_hit>::load, Packet<any_hit>::alive, Packet<any_hit>::transform;
  using Packet<any_hit>::visit_triangle, Packet<any_hit>::world_, Packet<any_hit>::local_;
  using Packet<any_hit>::begin_, Packet<any_hit>::end_, Packet<any_hit>::hits_;
  using Node = std::remove_cvref_t<decltype(Nodes().nodes[0])>;
  static constexpr int W = Node::width;

 public:
  WidePacket(const SceneBvh& bvh, const Nodes& tlas) : bvh_(bvh), tlas_(tlas) {}

  // At most packet_size rays; the hits of as many.
  void run(const Ray* rays, size_t count) {
    load(rays, count);
    if (alive() == 0) return;
    if (!prepare(world_)) return run_single(rays, count);
    if (tlas_.entries.size() == 1) {
      visit_instance(tlas_.entries[0].instance, all_lanes);
      return;
    }
    walk(tlas_, world_, all_lanes, 0, [&](uint32_t first, uint32_t lanes) HWY_ATTR {
      for (const WideEntry* entry = tlas_.entries.data() + first;; ++entry) {
        visit_instance(entry->instance & ~more_bit, lanes);
        if ((entry->instance & more_bit) == 0) return;
      }
    });
  }

 private:
  void run_single(const Ray* rays, size_t count) {
    NoProbe probe;
    for (size_t lane = 0; lane < count; ++lane)
      hits_[lane] = traverse_wide<any_hit, Nodes>(bvh_, rays[lane], probe);
  }

  struct alignas(64) Waiting {
    PacketFloats entry;  // of rays that do not enter: NaN
    WideChild child;
  };

  // leaf(first block or entry, lanes that enter it).
  template <class Leaf>
  HWY_INLINE void walk(const Nodes& tree, const PacketRays& rays, uint32_t lanes, uint32_t instance,
                       const Leaf& leaf) {
    const PacketLanes d;
    constexpr size_t capacity = (W - 1) * (max_tree_depth + 1) + 1;
    const PacketBounds bounds = bounds_of(rays);
    std::array<Waiting, capacity> stack;
    size_t waiting = 0;
    WideChild child = 0;
    while (true) {
      if (is_leaf(child)) {
        leaf(child & ~leaf_bit, lanes);
      } else if (&tree != &tlas_ && std::popcount(lanes) <= few_rays) {
        for (; lanes != 0; lanes &= lanes - 1)
          go_alone(tree, rays, std::countr_zero(lanes), child, instance);
      } else {
        open(tree.nodes[child], rays, bounds, stack.data(), waiting);
      }
      while (true) {
        if (waiting == 0) return;
        const Waiting& next = stack[--waiting];
        lanes =
            packet_bits(hn::Le(next.entry.get(), hn::Mul(end_.get(), hn::Set(d, exit_padding))));
        if (lanes == 0) continue;
        child = next.child;
        break;
      }
    }
  }

  // Pushes the children that rays enter, the nearest one last.
  HWY_INLINE void open(const Node& node, const PacketRays& rays, const PacketBounds& bounds,
                       Waiting* stack, size_t& waiting) {
    const PacketLanes d;
    alignas(64) float decoded[6][W];
    const float(*planes)[W] = planes_in(node, decoded);
    const float end = hn::GetLane(hn::MaxOfLanes(d, end_.get())) * exit_padding;
    alignas(64) float bound[W];
    uint32_t hits = cull_children<W>(planes, rays, bounds, end, bound) & planes_of(node).slots();
    int order[W];
    int count = 0;
    for (; hits != 0; hits &= hits - 1) {
      const int slot = std::countr_zero(hits);
      int place = count++;
      for (; !any_hit && place > 0 && bound[order[place - 1]] < bound[slot]; --place)
        order[place] = order[place - 1];
      order[place] = slot;
    }
    const PacketVector last = hn::Mul(end_.get(), hn::Set(d, exit_padding));
    for (int i = 0; i < count; ++i) {
      const int slot = order[i];
      const PacketSpan span =
          span_of([&](int axis, uint32_t high) { return planes[2 * axis + high][slot]; }, rays,
                  begin_.get(), last);
      if (packet_bits(span.inside) == 0) continue;
      Waiting& next = stack[waiting++];
      next.entry.set(hn::IfThenElse(span.inside, span.entry, hn::NaN(d)));
      next.child = node.child[slot];
    }
  }

  template <int Width>
  static const float (*planes_in(const WideNode<Width>& node, float (*)[Width]))[Width] {
    return node.planes;
  }
  static HWY_INLINE const float (*planes_in(const QuantisedNode& node, float (*decoded)[8]))[8] {
    const SlotLanes<8> d;
    for (uint32_t plane = 0; plane < 6; ++plane) {
      for (size_t slot = 0; slot < 8; slot += hn::Lanes(d))
        hn::Store(planes_of(node).load(d, plane, slot), d, decoded[plane] + slot);
    }
    return decoded;
  }

  HWY_INLINE void visit_instance(uint32_t id, uint32_t lanes) {
    const PlacedInstance& instance = bvh_.instances[id];
    const Nodes& tree = std::get<Nodes>(bvh_.blases[instance.mesh]->wide);
    const auto visit = [&](const PacketRays& rays) HWY_ATTR {
      walk(tree, rays, lanes, id, [&](uint32_t first, uint32_t entered) HWY_ATTR {
        visit_blocks(tree.blocks.data() + first, rays, id, entered);
      });
    };
    if (instance.in_place) return visit(world_);
    if (transform(instance.to_object)) return visit(local_);
    for (; lanes != 0; lanes &= lanes - 1)
      go_alone(tree, local_, std::countr_zero(lanes), 0, id);
  }

  // One ray on its own from a node of a BLAS on.
  HWY_NOINLINE void go_alone(const Nodes& tree, const PacketRays& rays, int lane, WideChild child,
                             uint32_t id) {
    NoProbe probe;
    const Ray unused;
    const vec3 origin = origin_of(rays, lane);
    const vec3 direction = direction_of(rays, lane);
    WideTraversal<any_hit, Nodes, NoProbe> single{
        bvh_, unused, probe, begin_.lane[lane], end_.lane[lane], hits_[lane]};
    single.visit_tree(id, tree, origin, direction, box_ray(origin, direction), child);
    hits_[lane] = single.hit;
    end_.lane[lane] = any_hit && is_hit(single.hit) ? -infinity : single.t_max;
  }

  HWY_INLINE void visit_blocks(const TriangleBlock* block, const PacketRays& rays, uint32_t id,
                               uint32_t lanes) {
    while (true) {
      const bool more = (block->triangle[0] & more_bit) != 0;
      for (int of = 0; of < block_size; ++of) {
        const uint32_t triangle = block->triangle[of] & ~more_bit;
        if (of > 0 && triangle == (block->triangle[of - 1] & ~more_bit)) continue;
        visit_triangle([&](int axis, int k) { return block->corner[axis][k][of]; }, triangle, rays,
                       id, lanes);
      }
      if (!more) return;
      ++block;
    }
  }

  const SceneBvh& bvh_;
  const Nodes& tlas_;
};

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
