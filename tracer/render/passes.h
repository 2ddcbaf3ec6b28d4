// Whole passes over a film with all threads, for measurements; the pipeline goes tile by tile,
// since it shows what is there so far.
#pragma once

#include <stop_token>

#include "tracer/render/trace_film.h"

namespace tracer {

// Pass 0, counting. Stopped: some tiles are missing.
Film first_pass(const World& world, const CameraFrame& camera, const std::stop_token& stop);

// One more sample for each pixel of a film whose pass 0 is complete, without counting. Stopped:
// some tiles have it.
RayRates next_pass(const World& world, const CameraFrame& camera, Film& film,
                   const std::stop_token& stop);

}  // namespace tracer
