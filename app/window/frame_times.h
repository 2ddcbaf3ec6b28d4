// How long the window's frames took.
#pragma once

#include <string>
#include <vector>

namespace app {

struct FrameTimes {
  std::vector<float> tracing;  // milliseconds, of frames during which the session was busy
  std::vector<float> idle;
};

// "tracing: 300 frames, mean 8.1 ms, p95 12.0 ms, max 20.5 ms", and a line for idle.
std::string to_text(const FrameTimes& times);

}  // namespace app
