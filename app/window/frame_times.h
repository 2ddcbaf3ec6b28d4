// How long the window's frames and the painter's pictures took.
#pragma once

#include <string>
#include <vector>

namespace app {

struct FrameTimes {
  std::vector<float> tracing;  // milliseconds, of frames during which the session was busy
  std::vector<float> idle;
  std::vector<float> pictures;  // from facts to colours, beside the frames
};

// "frames while tracing: 300, mean 8.1 ms, p95 12.0 ms, max 20.5 ms", and a line for each other.
std::string to_text(const FrameTimes& times);

}  // namespace app
