// Point lights.
#pragma once

#include <string>

#include "tracer/math/types.h"

namespace tracer {

// Irradiance at distance d is color * intensity * cos / d^2.
struct Light {
  std::string name = "light";
  vec3 position{0.0f, 5.0f, 0.0f};
  vec3 color{1.0f};
  float intensity = 1.0f;
  bool on = true;

  bool operator==(const Light&) const = default;
};

}  // namespace tracer
