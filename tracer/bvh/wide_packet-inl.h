// Packets in the wide layouts: the rays go down the tree together. An interval that holds all of
// them culls the children of a node at once (S. Boulos et al., Packet-based Whitted and
// Distribution Ray Tracing, 2007). Without probes that decides the way, and which rays enter is
// asked seldom; with probes a vector test of each child by all rays keeps every ray to its own way.
// Few rays that are left go on by themselves (C. Benthin et al., Combining Single and Packet-Ray
// Tracing for Arbitrary Ray Distributions on the Intel MIC Architecture, 2012). Compiled once for
// each instruction set.
#if defined(TRACER_BVH_WIDE_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRACER_BVH_WIDE_PACKET_INL_H_
#undef TRACER_BVH_WIDE_PACKET_INL_H_
#else
#define TRACER_BVH_WIDE_PACKET_INL_H_
#endif

#include <utility>

#include "tracer/bvh/packet_probe-inl.h"
#include "tracer/math/columns.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

// The intervals that hold all rays: of the origins as the near and far planes are seen from there,
// and of the reciprocals of the directions.
struct PacketBounds {
  float near_origin[3], far_origin[3], least[3], most[3];
};
template <Tests tests>
HWY_INLINE PacketBounds bounds_of(const PacketRays& rays) {
  const PacketLanes d;
  PacketBounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const bool backwards = (rays.near[axis] & 1) != 0;
    const bool fast = tests == Tests::fast;
    const PacketVector near = fast ? rays.origin[axis].get() : rays.from_near[axis].get();
    const PacketVector far = fast ? near : rays.from_far[axis].get();
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

// What holds some rays: their origins with t_min, and their directions with t_max.
struct RayIntervals {
  float4 least_from = broadcast(infinity), most_from = -broadcast(infinity);
  float4 least_way = broadcast(infinity), most_way = -broadcast(infinity);
};
HWY_INLINE RayIntervals intervals_of(std::span<const Ray> rays) {
  RayIntervals of;
  for (const Ray& ray : rays) {
    const float4 from = load4(&ray.origin.x), way = load4(&ray.direction.x);
    of.least_from = min(from, of.least_from);
    of.most_from = max(from, of.most_from);
    of.least_way = min(way, of.least_way);
    of.most_way = max(way, of.most_way);
  }
  return of;
}
// The same in the space of an instance; t stays. Summed as Packet::transform does: as rounding is
// monotonic, the rays that it makes lie within.
HWY_INLINE RayIntervals transformed(const RayIntervals& of, const mat4& to_object) {
  const Columns m = columns(to_object);
  const auto times = [](float4 column, float4 least, float4 most) {
    const float4 a = column * least, b = column * most;
    return std::pair(min(a, b), max(a, b));
  };
  const auto turned = [&](float4 least, float4 most, float4 w) {
    const auto [least_x, most_x] = times(m.x, spread<0>(least), spread<0>(most));
    const auto [least_y, most_y] = times(m.y, spread<1>(least), spread<1>(most));
    const auto [least_z, most_z] = times(m.z, spread<2>(least), spread<2>(most));
    return std::pair((least_x + least_y) + (least_z + w), (most_x + most_y) + (most_z + w));
  };
  const auto [least_from, most_from] = turned(of.least_from, of.most_from, m.w);
  const auto [least_way, most_way] = turned(of.least_way, of.most_way, float4{});
  return {least_from, most_from, least_way, most_way};
}

// Of rays that are no packet.
struct RayGroup {
  uint32_t near[3], far[3];  // planes
  PacketBounds bounds;
};
// An axis along which the rays differ in their signs, are too short or not finite tells nothing of
// them. False: all three.
HWY_INLINE bool make_group(const RayIntervals& of, RayGroup& group) {
  bool tells = false;
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const float least = of.least_way[axis], most = of.most_way[axis];
    const bool backwards = most < 0.0f;
    const float shortest = backwards ? -most : least;
    const float nearest = backwards ? of.least_from[axis] : of.most_from[axis];
    const float farthest = backwards ? of.most_from[axis] : of.least_from[axis];
    const bool are_finite = std::isfinite((most - least) + (nearest - farthest));
    const bool is_known = are_finite && shortest >= least_component;
    group.near[axis] = 2 * axis + uint32_t(backwards);
    group.far[axis] = 2 * axis + uint32_t(!backwards);
    group.bounds.near_origin[axis] = is_known ? nearest : infinity;
    group.bounds.far_origin[axis] = is_known ? farthest : -infinity;
    group.bounds.least[axis] = is_known ? 1.0f / most : 1.0f;
    group.bounds.most[axis] = is_known ? 1.0f / least : 1.0f;
    tells |= is_known;
  }
  return tells;
}

