// A ray and what it hits.
#pragma once

#include "tracer/math/types.h"

namespace tracer {

// Points origin + t * direction with t_min <= t <= t_max. The direction may have any length; t is
// measured in units of it.
struct Ray {
  vec3 origin{0.0f};
  float t_min = 0.0f;
  vec3 direction{0.0f, 0.0f, 1.0f};
  float t_max = infinity;
};

// u and v are the barycentric weights of the triangle's second and third corner.
struct Hit {
  float t = infinity;
  float u = 0.0f;
  float v = 0.0f;
  uint32_t triangle = none;  // index in the mesh
  uint32_t instance = none;  // index in the scene

  bool operator==(const Hit&) const = default;
};

inline bool is_hit(const Hit& hit) {
  return hit.instance != none;
}

// What a ray was cast for. Every counter exists once for each class.
enum class RayClass : uint8_t { primary, shadow, reflection, refraction };
inline constexpr int ray_class_count = 4;

}  // namespace tracer
