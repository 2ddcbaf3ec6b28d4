// How instances move.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "tracer/math/box.h"

namespace tracer {

// How an instance moves with time t in seconds: it turns about its own +y axis through `pivot`
// (object space) and bounces along the world's +y by bounce_height * |sin(bounce_rate * t +
// phase)|.
struct Motion {
  float spin = 0.0f;           // radians a second
  float bounce_height = 0.0f;  // world units
  float bounce_rate = 0.0f;    // radians a second
  float phase = 0.0f;          // radians
  vec3 pivot{0.0f};

  bool operator==(const Motion&) const = default;
};

// What all instances do, whatever the scene says.
struct InstanceMotion {
  std::string kind = "scene";  // id of a MotionRow
  float speed = 0.25f;         // turns or bounces a second, 0..max_motion_speed

  bool operator==(const InstanceMotion&) const = default;
};
inline constexpr float max_motion_speed = 10.0f;

struct MotionRow {
  std::string_view id, label, help;
  bool uses_speed = false;
  // mesh: the box in object space; nullptr: the instance's own
  Motion (*motion)(const Box& mesh, const mat4& to_world, float speed) = nullptr;
};
std::span<const MotionRow> motions();

// The motion of an instance that has one of its own; an unknown choice leaves it that.
Motion chosen(const InstanceMotion& choice, const Motion& own, const Box& mesh,
              const mat4& to_world);

// Object to world at a time in seconds.
mat4 pose(const mat4& to_world, const Motion& motion, float time);

}  // namespace tracer
