// The sky: an equirectangular image, looked up by direction alone.
#include "tracer/scene/sky.h"

#include <algorithm>
#include <cassert>

#include "tracer/math/arc_tangent.h"

namespace tracer {
namespace {

// Where four directions are in the image, in texels; (0,0) is the middle of the upper left one.
struct Places {
  float4 x, y;
  int valid;  // a bit for each
};

// +y is the upper edge; +x is the middle, +z right of it, -x both ends.
Places places(float4 x, float4 y, float4 z, const SkyImage& image, float rotation) {
  const float4 zero{};
  // Scaled first: the length of very short and very long directions would leave float's range.
  const float4 largest = max(max(abs(x), abs(y)), abs(z));
  const int finite = mask_bits(x * zero + y * zero + z * zero == zero);
  x /= largest;
  y /= largest;
  z /= largest;
  const float4 azimuth = fast_atan2(z, x) + broadcast(rotation);
  const float4 from_up = fast_atan2(sqrt(x * x + z * z), y);
  const float4 turns = broadcast(0.5f) + azimuth * broadcast(0.5f / pi);
  const float4 row = from_up * broadcast(float(image.height) / pi) - broadcast(0.5f);
  return {(turns - floor(turns)) * broadcast(float(image.width)) - broadcast(0.5f),
          min(max(row, zero), broadcast(float(image.height - 1))),
          finite & mask_bits(largest > zero)};
}

// Between the four texels around a place.
vec3 look_up(const SkyImage& image, float x, float y) {
  const auto left = int32_t(x + 1.0f) - 1;  // x is at least -0.5
  const uint32_t column = left < 0 ? image.width - 1 : std::min(uint32_t(left), image.width - 1);
  const uint32_t next_column = column + 1 == image.width ? 0 : column + 1;
  const auto row = uint32_t(y);
  const uint32_t next_row = std::min(row + 1, image.height - 1);
  const float4 across = broadcast(x - float(left));
  const float4 down = broadcast(y - float(row));
  const auto between = [&](const vec3* texels) {
    const float4 first = load3(texels[column]);
    return first + across * (load3(texels[next_column]) - first);
  };
  const float4 above = between(image.texels.data() + size_t(row) * image.width);
  const float4 below = between(image.texels.data() + size_t(next_row) * image.width);
  return xyz(above + down * (below - above));
}

}  // namespace

void sky_radiance(const SkyImage& image, const SkySettings& settings,
                  std::span<const vec3> directions, std::span<vec3> radiance) {
  assert(directions.size() == radiance.size());
  if (!settings.on || image.texels.empty()) {
    std::ranges::fill(radiance,
                      settings.on ? settings.flat_color * settings.intensity : vec3(0.0f));
    return;
  }
  constexpr size_t lanes = 4;
  for (size_t i = 0; i < directions.size(); i += lanes) {
    const size_t count = std::min(lanes, directions.size() - i);
    float of_axis[3][lanes] = {};
    for (size_t lane = 0; lane < count; ++lane)
      for (int axis = 0; axis < 3; ++axis)
        of_axis[axis][lane] = directions[i + lane][axis];
    const Places at = places(load4(of_axis[0]), load4(of_axis[1]), load4(of_axis[2]), image,
                             settings.rotation_degrees * (pi / 180.0f));
    for (size_t lane = 0; lane < count; ++lane) {
      const bool valid = (at.valid >> lane & 1) != 0;
      radiance[i + lane] =
          valid ? settings.intensity * look_up(image, at.x[lane], at.y[lane]) : vec3(0.0f);
    }
  }
}

}  // namespace tracer
