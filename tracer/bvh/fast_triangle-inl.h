// The fast triangle test of triangle_test.h in the lanes of vectors: one ray and several triangles,
// or several rays and one triangle (T. Möller, B. Trumbore, Fast Minimum Storage Ray/Triangle
// Intersection, 1997). Compiled once for each instruction set.
#if defined(TRACER_BVH_FAST_TRIANGLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRACER_BVH_FAST_TRIANGLE_INL_H_
#undef TRACER_BVH_FAST_TRIANGLE_INL_H_
#else
#define TRACER_BVH_FAST_TRIANGLE_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// By axis.
template <class V>
struct Vectors3 {
  V of[3];
};

template <class V>
HWY_INLINE V dot(const Vectors3<V>& a, const Vectors3<V>& b) {
  return hn::MulAdd(a.of[0], b.of[0], hn::MulAdd(a.of[1], b.of[1], hn::Mul(a.of[2], b.of[2])));
}
template <class V>
HWY_INLINE Vectors3<V> cross(const Vectors3<V>& a, const Vectors3<V>& b) {
  const auto along = [&](int i, int j) HWY_ATTR {
    return hn::MulSub(a.of[i], b.of[j], hn::Mul(a.of[j], b.of[i]));
  };
  return {{along(1, 2), along(2, 0), along(0, 1)}};
}

// t, u and v are multiples of `size`: most triangles are missed, and divide nothing.
template <class D>
struct FastHits {
  hn::Mask<D> hit;
  hn::Vec<D> size, t, u, v;
};

// A triangle by its first corner and its edges from there; the origin as seen from that corner.
template <class D, class V = hn::Vec<D>>
HWY_INLINE FastHits<D> fast_hits(D d, const Vectors3<V>& to_b, const Vectors3<V>& to_c,
                                 const Vectors3<V>& from, const Vectors3<V>& direction, V t_min,
                                 V t_max) {
  const V zero = hn::Zero(d);
  const Vectors3<V> p = cross(direction, to_c);
  const Vectors3<V> q = cross(from, to_b);
  const V determinant = dot(to_b, p);
  const V sign = hn::And(determinant, hn::SignBit(d));
  FastHits<D> found;
  found.size = hn::Xor(determinant, sign);
  found.u = hn::Xor(dot(from, p), sign);
  found.v = hn::Xor(dot(direction, q), sign);
  found.t = hn::Xor(dot(to_c, q), sign);
  const auto inside = hn::And(hn::Ge(hn::Min(found.u, found.v), zero),
                              hn::Le(hn::Add(found.u, found.v), found.size));
  const auto in_range = hn::And(hn::Ge(found.t, hn::Mul(t_min, found.size)),
                                hn::Le(found.t, hn::Mul(t_max, found.size)));
  found.hit = hn::And(hn::And(inside, in_range), hn::Gt(found.size, zero));
  return found;
}

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
