// Packets in the wide layouts. With probes every ray is kept to its own way: a vector test of each
// child by all rays (wide_group-inl.h has them without probes). Few rays that are left go on by
// themselves (C. Benthin et al., Combining Single and Packet-Ray Tracing for Arbitrary Ray
// Distributions on the Intel MIC Architecture, 2012). Compiled once for each instruction set.
#if defined(TRACER_BVH_WIDE_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRACER_BVH_WIDE_PACKET_INL_H_
#undef TRACER_BVH_WIDE_PACKET_INL_H_
#else
#define TRACER_BVH_WIDE_PACKET_INL_H_
#endif

#include "tracer/bvh/packet_bounds-inl.h"
#include "tracer/bvh/packet_probe-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

template <bool any_hit, class Nodes, Tests tests>
class WideGroup;

// One packet in a scene, however it goes.
template <bool any_hit, class Nodes, class Probe, Tests tests = Tests::watertight>
class WidePacket : public Packet<any_hit, tests, !any_hit || watches<Probe>> {
  using Base = Packet<any_hit, tests, !any_hit || watches<Probe>>;
  friend class WideGroup<any_hit, Nodes, tests>;

 public:
  explicit WidePacket(const SceneBvh& bvh) : bvh_(bvh), tlas_(std::get_if<Nodes>(&bvh.wide_tlas)) {}

 protected:
  using Base::load, Base::alive, Base::transform, Base::last, Base::visit_triangle;
  using Base::world_, Base::local_, Base::begin_, Base::end_, Base::hit_of, Base::settle;

  // The lanes that go on together; rays that cannot, as they differ in the planes that they enter
  // boxes by, are traced.
  HWY_INLINE uint32_t begin(std::span<const Ray> rays, PacketProbe<Probe>& probe) {
    load(rays);
    const uint32_t lanes = alive();
    if (lanes == 0 || tlas_ == nullptr) return 0;
    if (prepare<tests>(world_)) return lanes;
    trace_alone(rays, probe);
    return 0;
  }
  HWY_NOINLINE void trace_alone(std::span<const Ray> rays, PacketProbe<Probe>& probe) {
    for (size_t lane = 0; lane < rays.size(); ++lane)
      settle(int(lane), traverse_wide<any_hit, Nodes, tests>(bvh_, rays[lane], probe.of(int(lane))),
             end_.lane[lane]);
  }

  // Whether the rays are in the space of an instance now, where those of `lanes` go together. Else
  // they are through with it.
  HWY_INLINE bool enter(const WideEntry& entry, const Nodes& tree, uint32_t lanes,
                        PacketProbe<Probe>& probe) {
    const uint32_t id = entry.instance & ~more_bit;
    const PlacedInstance& instance = bvh_.instances[id];
    if (std::popcount(lanes) > few_rays && transform(instance.to_object)) return true;
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      go_alone(tree, lone_ray(world_, lane, instance.to_object), lane, entry.at, id,
               probe.of(lane));
    }
    return false;
  }

  // One ray on its own from a node of a BLAS on.
  HWY_NOINLINE void go_alone(const Nodes& tree, const LoneRay& ray, int lane,
                             const EntryPoint& from, uint32_t id, Probe& probe) {
    const Ray unused;
    WideTraversal<any_hit, Nodes, Probe, tests> single{
        bvh_, unused, probe, begin_.lane[lane], end_.lane[lane], hit_of(lane)};
    single.visit_tree(id, tree, ray.origin, ray.direction, from);
    settle(lane, single.hit, single.t_max);
  }

  HWY_INLINE void visit_blocks(const TriangleBlock* block, const PacketRays& rays, uint32_t id,
                               uint32_t lanes, PacketProbe<Probe>& probe) {
    while (true) {
      const bool more = (block->triangle[0] & more_bit) != 0;
      for (int of = 0; of < block_size; ++of) {
        const uint32_t triangle = block->triangle[of] & ~more_bit;
        if (of > 0 && triangle == (block->triangle[of - 1] & ~more_bit)) continue;
        probe.triangle(lanes);
        visit_triangle([&](int axis, int k) { return block->corner[axis][k][of]; }, triangle, rays,
                       id, lanes);
        if (any_hit && (lanes &= alive()) == 0) return;
      }
      if (!more) return;
      ++block;
    }
  }

  const SceneBvh& bvh_;
  const Nodes* tlas_;  // none over an empty scene
};

