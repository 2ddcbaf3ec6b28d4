// Packets: as many coherent rays as a vector has lanes go down the tree together. An interval that
// holds all of them culls the children of a node at once (S. Boulos et al., Packet-based Whitted
// and Distribution Ray Tracing, 2007), a vector test of one child by all rays decides which of them
// enter it. Few rays that are left go on by themselves (C. Benthin et al., Combining Single and
// Packet-Ray Tracing for Arbitrary Ray Distributions on the Intel MIC Architecture, 2012).
// Compiled once for each instruction set.
#if defined(TRACER_BVH_WIDE_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRACER_BVH_WIDE_PACKET_INL_H_
#undef TRACER_BVH_WIDE_PACKET_INL_H_
#else
#define TRACER_BVH_WIDE_PACKET_INL_H_
#endif

#include "tracer/bvh/wide_traverse-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

using PacketLanes = hn::CappedTag<float, 16>;
using PacketVector = hn::Vec<PacketLanes>;
inline constexpr size_t packet_size = hn::MaxLanes(PacketLanes());
inline constexpr int few_rays = packet_size / 8;  // go on by themselves

HWY_INLINE uint32_t packet_bits(hn::Mask<PacketLanes> mask) {
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(PacketLanes(), mask, bytes);
  return bytes[0] | uint32_t(bytes[1]) << 8;
}
inline constexpr uint32_t all_lanes = (1u << packet_size) - 1;

struct alignas(64) PacketFloats {
  float lane[packet_size];
  HWY_INLINE PacketVector get() const { return hn::Load(PacketLanes(), lane); }
  HWY_INLINE void set(PacketVector value) { hn::Store(value, PacketLanes(), lane); }
};

// Rays in the space of one tree.
struct PacketRays {
  PacketFloats origin[3], direction[3];
  PacketFloats from_near[3], from_far[3], inverse[3], padded[3];
  uint32_t near[3], far[3];  // planes
  // The intervals that hold all of them: of the origins as the near and far planes are seen from
  // there, and of the reciprocals of the directions.
  float near_origin[3], far_origin[3], least[3], most[3];
  int kx, ky, kz;  // the triangle test's axes, and its shear
  PacketFloats shear_x, shear_y, shear_z;
};

inline vec3 origin_of(const PacketRays& rays, size_t lane) {
  return {rays.origin[0].lane[lane], rays.origin[1].lane[lane], rays.origin[2].lane[lane]};
}
inline vec3 direction_of(const PacketRays& rays, size_t lane) {
  return {rays.direction[0].lane[lane], rays.direction[1].lane[lane], rays.direction[2].lane[lane]};
}

// False if the rays differ in the signs of their directions or in their longest axis. The
// arithmetic is that of box_ray and triangle_ray.
HWY_INLINE bool prepare(PacketRays& rays) {
  const PacketLanes d;
  const PacketVector largest = hn::Set(d, std::numeric_limits<float>::max());
  for (int axis = 0; axis < 3; ++axis) {
    const PacketVector from = rays.origin[axis].get();
    const PacketVector inverse = hn::Div(hn::Set(d, 1.0f), rays.direction[axis].get());
    const PacketVector padded = hn::Mul(inverse, hn::Set(d, exit_padding));
    const auto usual = hn::Le(hn::Abs(padded), largest);
    const PacketVector wider =
        hn::IfThenElse(usual, hn::Zero(d),
                       hn::Max(hn::Mul(hn::Abs(from), hn::Set(d, 2.4e-7f)), hn::Set(d, 1e-20f)));
    const PacketVector finite = hn::IfThenElse(usual, inverse, largest);
    const PacketVector finite_padded = hn::IfThenElse(usual, padded, largest);
    const uint32_t negative = packet_bits(hn::Lt(finite, hn::Zero(d)));
    if (negative != 0 && negative != all_lanes) return false;
    const PacketVector lo = hn::Add(from, wider);
    const PacketVector hi = hn::Sub(from, wider);
    const bool backwards = negative != 0;
    rays.near[axis] = 2 * axis + uint32_t(backwards);
    rays.far[axis] = 2 * axis + uint32_t(!backwards);
    const PacketVector near = backwards ? hi : lo;
    const PacketVector far = backwards ? lo : hi;
    rays.from_near[axis].set(near);
    rays.from_far[axis].set(far);
    rays.inverse[axis].set(finite);
    rays.padded[axis].set(finite_padded);
    // Of a ray that goes forwards the least distance is that from the largest origin.
    rays.near_origin[axis] =
        hn::GetLane(backwards ? hn::MinOfLanes(d, near) : hn::MaxOfLanes(d, near));
    rays.far_origin[axis] =
        hn::GetLane(backwards ? hn::MaxOfLanes(d, far) : hn::MinOfLanes(d, far));
    rays.least[axis] = hn::GetLane(hn::MinOfLanes(d, finite));
    rays.most[axis] = hn::GetLane(hn::MaxOfLanes(d, finite));
  }
  const PacketVector x = hn::Abs(rays.direction[0].get());
  const PacketVector y = hn::Abs(rays.direction[1].get());
  const PacketVector z = hn::Abs(rays.direction[2].get());
  const uint32_t x_over_y = packet_bits(hn::Gt(x, y));
  const uint32_t is_x = x_over_y & packet_bits(hn::Gt(x, z));
  const uint32_t is_y = ~x_over_y & packet_bits(hn::Gt(y, z)) & all_lanes;
  const uint32_t is_z = all_lanes & ~(is_x | is_y);
  if (is_x != all_lanes && is_y != all_lanes && is_z != all_lanes) return false;
  rays.kz = is_x != 0 ? 0 : is_y != 0 ? 1 : 2;
  rays.kx = (rays.kz + 1) % 3;
  rays.ky = (rays.kx + 1) % 3;
  if (rays.direction[rays.kz].lane[0] < 0.0f) std::swap(rays.kx, rays.ky);
  const PacketVector inverse = rays.inverse[rays.kz].get();
  rays.shear_x.set(hn::Mul(rays.direction[rays.kx].get(), inverse));
  rays.shear_y.set(hn::Mul(rays.direction[rays.ky].get(), inverse));
  rays.shear_z.set(inverse);
  return true;
}

