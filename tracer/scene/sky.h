// The sky: what a ray sees that hits nothing.
#pragma once

#include <string>

#include "tracer/math/types.h"
#include "tracer/scene/texels.h"

namespace tracer {

// Equirectangular, linear radiance; row 0 looks up (+y), column 0 and the last one look to -x, the
// middle column to +x... see direction_to_uv in sky.cpp.
struct SkyImage {
  std::string name;
  uint32_t width = 0;
  uint32_t height = 0;
  Texels<vec3> texels;  // width * height, or none: the sky is then SkySettings::flat_color
};

struct SkySettings {
  bool on = true;
  float rotation_degrees = 0.0f;  // about +y
  float intensity = 1.0f;
  vec3 flat_color{0.6f, 0.7f, 0.9f};

  bool operator==(const SkySettings&) const = default;
};

// Linear radiance from direction (any length, not zero). Depends on the direction alone.
vec3 sky_radiance(const SkyImage& image, const SkySettings& settings, vec3 direction);

}  // namespace tracer
