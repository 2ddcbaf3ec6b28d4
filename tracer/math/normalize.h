// Lengths and directions of vectors of any size: squares of 1e-25 or 1e25 do not fit into a float.
#pragma once

#include <algorithm>
#include <cmath>

#include "tracer/math/types.h"

namespace tracer {

inline float max_component(const vec3& v) {
  return std::max(std::max(v.x, v.y), v.z);
}

// Of the square of a length: nothing has been lost to the ends of float's range.
inline bool is_moderate(float square) {
  return square > 1e-30f && square < 1e30f;
}

inline float safe_length(const vec3& v) {
  const float square = glm::dot(v, v);
  if (is_moderate(square)) return std::sqrt(square);
  const float size = max_component(glm::abs(v));
  return size > 0.0f ? size * glm::length(v / size) : 0.0f;
}
// `otherwise` where v has no direction.
inline vec3 safe_normalize(const vec3& v, const vec3& otherwise) {
  const float square = glm::dot(v, v);
  if (is_moderate(square)) return v * (1.0f / std::sqrt(square));
  const float size = max_component(glm::abs(v));
  if (!(size > 0.0f) || !std::isfinite(size)) return otherwise;
  return glm::normalize(v / size);
}

}  // namespace tracer
