// The way a row of the Benchmark panel was built and traced, and the scene's.
#pragma once

#include <string>

#include "tracer/analyze/benchmark.h"
#include "tracer/bvh/counters.h"
#include "tracer/settings.h"

namespace ui {

// What a click on a row chooses for the scene.
struct BenchmarkWay {
  std::string builder, layout;
  std::string kernel = {};
  const tracer::RayClassRow* ray_class = nullptr;  // that the kernel is for; none: it is left out
  bool traces = false;                             // a row of rays
  bool fast = false;                               // by fast tests
};

BenchmarkWay way_of(const tracer::BuildTiming& row);
BenchmarkWay way_of(const tracer::RayTiming& row);

// Leaves alone what the row says nothing of.
void choose(const BenchmarkWay& way, tracer::Settings& settings);

// Whether the scene is built and traced this way now; automatic: by whatever kernel the renderer
// picks.
enum class Presence { other, automatic, chosen };
Presence presence(const BenchmarkWay& way, const tracer::Settings& settings);

// What a click on the row would do, or that it is so already.
std::string click_help(const BenchmarkWay& way, Presence present);

}  // namespace ui