// The children that any of the rays may enter, each with a lower bound of where.
template <Tests tests, int W, class Rays>
HWY_INLINE uint32_t cull_children(const float (*planes)[W], const Rays& rays,
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
      auto far =
          hn::Sub(hn::Load(d, planes[rays.far[axis]] + slot), hn::Set(d, bounds.far_origin[axis]));
      if constexpr (tests == Tests::watertight)
        far = hn::Mul(far, hn::Set(d, exit_padding * exit_padding));
      entry = hn::Max(entry, hn::Min(hn::Mul(near, least), hn::Mul(near, most)));
      exit = hn::Min(exit, hn::Max(hn::Mul(far, least), hn::Mul(far, most)));
    }
    hits |= bits_of(d, hn::Le(entry, exit)) << slot;
    hn::Store(entry, d, entry_bound + slot);
  }
  return hits;
}

// One packet on its way through a scene.
template <bool any_hit, class Nodes, class Probe, Tests tests = Tests::watertight>
class WidePacket : public Packet<any_hit, tests, !any_hit || watches<Probe>> {
  using Base = Packet<any_hit, tests, !any_hit || watches<Probe>>;
  using Base::load, Base::alive, Base::transform, Base::last, Base::visit_triangle;
  using Base::world_, Base::local_, Base::begin_, Base::end_, Base::hit_of, Base::settle;
  using Node = std::remove_cvref_t<decltype(Nodes().nodes[0])>;
  static constexpr int W = Node::width;
  static constexpr bool asks = !any_hit && !watches<Probe>;

 public:
  explicit WidePacket(const SceneBvh& bvh) : bvh_(bvh), tlas_(std::get_if<Nodes>(&bvh.wide_tlas)) {}

  // At most packet_size rays; what they hit is the answer. One probe a ray, none for NoProbe.
  void run(std::span<const Ray> rays, std::span<Probe> probes) {
    load(rays);
    const uint32_t lanes = alive();
    if (lanes == 0 || tlas_ == nullptr) return;
    PacketProbe<Probe> probe(probes);
    if (!prepare<tests>(world_)) {
      for (size_t lane = 0; lane < rays.size(); ++lane)
        settle(int(lane),
               traverse_wide<any_hit, Nodes, tests>(bvh_, rays[lane], probe.of(int(lane))),
               end_.lane[lane]);
      return;
    }
    if (!watches<Probe> && tlas_->entries.size() == 1) {
      visit_instance(tlas_->entries[0], lanes, probe);
      return;
    }
    const auto visit_leaf = [&](uint32_t first, uint32_t entered) HWY_ATTR {
      for (const WideEntry* entry = tlas_->entries.data() + first; entered != 0; ++entry) {
        visit_instance(*entry, entered, probe);
        if ((entry->instance & more_bit) == 0) return;
        if (any_hit) entered &= alive();
      }
    };
    walk(*tlas_, {}, world_, lanes, probe, visit_leaf, nullptr);
  }

  // Whether triangles were met since this was asked last.
  bool take_met() requires(asks) { return std::exchange(has_met_, false); }

  // False if none of these rays comes to a leaf of an instance.
  HWY_NOINLINE bool may_meet(std::span<const Ray> rays) const requires(asks) {
    const RayIntervals in_world = intervals_of(rays);
    RayGroup group;
    if (tlas_ == nullptr || !make_group(in_world, group)) return true;
    const float end = in_world.most_way[3] * end_padding<tests>;
    const auto may_meet_instance = [&](const WideEntry& entry) HWY_ATTR {
      const PlacedInstance& instance = bvh_.instances[entry.instance & ~more_bit];
      const WideChild root = entry.at.child;
      if (is_leaf(root)) return true;
      const Nodes& tree = std::get<Nodes>(bvh_.blases[instance.mesh]->wide);
      const auto stop = [](WideChild) { return true; };
      if (instance.in_place) return comes_to_leaf(tree, root, group, end, stop);
      RayGroup local;
      return !make_group(transformed(in_world, instance.to_object), local) ||
             comes_to_leaf(tree, root, local, end, stop);
    };
    if (tlas_->entries.size() == 1) return may_meet_instance(tlas_->entries[0]);
    return comes_to_leaf(*tlas_, 0, group, end, [&](WideChild leaf) HWY_ATTR {
      const WideEntry* entry = &tlas_->entries[leaf & ~leaf_bit];
      while (true) {
        if (may_meet_instance(*entry)) return true;
        if ((entry->instance & more_bit) == 0) return false;
        ++entry;
      }
    });
  }

