// Packets of neighbouring rays go down the wide tree as a group: a node is opened once for all of
// them (after A. Reshetov, A. Soupikov, J. Hurley, Multi-Level Ray Tracing Algorithm, 2005), by
// intervals that hold all rays. Which rays enter is asked seldom. A node that one packet alone
// enters is gone on from with intervals of its own, and few rays go on by themselves. Compiled once
// for each instruction set.
#if defined(TRACER_BVH_WIDE_GROUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRACER_BVH_WIDE_GROUP_INL_H_
#undef TRACER_BVH_WIDE_GROUP_INL_H_
#else
#define TRACER_BVH_WIDE_GROUP_INL_H_
#endif

#include <algorithm>
#include <array>
#include <utility>

#include "tracer/bvh/wide_packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

// On its way through a scene.
template <bool any_hit, class Nodes, Tests tests>
class WideGroup {
  using OnePacket = WidePacket<any_hit, Nodes, NoProbe, tests>;
  using Node = std::remove_cvref_t<decltype(Nodes().nodes[0])>;
  static constexpr int W = Node::width;
  static constexpr size_t count = std::min<size_t>(64 / packet_size, 8);  // packets

 public:
  static constexpr size_t size = count * packet_size;  // rays

  explicit WideGroup(const SceneBvh& bvh) : WideGroup(bvh, std::make_index_sequence<count>()) {}

  // At most `size` rays; what they hit is the answer.
  void run(std::span<const Ray> rays, std::span<NoProbe>) {
    if constexpr (!any_hit)  // as a rule shadow rays do come to triangles
      if (!met_ && !may_meet(rays)) return clear();
    met_ = false;
    Part<count> all{packets_.data(), {}};
    bool are_all = true;
    for (size_t i = 0; i < count; ++i) {
      const size_t first = std::min(i * packet_size, rays.size());
      const auto own = rays.subspan(first, std::min(packet_size, rays.size() - first));
      all.lanes[i] = own.empty() ? 0 : packets_[i].begin(own, no_probe_);
      are_all &= all.lanes[i] != 0;
    }
    if (are_all && agree<true>(all)) return visit_scene(all);
    for (size_t i = 0; i < count; ++i)
      if (all.lanes[i] != 0) visit_scene(only(packets_[i], all.lanes[i]));
  }

  // Of the first rays, in their order.
  HWY_INLINE void write_hits(std::span<Hit> to) const {
    write(to, [](const OnePacket& packet, auto own) HWY_ATTR { packet.write_hits(own); });
  }
  HWY_INLINE void write_blocked(std::span<uint8_t> to) const {
    write(to, [](const OnePacket& packet, auto own) HWY_ATTR { packet.write_blocked(own); });
  }

 private:
  static constexpr size_t capacity = (W - 1) * (max_tree_depth + 1) + 1;

  // Packets that go together, and which lanes of them do.
  template <size_t many>
  struct Part {
    OnePacket* packets;
    std::array<uint32_t, many> lanes;
    bool is_empty() const {
      return std::all_of(lanes.begin(), lanes.end(), [](uint32_t of) { return of == 0; });
    }
  };
  static Part<1> only(OnePacket& packet, uint32_t lanes) { return {&packet, {lanes}}; }

  template <size_t... I>
  WideGroup(const SceneBvh& bvh, std::index_sequence<I...>)
      : packets_{(void(I), OnePacket(bvh))...},
        bvh_(bvh),
        tlas_(std::get_if<Nodes>(&bvh.wide_tlas)) {}

  void clear() {
    for (OnePacket& packet : packets_)
      packet.clear();
  }

  // of_packet(packet, what is of its rays); the first ones are whole.
  template <class What, class Write>
  HWY_INLINE void write(std::span<What> to, const Write& of_packet) const {
    size_t i = 0;
    for (; to.size() >= packet_size; to = to.subspan(packet_size))
      of_packet(packets_[i++], to.template first<packet_size>());
    if (!to.empty()) of_packet(packets_[i], to);
  }

  template <bool in_world>
  static HWY_INLINE const PacketRays& rays_of(const OnePacket& packet) {
    return in_world ? packet.world_ : packet.local_;
  }

  // Whether all enter boxes by the same planes.
  template <bool in_world, size_t many>
  static HWY_INLINE bool agree(const Part<many>& part) {
    const uint32_t(&near)[3] = rays_of<in_world>(part.packets[0]).near;
    for (size_t i = 1; i < many; ++i) {
      const uint32_t(&other)[3] = rays_of<in_world>(part.packets[i]).near;
      if (!std::equal(near, near + 3, other)) return false;
    }
    return true;
  }

  template <size_t many>
  HWY_INLINE void visit_scene(const Part<many>& part) {
    if (tlas_->entries.size() == 1) return visit_instance(tlas_->entries[0], part);
    const auto visit_leaf = [&](uint32_t first, Part<many> entered) HWY_ATTR {
      for (const WideEntry* entry = tlas_->entries.data() + first; !entered.is_empty(); ++entry) {
        visit_instance(*entry, entered);
        if ((entry->instance & more_bit) == 0) return;
        if constexpr (any_hit)
          for (size_t i = 0; i < many; ++i)
            entered.lanes[i] &= part.packets[i].alive();
      }
    };
    walk<true>(*tlas_, 0, part, visit_leaf, nullptr);
  }

