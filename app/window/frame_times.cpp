#include "app/window/frame_times.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace app {
namespace {

std::string line(const char* what, std::vector<float> times) {
  if (times.empty()) return fmt::format("{}: none\n", what);
  std::sort(times.begin(), times.end());
  const double mean = std::accumulate(times.begin(), times.end(), 0.0) / double(times.size());
  const float p95 = times[(times.size() * 95 + 99) / 100 - 1];  // nearest rank
  return fmt::format("{}: {}, mean {:.1f} ms, p95 {:.1f} ms, max {:.1f} ms\n", what, times.size(),
                     mean, p95, times.back());
}

}  // namespace

std::string to_text(const FrameTimes& times) {
  return line("frames while tracing", times.tracing) + line("frames while idle", times.idle) +
         line("pictures coloured", times.pictures);
}

}  // namespace app
