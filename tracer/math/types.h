// The vector types (GLM) and constants that the whole library uses.
#pragma once

#include <cstdint>
#include <limits>

#include <glm/glm.hpp>

namespace tracer {

using glm::ivec2;
using glm::mat3;
using glm::mat4;
using glm::uvec3;
using glm::vec2;
using glm::vec3;
using glm::vec4;

inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr float pi = 3.14159265358979f;
inline constexpr uint32_t none = 0xffffffffu;  // "no index"

}  // namespace tracer
