// Packets in the binary layout: the rays go down the tree together, each in its own order. Where
// two of them want the children of a node in different orders, those of one order come first, then
// the others; so every ray enters the nodes that it would enter alone, and a probe may count them.
// Few rays that are left go on by themselves (C. Benthin et al., Combining Single and Packet-Ray
// Tracing for Arbitrary Ray Distributions on the Intel MIC Architecture, 2012).
// Compiled once for each instruction set.
#if defined(TRACER_BVH_BINARY_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRACER_BVH_BINARY_PACKET_INL_H_
#undef TRACER_BVH_BINARY_PACKET_INL_H_
#else
#define TRACER_BVH_BINARY_PACKET_INL_H_
#endif

#include "tracer/bvh/packet_probe-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

// One packet on its way through a scene.
template <bool any_hit, class Probe, Tests tests = Tests::watertight>
class BinaryPacket : public Packet<any_hit, tests, !any_hit || watches<Probe>> {
  using Base = Packet<any_hit, tests, !any_hit || watches<Probe>>;
  using Base::load, Base::alive, Base::transform, Base::last, Base::visit_triangle;
  using Base::world_, Base::local_, Base::begin_, Base::end_, Base::hit_of, Base::settle;

 public:
  explicit BinaryPacket(const SceneBvh& bvh) : bvh_(bvh) {}

  // At most packet_size rays; what they hit is the answer. One probe a ray, none for NoProbe.
  void run(std::span<const Ray> rays, std::span<Probe> probes) {
    load(rays);
    const uint32_t lanes = alive();
    if (lanes == 0 || bvh_.tlas.nodes.empty()) return;
    PacketProbe<Probe> probe(probes);
    if (!prepare<tests>(world_)) {
      for (size_t lane = 0; lane < rays.size(); ++lane)
        settle(int(lane), traverse<any_hit, tests>(bvh_, rays[lane], probe.of(int(lane))),
               end_.lane[lane]);
      return;
    }
    const auto visit_leaf = [&](const BvhNode& leaf, uint32_t entered) HWY_ATTR {
      for (uint32_t i = leaf.first; i < leaf.first + leaf.count && entered != 0; ++i) {
        visit_instance(i, entered, probe);
        if (any_hit) entered &= alive();
      }
    };
    walk(bvh_.tlas, 0, world_, lanes, probe, visit_leaf, nullptr);
  }

 private:
  struct alignas(64) Waiting {
    PacketFloats entry;  // of rays that do not enter: NaN
    uint32_t node;
  };

