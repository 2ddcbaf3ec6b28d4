// Packets: as many coherent rays as a vector has lanes, and what they have in common whatever the
// layout (I. Wald et al., Interactive Rendering with Coherent Ray Tracing, 2001).
// Compiled once for each instruction set.
#if defined(TRACER_BVH_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRACER_BVH_PACKET_INL_H_
#undef TRACER_BVH_PACKET_INL_H_
#else
#define TRACER_BVH_PACKET_INL_H_
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <type_traits>

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
HWY_INLINE hn::Mask<PacketLanes> lane_mask(uint32_t lanes) {
  const uint8_t bits[8] = {uint8_t(lanes), uint8_t(lanes >> 8)};
  return hn::LoadMaskBits(PacketLanes(), bits);
}
inline constexpr uint32_t all_lanes = (1u << packet_size) - 1;

struct alignas(64) PacketFloats {
  float lane[packet_size];
  HWY_INLINE PacketVector get() const { return hn::Load(PacketLanes(), lane); }
  HWY_INLINE void set(PacketVector value) { hn::Store(value, PacketLanes(), lane); }
};

struct alignas(64) PacketIds {
  uint32_t lane[packet_size];
  HWY_INLINE void set(uint32_t id, hn::Mask<PacketLanes> where) {
    const hn::RebindToUnsigned<PacketLanes> d;
    hn::Store(hn::IfThenElse(hn::RebindMask(d, where), hn::Set(d, id), hn::Load(d, lane)), d, lane);
  }
};

// What the rays have hit, by component.
struct PacketHits {
  PacketFloats t, u, v;
  PacketIds triangle, instance;

  HWY_INLINE void clear() {
    const PacketLanes d;
    const auto all = hn::FirstN(d, packet_size);
    t.set(hn::Set(d, infinity));
    u.set(hn::Zero(d));
    v.set(hn::Zero(d));
    triangle.set(none, all);
    instance.set(none, all);
  }
  // Those of one triangle.
  HWY_INLINE void set(PacketVector ts, PacketVector us, PacketVector vs, uint32_t of_triangle,
                      uint32_t of_instance, hn::Mask<PacketLanes> where) {
    t.set(hn::IfThenElse(where, ts, t.get()));
    u.set(hn::IfThenElse(where, us, u.get()));
    v.set(hn::IfThenElse(where, vs, v.get()));
    triangle.set(of_triangle, where);
    instance.set(of_instance, where);
  }
  HWY_INLINE Hit get(size_t at) const {
    return {t.lane[at], u.lane[at], v.lane[at], triangle.lane[at], instance.lane[at]};
  }
  HWY_INLINE void set(size_t at, const Hit& hit) {
    t.lane[at] = hit.t;
    u.lane[at] = hit.u;
    v.lane[at] = hit.v;
    triangle.lane[at] = hit.triangle;
    instance.lane[at] = hit.instance;
  }
};

// Rays in the space of one tree. For the fast tests from_near is as in SlabRay, and what only the
// watertight ones need is not set: from_far, padded, and all of the triangle test.
struct PacketRays {
  PacketFloats origin[3], direction[3];
  PacketFloats from_near[3], from_far[3], inverse[3], padded[3];
  uint32_t near[3], far[3];  // planes
  int kx, ky, kz;            // the triangle test's axes, and its shear
  PacketFloats shear_x, shear_y, shear_z;
};

inline vec3 origin_of(const PacketRays& rays, size_t lane) {
  return {rays.origin[0].lane[lane], rays.origin[1].lane[lane], rays.origin[2].lane[lane]};
}
inline vec3 direction_of(const PacketRays& rays, size_t lane) {
  return {rays.direction[0].lane[lane], rays.direction[1].lane[lane], rays.direction[2].lane[lane]};
}

// A ray of a packet in the space of an instance; the arithmetic is that of Packet::transform.
struct LoneRay {
  vec3 origin, direction;
};
inline LoneRay lone_ray(const PacketRays& rays, size_t lane) {
  return {origin_of(rays, lane), direction_of(rays, lane)};
}
inline LoneRay lone_ray(const PacketRays& rays, size_t lane, const mat4& to_object) {
  return {moved(to_object, origin_of(rays, lane)), turned(to_object, direction_of(rays, lane))};
}

// Planes by the signs of the directions, for one axis. False: the rays differ in them.
HWY_INLINE bool choose_planes(PacketRays& rays, int axis, PacketVector inverse) {
  const uint32_t negative = packet_bits(hn::Lt(inverse, hn::Zero(PacketLanes())));
  const bool backwards = negative != 0;
  rays.near[axis] = 2 * axis + uint32_t(backwards);
  rays.far[axis] = 2 * axis + uint32_t(!backwards);
  return !backwards || negative == all_lanes;
}

