// Primary rays side by side. Compiled once for each instruction set, with the same result.
#include <array>
#include <bit>
#include <cassert>

#include "tracer/math/rows.h"
#include "tracer/math/shading_targets.h"
#include "tracer/scene/camera.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/scene/primary_rays.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// What differs between rays: their directions or, seen orthographically, their origins; by
// component. Step by step as primary_ray: the same to the bit.
template <size_t count>
HWY_INLINE void place_rays(const CameraFrame& frame, const vec2* pixels,
                           std::array<std::array<float, count>, 3>& places) {
  const hn::CappedTag<float, count> d;
  const auto is = [d](float value) HWY_ATTR { return hn::Set(d, value); };
  const auto on_plane = [&](auto pixel, float resolution, float half_size) HWY_ATTR {
    const auto twice = hn::Mul(hn::Div(pixel, is(resolution)), is(2.0f));
    return hn::Mul(hn::Sub(twice, is(1.0f)), is(half_size));
  };
  const vec3& middle = frame.orthographic ? frame.eye : frame.forward;
  for (size_t lane = 0; lane < count; lane += hn::Lanes(d)) {
    auto column = hn::Zero(d), row = hn::Zero(d);
    hn::LoadInterleaved2(d, &pixels[lane].x, column, row);
    const auto across = on_plane(column, frame.resolution.x, frame.half_size.x);
    const auto up = on_plane(row, frame.resolution.y, -frame.half_size.y);
    const auto place = [&](int axis) HWY_ATTR {
      const auto offset =
          hn::Add(hn::Mul(is(frame.right[axis]), across), hn::Mul(is(frame.up[axis]), up));
      return hn::Add(is(middle[axis]), offset);
    };
    const auto x = place(0), y = place(1), z = place(2);
    const auto square = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
    const auto scale = frame.orthographic ? is(1.0f) : hn::Div(is(1.0f), hn::Sqrt(square));
    hn::StoreU(hn::Mul(x, scale), d, &places[0][lane]);
    hn::StoreU(hn::Mul(y, scale), d, &places[1][lane]);
    hn::StoreU(hn::Mul(z, scale), d, &places[2][lane]);
  }
}

void make_primary_rays(const CameraFrame& frame, std::span<const vec2> pixels,
                       std::span<Ray> rays) {
  constexpr size_t count = 8;
  const Ray usual;
  const auto row = [](const vec3& v, float fourth) { return float4{v.x, v.y, v.z, fourth}; };
  const float4 origin = row(frame.eye, usual.t_min);
  const float4 direction = row(frame.forward, usual.t_max);
  std::array<std::array<float, count>, 3> places;
  size_t first = 0;
  for (; first + count <= pixels.size(); first += count) {
    place_rays<count>(frame, &pixels[first], places);
    for (size_t four = 0; four < count; four += 4) {
      const auto found =
          rows(load4(&places[0][four]), load4(&places[1][four]), load4(&places[2][four]),
               broadcast(frame.orthographic ? usual.t_min : usual.t_max));
      for (size_t i = 0; i < 4; ++i)
        rays[first + four + i] = std::bit_cast<Ray>(
            frame.orthographic ? std::array{found[i], direction} : std::array{origin, found[i]});
    }
  }
  for (; first < pixels.size(); ++first)
    rays[first] = primary_ray(frame, pixels[first]);
}

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tracer {

HWY_EXPORT(make_primary_rays);

void primary_rays(const CameraFrame& frame, std::span<const vec2> pixels, std::span<Ray> rays) {
  assert(pixels.size() == rays.size());
  HWY_DYNAMIC_DISPATCH(make_primary_rays)(frame, pixels, rays);
}

}  // namespace tracer
#endif
