// Mrays/s as it is shown everywhere.
#pragma once

#include "tracer/pipeline.h"

namespace ui {

inline constexpr const char* speed_help =
    "Millions of rays of this class that one thread traverses in a second, without shading; taken "
    "from the passes that count nothing";

// 0 if nothing has been measured.
inline double mrays_per_second(const tracer::RayRate& rate) {
  return rate.seconds > 0.0 ? 1e-6 * static_cast<double>(rate.rays) / rate.seconds : 0.0;
}

}  // namespace ui