// The children that any of the rays may enter, each with a lower bound of where.
template <int W>
HWY_INLINE uint32_t cull_children(const float (*planes)[W], const PacketRays& rays, float end,
                                  float* entry_bound) {
  const SlotLanes<W> d;
  uint32_t hits = 0;
  for (size_t slot = 0; slot < W; slot += hn::Lanes(d)) {
    auto entry = hn::Zero(d);
    auto exit = hn::Set(d, end);
    for (int axis = 0; axis < 3; ++axis) {
      const auto least = hn::Set(d, rays.least[axis]);
      const auto most = hn::Set(d, rays.most[axis]);
      const auto near =
          hn::Sub(hn::Load(d, planes[rays.near[axis]] + slot), hn::Set(d, rays.near_origin[axis]));
      const auto far = hn::Mul(
          hn::Sub(hn::Load(d, planes[rays.far[axis]] + slot), hn::Set(d, rays.far_origin[axis])),
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
class PacketTraversal {
  using Node = std::remove_cvref_t<decltype(Nodes().nodes[0])>;
  static constexpr int W = Node::width;

 public:
  PacketTraversal(const SceneBvh& bvh, const Nodes& tlas) : bvh_(bvh), tlas_(tlas) {}

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

  const Hit& hit(size_t lane) const { return hits_[lane]; }

 private:
  // Lanes that no ray is left for, or whose ray is not valid, are never alive.
  void load(const Ray* rays, size_t count) {
    size_t first_valid = packet_size;
    for (size_t lane = 0; lane < packet_size; ++lane) {
      hits_[lane] = {};
      const bool valid = lane < count && is_valid(rays[lane]);
      if (valid) first_valid = std::min(first_valid, lane);
      end_.lane[lane] = valid ? rays[lane].t_max : -infinity;
      begin_.lane[lane] = valid ? std::max(rays[lane].t_min, 0.0f) : 0.0f;
    }
    if (first_valid == packet_size) return;
    for (size_t lane = 0; lane < packet_size; ++lane) {
      const bool valid = lane < count && is_valid(rays[lane]);
      const Ray& ray = rays[valid ? lane : first_valid];
      for (int axis = 0; axis < 3; ++axis) {
        world_.origin[axis].lane[lane] = ray.origin[axis];
        world_.direction[axis].lane[lane] = ray.direction[axis];
      }
    }
  }

  uint32_t alive() const { return packet_bits(hn::Ge(end_.get(), hn::Zero(PacketLanes()))); }

  void run_single(const Ray* rays, size_t count) {
    NoProbe probe;
    for (size_t lane = 0; lane < count; ++lane)
      hits_[lane] = traverse_wide<any_hit, Nodes>(bvh_, rays[lane], probe);
  }

  struct alignas(64) Waiting {
    PacketFloats entry;  // of rays that do not enter: infinity
    WideChild child;
  };

  // leaf(first block or entry, lanes that enter it).
  template <class Leaf>
  HWY_INLINE void walk(const Nodes& tree, const PacketRays& rays, uint32_t lanes, uint32_t instance,
                       const Leaf& leaf) {
    const PacketLanes d;
    constexpr size_t capacity = (W - 1) * (max_tree_depth + 1) + 1;
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
        open(tree.nodes[child], rays, stack.data(), waiting);
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
  HWY_INLINE void open(const Node& node, const PacketRays& rays, Waiting* stack, size_t& waiting) {
    const PacketLanes d;
    alignas(64) float decoded[6][W];
    const float(*planes)[W] = planes_in(node, decoded);
    const float end = hn::GetLane(hn::MaxOfLanes(d, end_.get())) * exit_padding;
    alignas(64) float bound[W];
    uint32_t hits = cull_children<W>(planes, rays, end, bound) & planes_of(node).slots();
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
      PacketVector entry = begin_.get();
      PacketVector exit = last;
      for (int axis = 0; axis < 3; ++axis) {
        const PacketVector near = hn::Set(d, planes[rays.near[axis]][slot]);
        const PacketVector far = hn::Set(d, planes[rays.far[axis]][slot]);
        entry = hn::Max(
            entry, hn::Mul(hn::Sub(near, rays.from_near[axis].get()), rays.inverse[axis].get()));
        exit = hn::Min(exit,
                       hn::Mul(hn::Sub(far, rays.from_far[axis].get()), rays.padded[axis].get()));
      }
      const auto inside = hn::Le(entry, exit);
      if (packet_bits(inside) == 0) continue;
      Waiting& next = stack[waiting++];
      next.entry.set(hn::IfThenElse(inside, entry, hn::Set(d, infinity)));
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
      walk(tree, rays, lanes, id, [&](uint32_t first, uint32_t) HWY_ATTR {
        visit_blocks(tree.blocks.data() + first, rays, id);
      });
    };
    if (instance.in_place) return visit(world_);
    PacketRays& rays = local_;
    for (size_t lane = 0; lane < packet_size; ++lane) {
      const vec3 at(instance.to_object * vec4(origin_of(world_, lane), 1.0f));
      const vec3 way(instance.to_object * vec4(direction_of(world_, lane), 0.0f));
      for (int axis = 0; axis < 3; ++axis) {
        rays.origin[axis].lane[lane] = at[axis];
        rays.direction[axis].lane[lane] = way[axis];
      }
    }
    if (prepare(rays)) return visit(rays);
    for (; lanes != 0; lanes &= lanes - 1)
      go_alone(tree, rays, std::countr_zero(lanes), 0, id);
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

  HWY_INLINE void visit_blocks(const TriangleBlock* block, const PacketRays& rays, uint32_t id) {
    while (true) {
      const bool more = (block->triangle[0] & more_bit) != 0;
      for (int of = 0; of < block_size; ++of) {
        const uint32_t triangle = block->triangle[of] & ~more_bit;
        if (of > 0 && triangle == (block->triangle[of - 1] & ~more_bit)) continue;
        visit_triangle(*block, of, triangle, rays, id);
      }
      if (!more) return;
      ++block;
    }
  }

  // The arithmetic of triangle_test.h, with a ray in each lane.
  HWY_INLINE void visit_triangle(const TriangleBlock& block, int of, uint32_t triangle,
                                 const PacketRays& rays, uint32_t id) {
    const PacketLanes d;
    using V = PacketVector;
    const V zero = hn::Zero(d);
    const V from_x = rays.origin[rays.kx].get();
    const V from_y = rays.origin[rays.ky].get();
    const V from_z = rays.origin[rays.kz].get();
    V x[3], y[3], z[3];
    for (int k = 0; k < 3; ++k) {
      z[k] = hn::Sub(hn::Set(d, block.corner[rays.kz][k][of]), from_z);
      x[k] = hn::Sub(hn::Sub(hn::Set(d, block.corner[rays.kx][k][of]), from_x),
                     hn::Mul(rays.shear_x.get(), z[k]));
      y[k] = hn::Sub(hn::Sub(hn::Set(d, block.corner[rays.ky][k][of]), from_y),
                     hn::Mul(rays.shear_y.get(), z[k]));
    }
    const V a = hn::Sub(hn::Mul(x[2], y[1]), hn::Mul(y[2], x[1]));
    const V b = hn::Sub(hn::Mul(x[0], y[2]), hn::Mul(y[0], x[2]));
    const V c = hn::Sub(hn::Mul(x[1], y[0]), hn::Mul(y[1], x[0]));
    const auto on_edge = hn::Or(hn::Or(hn::Eq(a, zero), hn::Eq(b, zero)), hn::Eq(c, zero));
    const auto inside =
        hn::Or(hn::Ge(hn::Min(hn::Min(a, b), c), zero), hn::Le(hn::Max(hn::Max(a, b), c), zero));
    uint32_t exact = packet_bits(on_edge) & alive();
    uint32_t hits = packet_bits(inside) & ~exact;
    if (hits != 0) {
      const V determinant = hn::Add(hn::Add(a, b), c);
      const V weight_a = hn::Div(a, determinant);
      const V weight_b = hn::Div(b, determinant);
      const V weight_c = hn::Div(c, determinant);
      const V plane_t = hn::Mul(rays.shear_z.get(),
                                hn::Add(hn::Add(hn::Mul(weight_a, z[0]), hn::Mul(weight_b, z[1])),
                                        hn::Mul(weight_c, z[2])));
      const V t = within_own_box(block, of, rays, plane_t);
      const auto in_range = hn::And(hn::Ge(t, begin_.get()), hn::Le(t, end_.get()));
      hits &= packet_bits(hn::And(in_range, hn::Eq(plane_t, plane_t)));
      if (hits != 0) {
        PacketFloats found_t, found_u, found_v;
        found_t.set(t);
        found_u.set(weight_b);
        found_v.set(weight_c);
        for (; hits != 0; hits &= hits - 1) {
          const int lane = std::countr_zero(hits);
          take({found_t.lane[lane], found_u.lane[lane], found_v.lane[lane], triangle, id}, lane);
        }
      }
    }
    for (; exact != 0; exact &= exact - 1) {
      const int lane = std::countr_zero(exact);
      test_exactly_in_lane(block, of, triangle, rays, id, lane);
    }
  }

  // Between where the rays enter and leave the triangle's own box.
  static HWY_INLINE PacketVector within_own_box(const TriangleBlock& block, int of,
                                                const PacketRays& rays, PacketVector t) {
    const PacketLanes d;
    PacketVector entry = hn::Set(d, -infinity);
    PacketVector exit = hn::Set(d, infinity);
    for (uint32_t axis = 0; axis < 3; ++axis) {
      const float p = block.corner[axis][0][of];
      const float q = block.corner[axis][1][of];
      const float r = block.corner[axis][2][of];
      const float lo = std::min(std::min(p, q), r);
      const float hi = std::max(std::max(p, q), r);
      const bool forwards = rays.near[axis] == 2 * axis;
      const PacketVector near = hn::Set(d, forwards ? lo : hi);
      const PacketVector far = hn::Set(d, forwards ? hi : lo);
      entry = hn::Max(entry,
                      hn::Mul(hn::Sub(near, rays.from_near[axis].get()), rays.inverse[axis].get()));
      exit =
          hn::Min(exit, hn::Mul(hn::Sub(far, rays.from_far[axis].get()), rays.padded[axis].get()));
    }
    return hn::Min(hn::Max(t, entry), exit);
  }

  HWY_NOINLINE void test_exactly_in_lane(const TriangleBlock& block, int of, uint32_t triangle,
                                         const PacketRays& rays, uint32_t id, int lane) {
    const TriangleRay ray{rays.kx,
                          rays.ky,
                          rays.kz,
                          rays.origin[rays.kx].lane[lane],
                          rays.origin[rays.ky].lane[lane],
                          rays.origin[rays.kz].lane[lane],
                          rays.shear_x.lane[lane],
                          rays.shear_y.lane[lane],
                          rays.shear_z.lane[lane],
                          box_ray(origin_of(rays, lane), direction_of(rays, lane))};
    BlockHits found;
    if (test_exactly(block, ray, begin_.lane[lane], end_.lane[lane], 1u << of, found) == 0) return;
    take({found.t[of], found.u[of], found.v[of], triangle, id}, lane);
  }

  HWY_INLINE void take(const Hit& found, int lane) {
    Hit& hit = hits_[lane];
    if (found.t == hit.t && !is_before(found.instance, found.triangle, hit)) return;
    hit = found;
    end_.lane[lane] = any_hit ? -infinity : found.t;
  }

  const SceneBvh& bvh_;
  const Nodes& tlas_;
  PacketRays world_, local_;
  PacketFloats begin_, end_;  // of the rays; a ray that is done ends at -infinity
  Hit hits_[packet_size];
};

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