// A packet with probes.
template <bool any_hit, class Nodes, class Probe>
class WatchedPacket : public WidePacket<any_hit, Nodes, Probe> {
  static constexpr Tests tests = Tests::watertight;
  using Base = WidePacket<any_hit, Nodes, Probe>;
  using Base::alive, Base::last, Base::world_, Base::local_, Base::begin_, Base::end_;
  using Base::bvh_, Base::tlas_, Base::begin, Base::enter, Base::go_alone, Base::visit_blocks;
  using Node = std::remove_cvref_t<decltype(Nodes().nodes[0])>;
  static constexpr int W = Node::width;

 public:
  using Base::Base;

  // At most packet_size rays, one probe a ray; what they hit is the answer.
  void run(std::span<const Ray> rays, std::span<Probe> probes) {
    PacketProbe<Probe> probe(probes);
    const uint32_t lanes = begin(rays, probe);
    if (lanes == 0) return;
    const auto visit_leaf = [&](uint32_t first, uint32_t entered) HWY_ATTR {
      for (const WideEntry* entry = tlas_->entries.data() + first; entered != 0; ++entry) {
        visit_instance(*entry, entered, probe);
        if ((entry->instance & more_bit) == 0) return;
        if (any_hit) entered &= alive();
      }
    };
    walk(*tlas_, {}, world_, lanes, probe, visit_leaf, nullptr);
  }

 private:
  HWY_INLINE void visit_instance(const WideEntry& entry, uint32_t lanes,
                                 PacketProbe<Probe>& probe) {
    const uint32_t id = entry.instance & ~more_bit;
    const PlacedInstance& instance = bvh_.instances[id];
    const Nodes& tree = std::get<Nodes>(bvh_.blases[instance.mesh]->wide);
    probe.enter_instance(id, instance.mesh, entry.at, lanes);
    if (instance.in_place || enter(entry, tree, lanes, probe)) {
      const PacketRays& rays = instance.in_place ? world_ : local_;
      walk(
          tree, entry.at, rays, lanes, probe,
          [&](uint32_t first, uint32_t entered)
              HWY_ATTR { visit_blocks(tree.blocks.data() + first, rays, id, entered, probe); },
          [&](int lane, const EntryPoint& from) {
            go_alone(tree, lone_ray(rays, lane), lane, from, id, probe.of(lane));
          });
    }
    probe.leave_instance(lanes);
  }

  // A child of a node, or the node itself: `again`, for rays that want its children in another
  // order.
  static constexpr uint32_t again = none;
  struct alignas(64) Waiting {
    PacketFloats entry;  // of rays that do not enter: NaN
    WideChild child;
    uint32_t id;  // of the canonical tree
  };