 private:
  static constexpr size_t capacity = (W - 1) * (max_tree_depth + 1) + 1;
  // Whether a group comes to a leaf beneath a node that accept(leaf) takes.
  template <class Accept>
  static HWY_INLINE bool comes_to_leaf(const Nodes& tree, WideChild root, const RayGroup& group,
                                       float end, const Accept& accept) {
    std::array<WideChild, capacity> stack;
    stack[0] = root;
    for (size_t waiting = 1; waiting > 0;) {
      const Node& node = tree.nodes[stack[--waiting]];
      alignas(64) float decoded[6][W];
      alignas(64) float bound[W];
      uint32_t hits =
          cull_children<tests, W>(planes_in(node, decoded), group, group.bounds, end, bound) &
          planes_of(node).slots();
      for (; hits != 0; hits &= hits - 1) {
        const WideChild child = node.child[std::countr_zero(hits)];
        if (!is_leaf(child)) {
          stack[waiting++] = child;
        } else if (accept(child)) {
          return true;
        }
      }
    }
    return false;
  }

  // A child of a node, or the node itself: `again`, for rays that want its children in another
  // order.
  static constexpr uint32_t again = none;
  struct alignas(64) Waiting {
    PacketFloats entry;  // of rays that do not enter: NaN
    WideChild child;
    uint32_t id;  // of the canonical tree
  };

  // leaf(first block or entry, lanes that enter it). alone(lane, child, id) takes one ray on from a
  // node; none: all stay together.
  template <class Leaf, class Alone>
  HWY_INLINE void walk(const Nodes& tree, const EntryPoint& from, const PacketRays& rays,
                       uint32_t lanes, PacketProbe<Probe>& probe, const Leaf& leaf,
                       const Alone& alone) {
    if constexpr (watches<Probe>) {
      walk_in_order(tree, from, rays, lanes, probe, leaf, alone);
    } else if (is_leaf(from.child)) {
      leaf(from.child & ~leaf_bit, lanes);
    } else {
      walk_in_bounds(tree, from.child, rays, lanes, leaf, alone);
    }
  }

  // Nodes are opened for all rays at once, nearest first by what bounds them all. Which rays enter
  // is asked of leaves, and of what has waited.
  template <class Leaf, class Alone>
  HWY_INLINE void walk_in_bounds(const Nodes& tree, uint32_t index, const PacketRays& rays,
                                 uint32_t lanes, const Leaf& leaf, const Alone& alone) {
    constexpr bool may_go_alone = !std::is_null_pointer_v<Alone>;
    struct Far {
      float bound;
      uint32_t parent;
      int slot;
    };
    const PacketBounds bounds = bounds_of<tests>(rays);
    std::array<Far, capacity> stack;
    size_t waiting = 0;
    float end = end_of_all();
    const auto entering = [&](const Far& box) HWY_ATTR {
      const auto plane = [&](int axis, uint32_t high) HWY_ATTR {
        return plane_of(tree.nodes[box.parent], 2 * axis + high, box.slot);
      };
      return packet_bits(span_of<tests>(plane, rays, begin_.get(), last()).inside) & lanes;
    };
    while (true) {
      const Node& node = tree.nodes[index];
      alignas(64) float decoded[6][W];
      alignas(64) float bound[W];
      uint32_t hits = cull_children<tests, W>(planes_in(node, decoded), rays, bounds, end, bound) &
                      planes_of(node).slots();
      const size_t bottom = waiting;
      for (; hits != 0; hits &= hits - 1) {
        const int slot = std::countr_zero(hits);
        size_t place = waiting++;
        for (; !any_hit && place > bottom && stack[place - 1].bound < bound[slot]; --place)
          stack[place] = stack[place - 1];
        stack[place] = {bound[slot], index, slot};
        prefetch(tree, node.child[slot]);
      }
      bool descends = waiting > bottom;
      while (true) {
        if (waiting == 0) return;
        const Far& next = stack[--waiting];
        if (next.bound > end) continue;
        const WideChild child = tree.nodes[next.parent].child[next.slot];
        if (!is_leaf(child) && descends) {
          index = child;
          break;
        }
        descends = false;
        uint32_t entered = entering(next);
        if (entered == 0) continue;
        const bool are_few = may_go_alone && std::popcount(entered) <= few_rays;
        if (is_leaf(child)) {
          leaf(child & ~leaf_bit, entered);
          end = end_of_all();
        } else if (are_few) {
          if constexpr (may_go_alone)
            for (; entered != 0; entered &= entered - 1)
              alone(std::countr_zero(entered), child, 0);
          end = end_of_all();
        } else {
          index = child;
          break;
        }
      }
    }
  }

