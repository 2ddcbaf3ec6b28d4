// Whitted-style ray tracing (T. Whitted, An Improved Illumination Model for Shaded Display, 1980):
// direct light from points, recursive mirrors and glass, a sky where nothing is hit.
#pragma once

#include "tracer/bvh/scene_bvh.h"
#include "tracer/render/counters.h"
#include "tracer/settings.h"

namespace tracer {

// Everything that light transport reads. The referenced objects outlive it.
struct World {
  const Scene& scene;
  const SceneBvh& bvh;
  const Look& look;
  const RenderOptions& options;
};

struct Radiance {
  vec3 color{0.0f};
  Hit hit;        // of the primary ray
  int depth = 0;  // bounces of the deepest ray
};

// Counting fills `counters`; not counting only counts rays (a class) into it.
Radiance trace_counting(const World& world, const Ray& primary, ClassCounters& counters);
Radiance trace_fast(const World& world, const Ray& primary, ClassCounters& counters);

}  // namespace tracer