  // Every ray in its own order, so that probes see of it what they would see of it alone.
  // leaf(first block or entry, lanes that enter it). alone(lane, from) takes one ray on from a
  // node; none: all stay together.
  template <class Leaf, class Alone>
  HWY_INLINE void walk(const Nodes& tree, const EntryPoint& from, const PacketRays& rays,
                       uint32_t lanes, PacketProbe<Probe>& probe, const Leaf& leaf,
                       const Alone& alone) {
    constexpr bool may_go_alone = !std::is_null_pointer_v<Alone>;
    constexpr size_t capacity = W * (max_tree_depth + 1) + 1;
    const PacketBounds bounds =
        bounds_of<tests, 1>([&](size_t) -> const PacketRays& { return rays; });
    std::array<Waiting, capacity> stack;
    size_t waiting = 0;
    WideChild child = from.child;
    uint32_t id = from.node;
    while (true) {
      const bool are_few = may_go_alone && id != again && std::popcount(lanes) <= few_rays;
      if (is_leaf(child)) {
        probe.enter(id, true, lanes);
        leaf(child & ~leaf_bit, lanes);
      } else if (are_few) {
        if constexpr (may_go_alone)
          for (; lanes != 0; lanes &= lanes - 1)
            alone(std::countr_zero(lanes), EntryPoint{id, child});
      } else {
        const Node& node = tree.nodes[child];
        if (id != again && is_canonical(node)) probe.enter(id, false, lanes);
        open(tree, child, rays, bounds, lanes, stack.data(), waiting);
      }
      do {
        if (waiting == 0) return;
        const Waiting& next = stack[--waiting];
        lanes = packet_bits(hn::Le(next.entry.get(), last()));
        child = next.child;
        id = next.id;
      } while (lanes == 0);
    }
  }

  // Pushes the children that rays enter in the order of the first ray, the nearest one last. Those
  // that want another order wait for the node once more, beneath.
  HWY_INLINE void open(const Nodes& tree, uint32_t index, const PacketRays& rays,
                       const PacketBounds& bounds, uint32_t lanes, Waiting* stack,
                       size_t& waiting) {
    const PacketLanes d;
    const Node& node = tree.nodes[index];
    alignas(64) float decoded[6][W];
    const float(*planes)[W] = planes_in(node, decoded);
    const float end = hn::GetLane(hn::MaxOfLanes(d, end_.get())) * end_padding<tests>;
    alignas(64) float bound[W];
    uint32_t hits =
        cull_children<tests, W>(planes, rays, bounds, end, bound) & planes_of(node).slots();
    const PacketVector end_of_each = last();
    PacketFloats entries[W];
    uint32_t entered[W];
    int order[W];
    int count = 0;
    const int first = std::countr_zero(lanes);
    for (; hits != 0; hits &= hits - 1) {
      const int slot = std::countr_zero(hits);
      const PacketSpan span =
          span_of<tests>([&](int axis, uint32_t high) { return planes[2 * axis + high][slot]; },
                         rays, begin_.get(), end_of_each);
      entered[slot] = packet_bits(span.inside) & lanes;
      if (entered[slot] == 0) continue;
      prefetch(tree, node.child[slot]);
      entries[slot].set(span.entry);
      int place = count++;
      const float entry = entries[slot].lane[first];
      for (; !any_hit && place > 0 && entries[order[place - 1]].lane[first] <= entry; --place)
        order[place] = order[place - 1];
      order[place] = slot;
    }
    uint32_t others = 0;
    if constexpr (!any_hit) {
      for (int near = 1; near < count; ++near)
        for (int far = 0; far < near; ++far)
          others |= disagreeing(entries, entered, order[near], order[far]);
      if (others != 0) push(stack[waiting++], hn::Zero(d), others, index, again);
    }
    for (int i = 0; i < count; ++i) {
      const int slot = order[i];
      push(stack[waiting++], entries[slot].get(), entered[slot] & ~others, node.child[slot],
           node.binary[slot]);
    }
  }

  static HWY_INLINE void push(Waiting& place, PacketVector entry, uint32_t lanes, WideChild child,
                              uint32_t id) {
    place.entry.set(hn::IfThenElse(lane_mask(lanes), entry, hn::NaN(PacketLanes())));
    place.child = child;
    place.id = id;
  }

  // The rays that enter `far` before `near`, as walk_wide orders them.
  static HWY_INLINE uint32_t disagreeing(const PacketFloats* entries, const uint32_t* entered,
                                         int near, int far) {
    const uint32_t both = entered[near] & entered[far];
    if (both == 0) return 0;
    const PacketVector a = entries[near].get();
    const PacketVector b = entries[far].get();
    return both & packet_bits(near < far ? hn::Lt(b, a) : hn::Le(b, a));
  }
};

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
