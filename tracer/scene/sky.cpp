// The sky: an equirectangular image, looked up by direction alone.
#include "tracer/scene/sky.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "tracer/math/arc_tangent.h"
#include "tracer/math/axes.h"

namespace tracer {
namespace {

// Where four directions are in the image: between the texels of two columns and two rows, and how
// far on the way to the second ones.
struct Places {
  int4 column, next_column, row, next_row;
  float4 across, down;
  int valid;  // a bit for each
};

int4 whole(float4 a) {
  return __builtin_convertvector(a, int4);
}

// +y is the upper edge; +x is the middle, +z right of it, -x both ends.
Places places(Axes direction, const SkyImage& image, float rotation) {
  auto& [x, y, z] = direction;
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
  // In texels; (0, 0) is the middle of the upper left one, so the first column begins at -0.5.
  const float4 at_x = (turns - floor(turns)) * broadcast(float(image.width)) - broadcast(0.5f);
  const float4 at_y =
      min(max(from_up * broadcast(float(image.height) / pi) - broadcast(0.5f), zero),
          broadcast(float(image.height - 1)));

  const auto last_column = int(image.width) - 1, last_row = int(image.height) - 1;
  const int4 left = whole(at_x + broadcast(1.0f)) - 1;
  const int4 inside = left > last_column ? int4{} + last_column : left;
  const int4 column = left < 0 ? int4{} + last_column : inside;
  const int4 row = whole(at_y);
  return {column,
          column == last_column ? int4{} : column + 1,
          row,
          row == last_row ? row : row + 1,
          at_x - __builtin_convertvector(left, float4),
          at_y - __builtin_convertvector(row, float4),
          finite & mask_bits(largest > zero)};
}

// Of one of the four.
float4 look_up(const SkyImage& image, const Places& at, size_t lane) {
  const float4 across = broadcast(at.across[lane]);
  const auto between = [&](int row) {
    const vec3* texels = image.texels.data() + size_t(row) * image.width;
    const float4 first = load3(texels[at.column[lane]]);
    return first + across * (load3(texels[at.next_column[lane]]) - first);
  };
  const float4 above = between(at.row[lane]);
  const float4 below = between(at.next_row[lane]);
  return above + broadcast(at.down[lane]) * (below - above);
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
  const float4 intensity = broadcast(settings.intensity);
  const float rotation = settings.rotation_degrees * (pi / 180.0f);
  for (size_t i = 0; i < directions.size(); i += lanes) {
    const size_t count = std::min(lanes, directions.size() - i);
    std::array<vec3, lanes> last{};
    if (count < lanes) std::copy_n(&directions[i], count, last.begin());
    const Places at =
        places(axes_of(count < lanes ? last.data() : &directions[i]), image, rotation);
    for (size_t lane = 0; lane < count; ++lane) {
      const bool valid = (at.valid >> lane & 1) != 0;
      radiance[i + lane] = valid ? xyz(intensity * look_up(image, at, lane)) : vec3(0.0f);
    }
  }
}

}  // namespace tracer
