// The sky: an equirectangular image, looked up by direction alone.
#include "tracer/scene/sky.h"

#include <algorithm>
#include <cmath>

#include "tracer/math/arc_tangent.h"

namespace tracer {
namespace {

// (0,0) is the image's upper left. +y is the upper edge; +x is the middle, +z right of it, -x both
// ends. The components of the direction are at most 1.
vec2 direction_to_uv(const vec3& direction, float rotation) {
  const float azimuth = fast_atan2(direction.z, direction.x) + rotation;
  const float level = std::sqrt(direction.x * direction.x + direction.z * direction.z);
  return vec2(0.5f + azimuth * (0.5f / pi), fast_atan2(level, direction.y) * (1.0f / pi));
}

}  // namespace

vec3 sky_radiance(const SkyImage& image, const SkySettings& settings, vec3 direction) {
  if (!settings.on) return vec3(0.0f);
  if (image.texels.empty()) return settings.flat_color * settings.intensity;
  // Scaled first: the length of very short and very long directions would leave float's range.
  const vec3 size = glm::abs(direction);
  const float largest = std::max({size.x, size.y, size.z});
  if (!(largest > 0.0f) || !std::isfinite(largest)) return vec3(0.0f);
  const vec2 uv = direction_to_uv(direction / largest, settings.rotation_degrees * (pi / 180.0f));

  const float turn = uv.x - std::floor(uv.x);
  const float x = turn * float(image.width) - 0.5f;
  const float y = std::clamp(uv.y * float(image.height) - 0.5f, 0.0f, float(image.height - 1));
  const int32_t left = int32_t(std::floor(x));
  const uint32_t column = left < 0 ? image.width - 1 : std::min(uint32_t(left), image.width - 1);
  const uint32_t next_column = column + 1 == image.width ? 0 : column + 1;
  const uint32_t row = uint32_t(y);
  const uint32_t next_row = std::min(row + 1, image.height - 1);
  const float weight_x = x - std::floor(x);
  const float weight_y = y - float(row);
  const vec3* const upper = image.texels.data() + size_t(row) * image.width;
  const vec3* const lower = image.texels.data() + size_t(next_row) * image.width;
  const vec3 above = glm::mix(upper[column], upper[next_column], weight_x);
  const vec3 below = glm::mix(lower[column], lower[next_column], weight_x);
  return settings.intensity * glm::mix(above, below, weight_y);
}

}  // namespace tracer
