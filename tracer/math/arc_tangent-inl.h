// The angle of a direction in the plane, without the care of the standard library's for the last
// bit: absolute error below 4e-7 rad, a vector at a time. Compiled once for each instruction set,
// with the same result.
#if defined(TRACER_MATH_ARC_TANGENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRACER_MATH_ARC_TANGENT_INL_H_
#undef TRACER_MATH_ARC_TANGENT_INL_H_
#else
#define TRACER_MATH_ARC_TANGENT_INL_H_
#endif

#include <hwy/highway.h>

#include "tracer/math/types.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

// As std::atan2 for finite floats, in [-pi, pi]; 0 for (0, 0). The polynomial is 4.4.49 of
// M. Abramowitz, I. Stegun, Handbook of Mathematical Functions, 1964.
template <class D, class V = hwy::HWY_NAMESPACE::Vec<D>>
HWY_INLINE V fast_atan2(D d, V y, V x) {
  namespace hn = hwy::HWY_NAMESPACE;
  const auto is = [d](float value) HWY_ATTR { return hn::Set(d, value); };
  const V across = hn::Abs(x), up = hn::Abs(y);
  // A larger one of 0 leaves a ratio of 0.
  const V larger = hn::Max(hn::Max(across, up), is(std::numeric_limits<float>::min()));
  const V ratio = hn::Div(hn::Min(across, up), larger);
  const V square = hn::Mul(ratio, ratio);
  // After the 1, and in halves that do not wait for each other.
  const V fourth = hn::Mul(square, square);
  const auto of_pair = [&](float low, float high)
                           HWY_ATTR { return hn::Add(is(low), hn::Mul(is(high), square)); };
  const V low = hn::Add(of_pair(-0.3333314528f, 0.1999355085f),
                        hn::Mul(of_pair(-0.1420889944f, 0.1065626393f), fourth));
  const V high = hn::Add(of_pair(-0.0752896400f, 0.0429096138f),
                         hn::Mul(of_pair(-0.0161657367f, 0.0028662257f), fourth));
  const V sum = hn::Add(low, hn::Mul(high, hn::Mul(fourth, fourth)));
  V angle = hn::Add(ratio, hn::Mul(hn::Mul(ratio, square), sum));
  angle = hn::IfThenElse(hn::Gt(up, across), hn::Sub(is(0.5f * pi), angle), angle);
  angle = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(is(pi), angle), angle);
  return hn::CopySignToAbs(angle, y);
}

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
