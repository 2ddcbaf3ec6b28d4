// Tests of a block of triangles by one ray. The watertight one is that of triangle_test.h bit for
// bit, with the scalar test itself where that is exact; the fast one is fast_triangle-inl.h.
// Compiled once for each instruction set.
#if defined(TRACER_BVH_BLOCK_TEST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRACER_BVH_BLOCK_TEST_INL_H_
#undef TRACER_BVH_BLOCK_TEST_INL_H_
#else
#define TRACER_BVH_BLOCK_TEST_INL_H_
#endif

#include <bit>

#include "tracer/bvh/fast_triangle-inl.h"
#include "tracer/bvh/triangle_test.h"
#include "tracer/bvh/wide_bvh.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

using BlockLanes = hn::CappedTag<float, block_size>;

template <class D, class Mask>
HWY_INLINE uint32_t bits_of(D d, Mask mask) {
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return bytes[0];
}

// The triangles of a block that the ray meets at t_min <= t <= t_max: a bit for each lane.
struct alignas(16) BlockHits {
  float t[block_size], u[block_size], v[block_size];
};

// One triangle by the scalar test; corner(axis, k).
template <class Corner>
TriangleHit test_alone(const Corner& corner, const TriangleRay& ray, float t_min, float t_max) {
  LeafTriangle padded[2] = {};  // the scalar test reads past the end
  for (int k = 0; k < 3; ++k) {
    padded[0].x[k] = corner(0, k);
    padded[0].y[k] = corner(1, k);
    padded[0].z[k] = corner(2, k);
  }
  return intersect(padded[0], ray, t_min, t_max);
}

// The lanes whose edges are zero as far as float can tell: see triangle_test.h.
inline HWY_NOINLINE uint32_t test_exactly(const TriangleBlock& block, const TriangleRay& ray,
                                          float t_min, float t_max, uint32_t lanes,
                                          BlockHits& found) {
  uint32_t hits = 0;
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const auto corner = [&](int axis, int k) { return block.corner[axis][k][lane]; };
    const TriangleHit hit = test_alone(corner, ray, t_min, t_max);
    if (!hit.hit) continue;
    hits |= 1u << lane;
    found.t[lane] = hit.t;
    found.u[lane] = hit.u;
    found.v[lane] = hit.v;
  }
  return hits;
}

// On which side of the triangles' edges a ray passes them, and how far from the corners.
struct EdgeTests {
  using V = hn::Vec<BlockLanes>;
  V a, b, c, z[3];
};

HWY_INLINE EdgeTests test_edges(const TriangleBlock& block, const ShearedRay& ray, size_t lane) {
  const BlockLanes d;
  using V = EdgeTests::V;
  EdgeTests edges;
  V(&z)[3] = edges.z;
  V x[3], y[3];
  for (int k = 0; k < 3; ++k) {
    z[k] = hn::Sub(hn::Load(d, block.corner[ray.kz][k] + lane), hn::Set(d, ray.origin[ray.kz]));
    x[k] = hn::Sub(
        hn::Sub(hn::Load(d, block.corner[ray.kx][k] + lane), hn::Set(d, ray.origin[ray.kx])),
        hn::Mul(hn::Set(d, ray.shear_x), z[k]));
    y[k] = hn::Sub(
        hn::Sub(hn::Load(d, block.corner[ray.ky][k] + lane), hn::Set(d, ray.origin[ray.ky])),
        hn::Mul(hn::Set(d, ray.shear_y), z[k]));
  }
  edges.a = hn::Sub(hn::Mul(x[2], y[1]), hn::Mul(y[2], x[1]));
  edges.b = hn::Sub(hn::Mul(x[0], y[2]), hn::Mul(y[0], x[2]));
  edges.c = hn::Sub(hn::Mul(x[1], y[0]), hn::Mul(y[1], x[0]));
  return edges;
}

// The triangles that the ray may hit: a bit for each lane.
HWY_INLINE uint32_t inside_edges(const EdgeTests& edges) {
  const BlockLanes d;
  const auto zero = hn::Zero(d);
  const auto least = hn::Min(hn::Min(edges.a, edges.b), edges.c);
  const auto most = hn::Max(hn::Max(edges.a, edges.b), edges.c);
  return bits_of(d, hn::Or(hn::Ge(least, zero), hn::Le(most, zero)));
}

