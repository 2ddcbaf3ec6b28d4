// Update strategies: what happens to the trees of meshes that change their shape from frame to
// frame.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "tracer/math/types.h"

namespace tracer {

struct UpdateOptions {
  std::string strategy = "refit";   // id of an UpdateRow
  uint32_t every = 8;               // frames from one build to the next, 1..max_every
  float growth = 1.5f;              // of the SAH since the build, 1.01..max_growth
  float frames_per_second = 30.0f;  // of the animation, 1..max_frame_rate

  bool operator==(const UpdateOptions&) const = default;
};
inline constexpr uint32_t max_every = 10000;
inline constexpr float min_growth = 1.01f, max_growth = 100.0f;
inline constexpr float max_frame_rate = 240.0f;

struct UpdateRow {
  std::string_view id, label, help;
  bool uses_every = false, uses_growth = false;  // which of the options it reads
};
std::span<const UpdateRow> updates();

// Throws Error for an unknown strategy or an option outside its range.
void check(const UpdateOptions& options);

}  // namespace tracer
