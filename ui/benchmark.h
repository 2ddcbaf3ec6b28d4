// The parts of the Benchmark panel.
#pragma once

#include "ui/workspace_state.h"

namespace ui {

// What the ticks ask for.
BenchmarkRequest wanted_benchmark(const Frame& frame);

// A click makes a row's builder and layout those of the scene, and its kernel that of its class of
// rays if the picture has such rays.
void draw_ray_timings(Frame& frame, const tracer::Benchmark& benchmark);
void draw_build_timings(Frame& frame, const tracer::Benchmark& benchmark);

}  // namespace ui