  // From before a node on. leaf(node, lanes that enter it). alone(lane, node) takes one ray on from
  // a node; none: all stay together.
  template <class Leaf, class Alone>
  HWY_INLINE void walk(const Bvh& tree, uint32_t index, const PacketRays& rays, uint32_t lanes,
                       PacketProbe<Probe>& probe, const Leaf& leaf, const Alone& alone) {
    const PacketLanes d;
    constexpr bool may_go_alone = !std::is_null_pointer_v<Alone>;
    assert(tree.depth <= max_tree_depth);
    // A node leaves at most three behind: the far child of one order, and both of the other.
    std::array<Waiting, 3 * max_tree_depth> stack;
    size_t waiting = 0;
    const BvhNode* nodes = tree.nodes.data();
    const auto span = [&](const BvhNode& node) HWY_ATTR {
      const vec3* const planes[2] = {&node.lo, &node.hi};
      return span_of<tests>([&](int axis, uint32_t high) { return (*planes[high])[axis]; }, rays,
                            begin_.get(), last());
    };
    const auto wait = [&](uint32_t node, const PacketSpan& in, uint32_t who) HWY_ATTR {
      Waiting& next = stack[waiting++];
      next.entry.set(hn::IfThenElse(lane_mask(who), in.entry, hn::NaN(d)));
      next.node = node;
    };
    lanes &= packet_bits(span(nodes[index]).inside);
    if (lanes == 0) return;
    while (true) {
      const BvhNode& node = nodes[index];
      const bool are_few = may_go_alone && std::popcount(lanes) <= few_rays;
      if (are_few) {
        if constexpr (may_go_alone)
          for (; lanes != 0; lanes &= lanes - 1)
            alone(std::countr_zero(lanes), index);
      } else if (is_leaf(node)) {
        probe.enter(index, true, lanes);
        leaf(node, lanes);
      } else {
        probe.enter(index, false, lanes);
        const PacketSpan left = span(nodes[node.first]);
        const PacketSpan right = span(nodes[node.first + 1]);
        const uint32_t in_left = packet_bits(left.inside) & lanes;
        const uint32_t in_right = packet_bits(right.inside) & lanes;
        const uint32_t left_first =
            packet_bits(hn::Le(left.entry, right.entry)) & in_left & in_right;
        const uint32_t right_first = in_left & in_right & ~left_first;
        if (left_first != 0 && right_first != 0) {
          wait(node.first, left, right_first);
          wait(node.first + 1, right, right_first);
          wait(node.first + 1, right, in_right & ~right_first);
          lanes = in_left & ~right_first;
          index = node.first;
          continue;
        }
        if (right_first == 0 && in_left != 0) {
          if (in_right != 0) wait(node.first + 1, right, in_right);
          lanes = in_left;
          index = node.first;
          continue;
        }
        if (in_right != 0) {
          if (in_left != 0) wait(node.first, left, in_left);
          lanes = in_right;
          index = node.first + 1;
          continue;
        }
      }
      do {
        if (waiting == 0) return;
        const Waiting& next = stack[--waiting];
        lanes = packet_bits(hn::Le(next.entry.get(), last()));
        index = next.node;
      } while (lanes == 0);
    }
  }

  HWY_INLINE void visit_instance(uint32_t place, uint32_t lanes, PacketProbe<Probe>& probe) {
    const uint32_t id = bvh_.tlas.references[place];
    const EntryPoint entry = entry_at(bvh_, place);
    const PlacedInstance& instance = bvh_.instances[id];
    const Blas& blas = *bvh_.blases[instance.mesh];
    probe.enter_instance(id, instance.mesh, entry, lanes);
    const auto visit = [&](const PacketRays& rays) HWY_ATTR {
      const auto visit_leaf = [&](const BvhNode& leaf, uint32_t entered) HWY_ATTR {
        for (uint32_t i = leaf.first; i < leaf.first + leaf.count && entered != 0; ++i) {
          const LeafTriangle& triangle = blas.triangles[i];
          probe.triangle(entered);
          visit_triangle([&](int axis, int k) { return (&triangle.x)[axis][k]; },
                         blas.tree.references[i], rays, id, entered);
          if (any_hit) entered &= alive();
        }
      };
      walk(blas.tree, entry.node, rays, lanes, probe, visit_leaf, [&](int lane, uint32_t node) {
        go_alone(blas, lone_ray(rays, lane), lane, node, true, id, probe.of(lane));
      });
    };
    if (instance.in_place) {
      visit(world_);
    } else if (std::popcount(lanes) > few_rays && transform(instance.to_object)) {
      visit(local_);
    } else {
      for (uint32_t left = lanes; left != 0; left &= left - 1) {
        const int lane = std::countr_zero(left);
        go_alone(blas, lone_ray(world_, lane, instance.to_object), lane, entry.node, false, id,
                 probe.of(lane));
      }
    }
    probe.leave_instance(lanes);
  }

  // One ray on its own, from before a node of a BLAS on, or from inside of it.
  HWY_NOINLINE void go_alone(const Blas& blas, const LoneRay& ray, int lane, uint32_t node,
                             bool inside, uint32_t id, Probe& probe) {
    BinaryTraversal<any_hit, Probe, tests> single{bvh_, probe, begin_.lane[lane], end_.lane[lane],
                                                  hit_of(lane)};
    single.visit_tree(id, blas, ray.origin, ray.direction,
                      box_ray<tests>(ray.origin, ray.direction), node, inside);
    settle(lane, single.hit, single.t_max);
  }

  const SceneBvh& bvh_;
};

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