// Which of the triangles `maybe`, from `lane` on, the ray hits; `exact` gets the lanes for
// test_exactly.
HWY_INLINE uint32_t hit_lanes(const TriangleBlock& block, const EdgeTests& edges, uint32_t maybe,
                              float shear_z, const BoxRay& box, float t_min, float t_max,
                              size_t lane, uint32_t& exact, BlockHits& found) {
  const BlockLanes d;
  using V = EdgeTests::V;
  const V zero = hn::Zero(d);
  const V& a = edges.a;
  const V& b = edges.b;
  const V& c = edges.c;
  exact = maybe & bits_of(d, hn::Or(hn::Or(hn::Eq(a, zero), hn::Eq(b, zero)), hn::Eq(c, zero)));
  const uint32_t hits = maybe & ~exact;
  const V determinant = hn::Add(hn::Add(a, b), c);
  const V weight_a = hn::Div(a, determinant);
  const V weight_b = hn::Div(b, determinant);
  const V weight_c = hn::Div(c, determinant);
  const V plane_t =
      hn::Mul(hn::Set(d, shear_z),
              hn::Add(hn::Add(hn::Mul(weight_a, edges.z[0]), hn::Mul(weight_b, edges.z[1])),
                      hn::Mul(weight_c, edges.z[2])));
  // Between where the ray enters and leaves the triangle's own box.
  V entry = hn::Set(d, -infinity), exit = hn::Set(d, infinity);
  for (int axis = 0; axis < 3; ++axis) {
    const V p = hn::Load(d, block.corner[axis][0] + lane);
    const V q = hn::Load(d, block.corner[axis][1] + lane);
    const V r = hn::Load(d, block.corner[axis][2] + lane);
    const V lo = hn::Sub(hn::Min(hn::Min(p, q), r), hn::Set(d, box.from_lo[axis]));
    const V hi = hn::Sub(hn::Max(hn::Max(p, q), r), hn::Set(d, box.from_hi[axis]));
    const V inverse = hn::Set(d, box.inverse[axis]);
    const V padded = hn::Set(d, box.padded[axis]);
    entry = hn::Max(entry, hn::Min(hn::Mul(lo, inverse), hn::Mul(hi, inverse)));
    exit = hn::Min(exit, hn::Max(hn::Mul(lo, padded), hn::Mul(hi, padded)));
  }
  const V t = hn::Min(hn::Max(plane_t, entry), exit);
  hn::Store(t, d, found.t + lane);
  hn::Store(weight_b, d, found.u + lane);
  hn::Store(weight_c, d, found.v + lane);
  const auto in_range = hn::And(hn::Ge(t, hn::Set(d, t_min)), hn::Le(t, hn::Set(d, t_max)));
  return hits & bits_of(d, hn::And(in_range, hn::Eq(plane_t, plane_t)));
}

HWY_INLINE uint32_t hit_triangles(const TriangleBlock& block, const FastTriangleRay& ray,
                                  float t_min, float t_max, BlockHits& found) {
  const BlockLanes d;
  using V = hn::Vec<BlockLanes>;
  uint32_t hits = 0;
  for (size_t lane = 0; lane < block_size; lane += hn::Lanes(d)) {
    Vectors3<V> to_b, to_c, from, direction;
    for (int axis = 0; axis < 3; ++axis) {
      const V corner = hn::Load(d, block.corner[axis][0] + lane);
      to_b.of[axis] = hn::Sub(hn::Load(d, block.corner[axis][1] + lane), corner);
      to_c.of[axis] = hn::Sub(hn::Load(d, block.corner[axis][2] + lane), corner);
      from.of[axis] = hn::Sub(hn::Set(d, ray.origin[axis]), corner);
      direction.of[axis] = hn::Set(d, ray.direction[axis]);
    }
    const V last = hn::Set(d, t_max);
    const auto met = fast_hits(d, to_b, to_c, from, direction, hn::Set(d, t_min), last);
    const uint32_t here = bits_of(d, met.hit);
    if (here == 0) continue;
    const V inverse = hn::Div(hn::Set(d, 1.0f), met.size);
    hn::Store(hn::Min(hn::Mul(met.t, inverse), last), d, found.t + lane);
    hn::Store(hn::Mul(met.u, inverse), d, found.u + lane);
    hn::Store(hn::Mul(met.v, inverse), d, found.v + lane);
    hits |= here << lane;
  }
  return hits;
}

// box_of() is the BoxRay, which only hits need.
template <class BoxOf>
HWY_INLINE uint32_t hit_triangles(const TriangleBlock& block, const ShearedRay& ray,
                                  const BoxOf& box_of, float t_min, float t_max, BlockHits& found) {
  uint32_t hits = 0, exact = 0;
  for (size_t lane = 0; lane < block_size; lane += hn::Lanes(BlockLanes())) {
    const EdgeTests edges = test_edges(block, ray, lane);
    const uint32_t maybe = inside_edges(edges);
    if (maybe == 0) continue;
    uint32_t on_edge = 0;
    hits |=
        hit_lanes(block, edges, maybe, ray.shear_z, box_of(), t_min, t_max, lane, on_edge, found)
        << lane;
    exact |= on_edge << lane;
  }
  if (exact != 0) [[unlikely]]
    hits |= test_exactly(block, {ray, box_of()}, t_min, t_max, exact, found);
  return hits;
}

HWY_INLINE uint32_t hit_triangles(const TriangleBlock& block, const TriangleRay& ray, float t_min,
                                  float t_max, BlockHits& found) {
  const auto box_of = [&]() -> const BoxRay& { return ray.box; };
  return hit_triangles(block, ray, box_of, t_min, t_max, found);
}

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