  template <size_t many>
  HWY_INLINE void visit_instance(const WideEntry& entry, Part<many> part) {
    const uint32_t id = entry.instance & ~more_bit;
    const PlacedInstance& instance = bvh_.instances[id];
    const Nodes& tree = std::get<Nodes>(bvh_.blases[instance.mesh]->wide);
    const WideChild root = entry.at.child;
    if (instance.in_place) return visit_tree<true>(tree, root, id, part);
    bool are_all = true;
    for (size_t i = 0; i < many; ++i) {
      uint32_t& lanes = part.lanes[i];
      if (!part.packets[i].enter(entry, tree, lanes, no_probe_)) lanes = 0;
      are_all &= lanes != 0;
    }
    if (are_all && agree<false>(part)) return visit_tree<false>(tree, root, id, part);
    for (size_t i = 0; i < many; ++i)
      if (part.lanes[i] != 0)
        visit_tree<false>(tree, root, id, only(part.packets[i], part.lanes[i]));
  }

  template <bool in_world, size_t many>
  HWY_NOINLINE void visit_tree(const Nodes& tree, WideChild from, uint32_t id,
                               const Part<many>& part) {
    OnePacket* const packets = part.packets;
    const auto visit_blocks = [&](uint32_t first, const Part<many>& entered) HWY_ATTR {
      met_ = true;
      for (size_t i = 0; i < many; ++i) {
        OnePacket& packet = packets[i];
        if (entered.lanes[i] != 0)
          packet.visit_blocks(tree.blocks.data() + first, rays_of<in_world>(packet), id,
                              entered.lanes[i], no_probe_);
      }
    };
    const auto leave = [&](OnePacket& packet, uint32_t entered, WideChild child) {
      if (std::popcount(entered) > few_rays)
        return visit_tree<in_world>(tree, child, id, only(packet, entered));
      met_ = true;
      for (; entered != 0; entered &= entered - 1) {
        const int lane = std::countr_zero(entered);
        packet.go_alone(tree, lone_ray(rays_of<in_world>(packet), lane), lane, {0, child}, id,
                        no_probe_.of(lane));
      }
    };
    if (is_leaf(from)) {
      visit_blocks(from & ~leaf_bit, part);
    } else {
      walk<in_world>(tree, from, part, visit_blocks, leave);
    }
  }

  // Nodes are opened nearest first by what bounds all rays; which of them enter is asked of leaves,
  // and of what has waited. leaf(first block or entry, who enters it). leave(packet, its lanes,
  // child) takes a packet on that alone enters a child; none: all stay together.
  template <bool in_world, size_t many, class Leaf, class Leave>
  HWY_INLINE void walk(const Nodes& tree, uint32_t index, const Part<many>& part, const Leaf& leaf,
                       const Leave& leave) {
    constexpr bool may_leave = !std::is_null_pointer_v<Leave>;
    struct Far {
      float bound;
      uint32_t parent;
      int slot;
    };
    OnePacket* const packets = part.packets;
    const std::array<uint32_t, many> lanes = part.lanes;
    const PacketRays& any = rays_of<in_world>(packets[0]);
    const PacketBounds bounds = bounds_of<tests, many>(
        [&](size_t i) HWY_ATTR -> const PacketRays& { return rays_of<in_world>(packets[i]); });
    std::array<Far, capacity> stack;
    size_t waiting = 0;
    float end = end_of(part);
    while (true) {
      const Node& node = tree.nodes[index];
      alignas(64) float decoded[6][W];
      alignas(64) float bound[W];
      uint32_t hits = cull_children<tests, W>(planes_in(node, decoded), any, bounds, end, bound) &
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
        Part<many> entered{packets, lanes};
        size_t entrants = 0, last = 0;
        for (size_t i = 0; i < many; ++i) {
          entered.lanes[i] &= entering<in_world>(packets[i], tree.nodes[next.parent], next.slot);
          if (entered.lanes[i] == 0) continue;
          ++entrants;
          last = i;
        }
        if (entrants == 0) continue;
        if (is_leaf(child)) {
          leaf(child & ~leaf_bit, entered);
          end = end_of(part);
          continue;
        }
        if constexpr (may_leave) {
          const bool are_few = std::popcount(entered.lanes[last]) <= few_rays;
          if (entrants == 1 && (many > 1 || are_few)) {
            leave(packets[last], entered.lanes[last], child);
            end = end_of(part);
            continue;
          }
        }
        index = child;
        break;
      }
    }
  }

  // The rays of a packet that enter a child.
  template <bool in_world>
  static HWY_INLINE uint32_t entering(const OnePacket& packet, const Node& node, int slot) {
    const auto plane = [&](int axis, uint32_t high)
                           HWY_ATTR { return plane_of(node, 2 * axis + high, slot); };
    return packet_bits(
        span_of<tests>(plane, rays_of<in_world>(packet), packet.begin_.get(), packet.last())
            .inside);
  }

  template <size_t many>
  static HWY_INLINE float end_of(const Part<many>& part) {
    PacketVector end = part.packets[0].end_.get();
    for (size_t i = 1; i < many; ++i)
      end = hn::Max(end, part.packets[i].end_.get());
    return hn::GetLane(hn::MaxOfLanes(PacketLanes(), end)) * end_padding<tests>;
  }

  template <int Width>
  static float plane_of(const WideNode<Width>& node, uint32_t plane, int slot) {
    return node.planes[plane][slot];
  }
  static float plane_of(const QuantisedNode& node, uint32_t plane, int slot) {
    const float step = std::bit_cast<float>(uint32_t(node.exponent[plane / 2]) << 23);
    return node.origin[plane / 2] + float(node.planes[plane][slot]) * step;
  }

  // False if none of these rays comes to a leaf of an instance.
  HWY_NOINLINE bool may_meet(std::span<const Ray> rays) const {
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

  std::array<OnePacket, count> packets_;
  const SceneBvh& bvh_;
  const Nodes* tlas_;  // none over an empty scene
  PacketProbe<NoProbe> no_probe_{std::span<NoProbe>()};
  bool met_ = true;  // the rays of before came to a triangle
};

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
