// The sky: an equirectangular image, looked up by direction alone. Compiled once for each
// instruction set, with the same result.
#include "tracer/scene/sky.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "tracer/math/shading_targets.h"
#include "tracer/math/simd.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/scene/sky.cpp"
#include <hwy/foreach_target.h>

#include "tracer/math/arc_tangent-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, 8>;
inline constexpr size_t lanes = hn::MaxLanes(Lanes());

// Where directions are in the image: the texels left of and above them, how far away the next ones
// are, in texels, and how much of the way to those.
struct alignas(64) Places {
  static constexpr size_t most = 64;
  int32_t texel[most], to_right[most], to_lower[most];
  float across[most], down[most];
  float weight[most];  // of what is there: none for a direction that is none
};

// +y is the upper edge; +x is the middle, +z right of it, -x both ends.
HWY_INLINE void find_places(const vec3* directions, const SkyImage& image, float rotation,
                            float intensity, Places& to, size_t at) {
  const Lanes d;
  const hn::RebindToSigned<Lanes> di;
  const auto is = [d](float value) HWY_ATTR { return hn::Set(d, value); };
  const auto zero = hn::Zero(d), half = is(0.5f), one = is(1.0f);
  auto x = zero, y = zero, z = zero;
  hn::LoadInterleaved3(d, &directions->x, x, y, z);
  const auto largest = hn::Max(hn::Max(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
  const auto products = hn::Add(hn::Add(hn::Mul(x, zero), hn::Mul(y, zero)), hn::Mul(z, zero));
  const auto valid = hn::And(hn::Eq(products, zero), hn::Gt(largest, zero));
  // Scaled first: the length of very short and very long directions would leave float's range.
  const auto scale = hn::Div(one, hn::Max(largest, is(std::numeric_limits<float>::min())));
  x = hn::Mul(x, scale);
  y = hn::Mul(y, scale);
  z = hn::Mul(z, scale);
  const auto azimuth = hn::Add(fast_atan2(d, z, x), is(rotation));
  const auto from_up = fast_atan2(d, hn::Sqrt(hn::Add(hn::Mul(x, x), hn::Mul(z, z))), y);
  const auto turns = hn::Add(half, hn::Mul(azimuth, is(0.5f / pi)));
  // In texels; (0, 0) is the middle of the upper left one, so the first column begins at -0.5.
  const auto columns = is(float(image.width)), last_row = is(float(image.height - 1));
  const auto at_x = hn::Sub(hn::Mul(hn::Sub(turns, hn::Floor(turns)), columns), half);
  const auto at_y = hn::Sub(hn::Mul(from_up, is(float(image.height) / pi)), half);
  const auto x_or_none = hn::IfThenElseZero(valid, at_x);
  const auto y_or_none = hn::IfThenElseZero(valid, hn::Min(hn::Max(at_y, zero), last_row));
  const auto left = hn::Floor(x_or_none), row = hn::Floor(y_or_none);
  const auto last = hn::Sub(columns, one);
  const auto column = hn::IfThenElse(hn::Lt(left, zero), last, left);
  const auto width = hn::Set(di, int32_t(image.width));
  const auto first = hn::Mul(hn::ConvertTo(di, row), width);
  hn::Store(hn::Add(first, hn::ConvertTo(di, column)), di, &to.texel[at]);
  const auto is_last = hn::RebindMask(di, hn::Eq(column, last));
  hn::Store(hn::IfThenElse(is_last, hn::Sub(hn::Set(di, 1), width), hn::Set(di, 1)), di,
            &to.to_right[at]);
  hn::Store(hn::IfThenZeroElse(hn::RebindMask(di, hn::Eq(row, last_row)), width), di,
            &to.to_lower[at]);
  hn::Store(hn::Sub(x_or_none, left), d, &to.across[at]);
  hn::Store(hn::Sub(y_or_none, row), d, &to.down[at]);
  hn::Store(hn::IfThenElseZero(valid, is(intensity)), d, &to.weight[at]);
}

// Of two neighbours in a row; the fourth lane is anything.
HWY_INLINE float4 mix(const vec3* left, int32_t to_right, float4 across) {
  float4 a, b;
  if (to_right == 1) {
    a = load4(&left->x);
    const float4 from_z = load4(&left->z);
    b = __builtin_shufflevector(from_z, from_z, 1, 2, 3, 3);
  } else {
    a = load3(*left);
    b = load3(left[to_right]);
  }
  return a + across * (b - a);
}

HWY_INLINE float4 look_up(const vec3* texels, const Places& at, size_t lane) {
  const float4 across = broadcast(at.across[lane]);
  const vec3* const left = texels + at.texel[lane];
  const float4 above = mix(left, at.to_right[lane], across);
  const float4 below = mix(left + at.to_lower[lane], at.to_right[lane], across);
  return broadcast(at.weight[lane]) * (above + broadcast(at.down[lane]) * (below - above));
}

// All places of a good many first: what one takes is long, and none waits for another.
void look_up_all(const SkyImage& image, float rotation, float intensity,
                 std::span<const vec3> directions, std::span<vec3> radiance) {
  Places places;
  for (size_t first = 0; first < directions.size(); first += Places::most) {
    const size_t count = std::min(directions.size() - first, Places::most);
    const size_t rest = count % lanes, whole = count - rest;
    for (size_t i = 0; i < whole; i += lanes)
      find_places(&directions[first + i], image, rotation, intensity, places, i);
    if (rest != 0) {
      std::array<vec3, lanes> last{};
      std::ranges::copy(directions.subspan(first + whole, rest), last.begin());
      find_places(last.data(), image, rotation, intensity, places, whole);
    }
    for (size_t i = 0; i < count; ++i)
      radiance[first + i] = xyz(look_up(image.texels.data(), places, i));
  }
}

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tracer {

HWY_EXPORT(look_up_all);

void sky_radiance(const SkyImage& image, const SkySettings& settings,
                  std::span<const vec3> directions, std::span<vec3> radiance) {
  assert(directions.size() == radiance.size());
  if (!settings.on || image.texels.empty()) {
    std::ranges::fill(radiance,
                      settings.on ? settings.flat_color * settings.intensity : vec3(0.0f));
    return;
  }
  const float rotation = settings.rotation_degrees * (pi / 180.0f);
  HWY_DYNAMIC_DISPATCH(look_up_all)(image, rotation, settings.intensity, directions, radiance);
}

}  // namespace tracer
#endif
