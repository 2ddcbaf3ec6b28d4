// The angle of a direction in the plane, without the care of the standard library's for the last
// bit: absolute error below 4e-7 rad, a fifth of the time.
#pragma once

#include <algorithm>
#include <cmath>

#include "tracer/math/types.h"

namespace tracer {

// As std::atan2 for finite arguments, in [-pi, pi]; 0 for (0, 0). The polynomial is 4.4.49 of
// M. Abramowitz, I. Stegun, Handbook of Mathematical Functions, 1964.
inline float fast_atan2(float y, float x) {
  const float across = std::abs(x), up = std::abs(y);
  const float larger = std::max(across, up);
  if (!(larger > 0.0f)) return 0.0f;
  const float ratio = std::min(across, up) / larger;
  const float square = ratio * ratio;
  float sum = 0.0028662257f;
  for (const float next : {-0.0161657367f, 0.0429096138f, -0.0752896400f, 0.1065626393f,
                           -0.1420889944f, 0.1999355085f, -0.3333314528f, 1.0f}) {
    sum = sum * square + next;
  }
  float angle = ratio * sum;
  if (up > across) angle = 0.5f * pi - angle;
  if (x < 0.0f) angle = pi - angle;
  return std::copysign(angle, y);
}

}  // namespace tracer