// The arithmetic of box_ray for the fast tests.
HWY_INLINE bool prepare_fast(PacketRays& rays) {
  const PacketLanes d;
  const PacketVector zero = hn::Zero(d);
  const PacketVector least = hn::Set(d, least_component);
  for (int axis = 0; axis < 3; ++axis) {
    const PacketVector way = rays.direction[axis].get();
    const PacketVector longer = hn::IfThenElse(
        hn::Lt(hn::Abs(way), least), hn::IfThenElse(hn::Lt(way, zero), hn::Neg(least), least), way);
    const PacketVector inverse = hn::Div(hn::Set(d, 1.0f), longer);
    if (!choose_planes(rays, axis, inverse)) return false;
    rays.from_near[axis].set(hn::Mul(rays.origin[axis].get(), inverse));
    rays.inverse[axis].set(inverse);
  }
  return true;
}

// False if the rays differ in the signs of their directions or, which the fast tests do not mind,
// in their longest axis. The arithmetic is that of box_ray and triangle_ray.
template <Tests tests>
HWY_INLINE bool prepare(PacketRays& rays) {
  if constexpr (tests == Tests::fast) return prepare_fast(rays);
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
    if (!choose_planes(rays, axis, finite)) return false;
    const PacketVector lo = hn::Add(from, wider);
    const PacketVector hi = hn::Sub(from, wider);
    const bool backwards = (rays.near[axis] & 1) != 0;
    const PacketVector near = backwards ? hi : lo;
    const PacketVector far = backwards ? lo : hi;
    rays.from_near[axis].set(near);
    rays.from_far[axis].set(far);
    rays.inverse[axis].set(finite);
    rays.padded[axis].set(finite_padded);
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

// Where they enter a box and the mask of those that do, at or before `last`; plane(axis, high).
struct PacketSpan {
  PacketVector entry;
  hn::Mask<PacketLanes> inside;
};
template <Tests tests, class Plane>
HWY_INLINE PacketSpan span_of(const Plane& plane, const PacketRays& rays, PacketVector begin,
                              PacketVector last) {
  const PacketLanes d;
  PacketVector entry = begin;
  PacketVector exit = last;
  for (int axis = 0; axis < 3; ++axis) {
    const PacketVector near = hn::Set(d, plane(axis, rays.near[axis] & 1));
    const PacketVector far = hn::Set(d, plane(axis, rays.far[axis] & 1));
    const PacketVector from = rays.from_near[axis].get();
    const PacketVector inverse = rays.inverse[axis].get();
    if constexpr (tests == Tests::fast) {
      entry = hn::Max(entry, hn::MulSub(near, inverse, from));
      exit = hn::Min(exit, hn::MulSub(far, inverse, from));
    } else {
      entry = hn::Max(entry, hn::Mul(hn::Sub(near, from), inverse));
      exit =
          hn::Min(exit, hn::Mul(hn::Sub(far, rays.from_far[axis].get()), rays.padded[axis].get()));
    }
  }
  return {entry, hn::Le(entry, exit)};
}

// The rays of one packet: where they are, how far they go and what they have hit. Any hit: only
// whether, unless a probe wants to know what.
template <bool any_hit, Tests tests, bool keeps_hits>
class Packet {
 public:
  static constexpr size_t size = packet_size;

  // Of the first rays, in their order.
  HWY_INLINE void write_hits(std::span<Hit> to) const requires keeps_hits {
    for (size_t lane = 0; lane < to.size(); ++lane)
      to[lane] = hits_.get(lane);
  }
  // Any hit: of the first rays, 1 for those that have hit something.
  HWY_INLINE void write_blocked(std::span<uint8_t> to) const {
    const uint32_t bits = begun_ & ~alive();
    for (size_t lane = 0; lane < to.size(); ++lane)
      to[lane] = uint8_t(bits >> lane & 1);
  }
  // As of rays that hit nothing.
  void clear() {
    begun_ = 0;
    clear_hits();
  }

 protected:
  // As many rays as there are lanes, by component.
  static HWY_INLINE void transpose(const Ray* rays, PacketVector (&origin)[3],
                                   PacketVector (&direction)[3], PacketVector& t_min,
                                   PacketVector& t_max) {
    const PacketLanes d;
    static_assert(sizeof(Ray) == 8 * sizeof(float) && offsetof(Ray, t_min) == 12 &&
                  offsetof(Ray, direction) == 16 && offsetof(Ray, t_max) == 28);
#if HWY_TARGET == HWY_SCALAR
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = hn::Set(d, rays->origin[axis]);
      direction[axis] = hn::Set(d, rays->direction[axis]);
    }
    t_min = hn::Set(d, rays->t_min);
    t_max = hn::Set(d, rays->t_max);
#else
    // Of each half of the rays: lanes are of origin and direction in turns.
    PacketVector lower[4], upper[4];
    const float* from = &rays->origin.x;
    hn::LoadInterleaved4(d, from, lower[0], lower[1], lower[2], lower[3]);
    hn::LoadInterleaved4(d, from + 4 * packet_size, upper[0], upper[1], upper[2], upper[3]);
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = hn::ConcatEven(d, upper[axis], lower[axis]);
      direction[axis] = hn::ConcatOdd(d, upper[axis], lower[axis]);
    }
    t_min = hn::ConcatEven(d, upper[3], lower[3]);
    t_max = hn::ConcatOdd(d, upper[3], lower[3]);
#endif
  }

  // Lanes that no ray is left for, or whose ray is not valid (is_valid), are never alive.
  HWY_INLINE void load(std::span<const Ray> rays) {
    clear_hits();
    const PacketLanes d;
    const PacketVector zero = hn::Zero(d);
    PacketVector origin[3], direction[3], t_min, t_max;
    if (rays.size() == packet_size) {
      transpose(rays.data(), origin, direction, t_min, t_max);
    } else {
      std::array<Ray, packet_size> padded;
      for (size_t lane = 0; lane < packet_size; ++lane)
        padded[lane] = rays[std::min(lane, rays.size() - 1)];
      transpose(padded.data(), origin, direction, t_min, t_max);
    }
    // Products of numbers and zero are zero, unless one of them is not finite.
    PacketVector products = hn::Mul(t_min, zero);
    PacketVector longest = zero;
    for (int axis = 0; axis < 3; ++axis) {
      products = hn::Add(products, hn::Mul(origin[axis], zero));
      products = hn::Add(products, hn::Mul(direction[axis], zero));
      longest = hn::Max(longest, hn::Abs(direction[axis]));
    }
    const auto usual = hn::And(hn::Eq(products, zero), hn::Le(t_min, t_max));
    const auto valid = hn::And(hn::And(usual, hn::Gt(longest, hn::Set(d, shortest_direction))),
                               hn::FirstN(d, rays.size()));
    end_.set(hn::IfThenElse(valid, t_max, hn::Set(d, -infinity)));
    begin_.set(hn::IfThenElseZero(valid, hn::Max(t_min, zero)));
    const uint32_t valid_lanes = packet_bits(valid);
    const int other = valid_lanes == 0 ? 0 : std::countr_zero(valid_lanes);
    for (int axis = 0; axis < 3; ++axis) {
      const Ray& ray = rays[size_t(other)];
      world_.origin[axis].set(hn::IfThenElse(valid, origin[axis], hn::Set(d, ray.origin[axis])));
      world_.direction[axis].set(
          hn::IfThenElse(valid, direction[axis], hn::Set(d, ray.direction[axis])));
    }
    begun_ = alive();
  }

  uint32_t alive() const {
    return packet_bits(hn::Ge(end_.get(), hn::Zero(PacketLanes())));
  }

  // The rays in the space of an instance. False: see prepare. The order of the sums is that of GLM.
  HWY_INLINE bool transform(const mat4& to_object) {
    const PacketLanes d;
    const auto transformed = [&](const PacketFloats(&from)[3], float w, int axis) HWY_ATTR {
      const auto times = [&](int column, PacketVector value) HWY_ATTR {
        return hn::Mul(hn::Set(d, to_object[column][axis]), value);
      };
      return hn::Add(hn::Add(times(0, from[0].get()), times(1, from[1].get())),
                     hn::Add(times(2, from[2].get()), hn::Set(d, to_object[3][axis] * w)));
    };
    for (int axis = 0; axis < 3; ++axis) {
      local_.origin[axis].set(transformed(world_.origin, 1.0f, axis));
      local_.direction[axis].set(transformed(world_.direction, 0.0f, axis));
    }
    return prepare<tests>(local_);
  }

  // Where boxes are no longer worth a visit.
  HWY_INLINE PacketVector last() const {
    if constexpr (tests == Tests::fast) return end_.get();
    return hn::Mul(end_.get(), hn::Set(PacketLanes(), exit_padding));
  }

  // corner(axis, k): of the triangle. Only `lanes` are tested.
  template <class Corner>
  HWY_INLINE void visit_triangle(const Corner& corner, uint32_t triangle, const PacketRays& rays,
                                 uint32_t id, uint32_t lanes) {
    if constexpr (tests == Tests::fast) {
      test_fast(corner, triangle, rays, id, lanes);
    } else {
      test_watertight(corner, triangle, rays, id, lanes);
    }
  }

  HWY_INLINE void take(const Hit& found, int lane) {
    if constexpr (keeps_hits) {
      if (found.t == hits_.t.lane[lane] &&
          !is_before(found.instance, found.triangle, hits_.get(lane)))
        return;
      hits_.set(lane, found);
    }
    end_.lane[lane] = any_hit ? -infinity : found.t;
  }

  // What a ray has hit so far, and what it has come to by itself.
  HWY_INLINE Hit hit_of(int lane) const {
    if constexpr (keeps_hits) return hits_.get(lane);
    return {};
  }
  HWY_INLINE void settle(int lane, const Hit& hit, float t_max) {
    if constexpr (keeps_hits) hits_.set(lane, hit);
    end_.lane[lane] = any_hit && is_hit(hit) ? -infinity : t_max;
  }

  PacketRays world_, local_;
  PacketFloats begin_, end_;  // of the rays; a ray that is done ends at -infinity

 private:
  template <class Corner>
  HWY_INLINE void test_fast(const Corner& corner, uint32_t triangle, const PacketRays& rays,
                            uint32_t id, uint32_t lanes) {
    const PacketLanes d;
    Vectors3<PacketVector> to_b, to_c, from, direction;
    for (int axis = 0; axis < 3; ++axis) {
      const float first = corner(axis, 0);
      to_b.of[axis] = hn::Set(d, corner(axis, 1) - first);
      to_c.of[axis] = hn::Set(d, corner(axis, 2) - first);
      from.of[axis] = hn::Sub(rays.origin[axis].get(), hn::Set(d, first));
      direction.of[axis] = rays.direction[axis].get();
    }
    const PacketVector end = end_.get();
    const auto met = fast_hits(d, to_b, to_c, from, direction, begin_.get(), end);
    const uint32_t hits = packet_bits(met.hit) & lanes;
    if (hits == 0) return;
    const PacketVector inverse = hn::Div(hn::Set(d, 1.0f), met.size);
    take_all(hn::Min(hn::Mul(met.t, inverse), end), hn::Mul(met.u, inverse),
             hn::Mul(met.v, inverse), triangle, id, hits);
  }

  HWY_INLINE void take_all(PacketVector t, PacketVector u, PacketVector v, uint32_t triangle,
                           uint32_t id, uint32_t hits) {
    if constexpr (keeps_hits) {
      for (uint32_t ties = hits & packet_bits(hn::Eq(t, hits_.t.get())); ties != 0;
           ties &= ties - 1) {
        const int lane = std::countr_zero(ties);
        if (!is_before(id, triangle, hits_.get(lane))) hits &= ~(1u << lane);
      }
      hits_.set(t, u, v, triangle, id, lane_mask(hits));
    }
    const PacketVector end = any_hit ? hn::Set(PacketLanes(), -infinity) : t;
    end_.set(hn::IfThenElse(lane_mask(hits), end, end_.get()));
  }

  // The arithmetic of triangle_test.h, with a ray in each lane.
  template <class Corner>
  HWY_INLINE void test_watertight(const Corner& corner, uint32_t triangle, const PacketRays& rays,
                                  uint32_t id, uint32_t lanes) {
    const PacketLanes d;
    using V = PacketVector;
    const V zero = hn::Zero(d);
    const V from_x = rays.origin[rays.kx].get();
    const V from_y = rays.origin[rays.ky].get();
    const V from_z = rays.origin[rays.kz].get();
    V x[3], y[3], z[3];
    for (int k = 0; k < 3; ++k) {
      z[k] = hn::Sub(hn::Set(d, corner(rays.kz, k)), from_z);
      x[k] = hn::Sub(hn::Sub(hn::Set(d, corner(rays.kx, k)), from_x),
                     hn::Mul(rays.shear_x.get(), z[k]));
      y[k] = hn::Sub(hn::Sub(hn::Set(d, corner(rays.ky, k)), from_y),
                     hn::Mul(rays.shear_y.get(), z[k]));
    }
    const V a = hn::Sub(hn::Mul(x[2], y[1]), hn::Mul(y[2], x[1]));
    const V b = hn::Sub(hn::Mul(x[0], y[2]), hn::Mul(y[0], x[2]));
    const V c = hn::Sub(hn::Mul(x[1], y[0]), hn::Mul(y[1], x[0]));
    const auto inside =
        hn::Or(hn::Ge(hn::Min(hn::Min(a, b), c), zero), hn::Le(hn::Max(hn::Max(a, b), c), zero));
    uint32_t hits = packet_bits(inside) & lanes;
    if (hits == 0) return;
    uint32_t exact =
        hits & packet_bits(hn::Or(hn::Or(hn::Eq(a, zero), hn::Eq(b, zero)), hn::Eq(c, zero)));
    hits &= ~exact;
    if (hits != 0) {
      const V determinant = hn::Add(hn::Add(a, b), c);
      const V weight_a = hn::Div(a, determinant);
      const V weight_b = hn::Div(b, determinant);
      const V weight_c = hn::Div(c, determinant);
      const V plane_t = hn::Mul(rays.shear_z.get(),
                                hn::Add(hn::Add(hn::Mul(weight_a, z[0]), hn::Mul(weight_b, z[1])),
                                        hn::Mul(weight_c, z[2])));
      const V t = within_own_box(corner, rays, plane_t);
      const auto in_range = hn::And(hn::Ge(t, begin_.get()), hn::Le(t, end_.get()));
      hits &= packet_bits(hn::And(in_range, hn::Eq(plane_t, plane_t)));
      if (hits != 0) take_all(t, weight_b, weight_c, triangle, id, hits);
    }
    for (; exact != 0; exact &= exact - 1) {
      const int lane = std::countr_zero(exact);
      test_exactly_in_lane(corner, triangle, rays, id, lane);
    }
  }

  // Between where the rays enter and leave the triangle's own box.
  template <class Corner>
  static HWY_INLINE PacketVector within_own_box(const Corner& corner, const PacketRays& rays,
                                                PacketVector t) {
    const PacketLanes d;
    PacketVector entry = hn::Set(d, -infinity);
    PacketVector exit = hn::Set(d, infinity);
    for (int axis = 0; axis < 3; ++axis) {
      const float p = corner(axis, 0);
      const float q = corner(axis, 1);
      const float r = corner(axis, 2);
      const float lo = std::min(std::min(p, q), r);
      const float hi = std::max(std::max(p, q), r);
      const bool forwards = (rays.near[axis] & 1) == 0;
      const PacketVector near = hn::Set(d, forwards ? lo : hi);
      const PacketVector far = hn::Set(d, forwards ? hi : lo);
      entry = hn::Max(entry,
                      hn::Mul(hn::Sub(near, rays.from_near[axis].get()), rays.inverse[axis].get()));
      exit =
          hn::Min(exit, hn::Mul(hn::Sub(far, rays.from_far[axis].get()), rays.padded[axis].get()));
    }
    return hn::Min(hn::Max(t, entry), exit);
  }

  template <class Corner>
  HWY_NOINLINE void test_exactly_in_lane(const Corner& corner, uint32_t triangle,
                                         const PacketRays& rays, uint32_t id, int lane) {
    const vec3 origin = origin_of(rays, lane);
    const vec3 direction = direction_of(rays, lane);
    const TriangleHit found =
        test_alone(corner, triangle_ray(origin, direction, box_ray(origin, direction)),
                   begin_.lane[lane], end_.lane[lane]);
    if (found.hit) take({found.t, found.u, found.v, triangle, id}, lane);
  }

  HWY_INLINE void clear_hits() {
    if constexpr (keeps_hits) hits_.clear();
  }

  uint32_t begun_ = 0;  // lanes that were alive at first
  struct NoHits {};
  [[no_unique_address]] std::conditional_t<keeps_hits, PacketHits, NoHits> hits_;
};

// answer(index of the first of some rays, how many, their packet). One probe a ray; none for
// NoProbe.
template <class SomeRays, class Probe, class Answer>
void trace_packets(const SceneBvh& bvh, std::span<const Ray> rays, std::span<Probe> probes,
                   const Answer& answer) {
  SomeRays packet(bvh);
  for (size_t first = 0; first < rays.size(); first += SomeRays::size) {
    const size_t count = std::min(SomeRays::size, rays.size() - first);
    packet.run(rays.subspan(first, count), probes.empty() ? probes : probes.subspan(first, count));
    answer(first, count, packet);
  }
}

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