  HWY_INLINE float end_of_all() const {
    return hn::GetLane(hn::MaxOfLanes(PacketLanes(), end_.get())) * end_padding<tests>;
  }

  template <int Width>
  static float plane_of(const WideNode<Width>& node, uint32_t plane, int slot) {
    return node.planes[plane][slot];
  }
  static float plane_of(const QuantisedNode& node, uint32_t plane, int slot) {
    const float step = std::bit_cast<float>(uint32_t(node.exponent[plane / 2]) << 23);
    return node.origin[plane / 2] + float(node.planes[plane][slot]) * step;
  }

  // Every ray in its own order, so that probes see of it what they would see of it alone.
  template <class Leaf, class Alone>
  HWY_INLINE void walk_in_order(const Nodes& tree, const EntryPoint& from, const PacketRays& rays,
                                uint32_t lanes, PacketProbe<Probe>& probe, const Leaf& leaf,
                                const Alone& alone) {
    constexpr bool may_go_alone = !std::is_null_pointer_v<Alone>;
    constexpr size_t capacity = W * (max_tree_depth + 1) + 1;
    const PacketBounds bounds = bounds_of<tests>(rays);
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
            alone(std::countr_zero(lanes), child, id);
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
    const float end = end_of_all();
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

  HWY_INLINE void visit_instance(const WideEntry& entry, uint32_t lanes,
                                 PacketProbe<Probe>& probe) {
    const uint32_t id = entry.instance & ~more_bit;
    const PlacedInstance& instance = bvh_.instances[id];
    const Nodes& tree = std::get<Nodes>(bvh_.blases[instance.mesh]->wide);
    probe.enter_instance(id, instance.mesh, entry.at, lanes);
    const auto visit = [&](const PacketRays& rays) HWY_ATTR {
      walk(
          tree, entry.at, rays, lanes, probe,
          [&](uint32_t first, uint32_t entered)
              HWY_ATTR { visit_blocks(tree.blocks.data() + first, rays, id, entered, probe); },
          [&](int lane, WideChild child, uint32_t node) {
            go_alone(tree, lone_ray(rays, lane), lane, child, node, id, probe.of(lane));
          });
    };
    if (instance.in_place) {
      visit(world_);
    } else if (std::popcount(lanes) > few_rays && transform(instance.to_object)) {
      visit(local_);
    } else {
      for (uint32_t left = lanes; left != 0; left &= left - 1) {
        const int lane = std::countr_zero(left);
        go_alone(tree, lone_ray(world_, lane, instance.to_object), lane, entry.at.child,
                 entry.at.node, id, probe.of(lane));
      }
    }
    probe.leave_instance(lanes);
  }

  // One ray on its own from a node of a BLAS on.
  HWY_NOINLINE void go_alone(const Nodes& tree, const LoneRay& ray, int lane, WideChild child,
                             uint32_t node, uint32_t id, Probe& probe) {
    const Ray unused;
    WideTraversal<any_hit, Nodes, Probe, tests> single{
        bvh_, unused, probe, begin_.lane[lane], end_.lane[lane], hit_of(lane)};
    single.visit_tree(id, tree, ray.origin, ray.direction, {node, child});
    if constexpr (asks) has_met_ = true;
    settle(lane, single.hit, single.t_max);
  }

  HWY_INLINE void visit_blocks(const TriangleBlock* block, const PacketRays& rays, uint32_t id,
                               uint32_t lanes, PacketProbe<Probe>& probe) {
    if constexpr (asks) has_met_ = true;
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
  bool has_met_ = false;
};

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
