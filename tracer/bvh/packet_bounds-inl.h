// What bounds rays, so that a node's children are culled for all of them at once (S. Boulos et al.,
// Packet-based Whitted and Distribution Ray Tracing, 2007). Compiled once for each instruction set.
#if defined(TRACER_BVH_PACKET_BOUNDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRACER_BVH_PACKET_BOUNDS_INL_H_
#undef TRACER_BVH_PACKET_BOUNDS_INL_H_
#else
#define TRACER_BVH_PACKET_BOUNDS_INL_H_
#endif

#include <span>
#include <utility>

#include "tracer/bvh/packet-inl.h"
#include "tracer/math/columns.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

// The intervals that hold all rays: of the origins as the near and far planes are seen from there,
// and of the reciprocals of the directions.
struct PacketBounds {
  float near_origin[3], far_origin[3], least[3], most[3];
};
// Of so many packets that enter boxes by the same planes; rays_of(index).
template <Tests tests, size_t many, class RaysOf>
HWY_INLINE PacketBounds bounds_of(const RaysOf& rays_of) {
  const PacketLanes d;
  PacketBounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const auto bound = [&](const auto& of) HWY_ATTR {
      PacketVector least = of(rays_of(0))[axis].get();
      PacketVector most = least;
      for (size_t i = 1; i < many; ++i) {
        const PacketVector next = of(rays_of(i))[axis].get();
        least = hn::Min(least, next);
        most = hn::Max(most, next);
      }
      return std::pair(least, most);
    };
    const bool fast = tests == Tests::fast;
    const auto [least_near, most_near] = bound(
        [](const PacketRays& rays) -> const auto& { return fast ? rays.origin : rays.from_near; });
    const auto [least_far, most_far] = bound(
        [](const PacketRays& rays) -> const auto& { return fast ? rays.origin : rays.from_far; });
    const auto [least, most] =
        bound([](const PacketRays& rays) -> const auto& { return rays.inverse; });
    // Of a ray that goes forwards the least distance is that from the largest origin.
    const bool backwards = (rays_of(0).near[axis] & 1) != 0;
    bounds.near_origin[axis] =
        hn::GetLane(backwards ? hn::MinOfLanes(d, least_near) : hn::MaxOfLanes(d, most_near));
    bounds.far_origin[axis] =
        hn::GetLane(backwards ? hn::MaxOfLanes(d, most_far) : hn::MinOfLanes(d, least_far));
    bounds.least[axis] = hn::GetLane(hn::MinOfLanes(d, least));
    bounds.most[axis] = hn::GetLane(hn::MaxOfLanes(d, most));
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

template <int Width>
const float (*planes_in(const WideNode<Width>& node, float (*)[Width]))[Width] {
  return node.planes;
}
HWY_INLINE const float (*planes_in(const QuantisedNode& node, float (*decoded)[8]))[8] {
  const SlotLanes<8> d;
  for (uint32_t plane = 0; plane < 6; ++plane) {
    for (size_t slot = 0; slot < 8; slot += hn::Lanes(d))
      hn::Store(planes_of(node).load(d, plane, slot), d, decoded[plane] + slot);
  }
  return decoded;
}

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
