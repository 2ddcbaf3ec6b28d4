// The sky: what a ray sees that hits nothing.
#pragma once

#include <span>
#include <string>

#include "tracer/math/types.h"
#include "tracer/scene/texels.h"

namespace tracer {

// Equirectangular, linear radiance; row 0 looks up (+y), column 0 and the last one look to -x, the
// middle column to +x... see places in sky.cpp.
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

// Linear radiance from each direction (any length; none from one that is zero or not finite), into
// a span of the same length. Depends on the direction alone.
void sky_radiance(const SkyImage& image, const SkySettings& settings,
                  std::span<const vec3> directions, std::span<vec3> radiance);

}  // namespace tracer
