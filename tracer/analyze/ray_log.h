// One pixel's rays, each with every step of its traversal.
#pragma once

#include <memory>
#include <vector>

#include "tracer/bvh/probe.h"
#include "tracer/render/whitted.h"

namespace tracer {

struct LoggedRay {
  CastRay cast;  // parent: an index in RayLog::rays
  Counters counters;
  std::vector<Step> steps;
};

struct RayLog {
  std::shared_ptr<const SceneBvh> bvh;
  ivec2 pixel{0};
  std::vector<LoggedRay> rays;  // the primary ray first; a ray comes after the one it was cast from
};

// The rays of the sample through the pixel's centre, as pass 0 traced them. The pixel is inside the
// picture.
RayLog log_pixel(const World& world, const std::shared_ptr<const SceneBvh>& bvh,
                 const CameraFrame& camera, ivec2 pixel);

// The same ray in this or another BVH over the same scene.
LoggedRay log_ray(const SceneBvh& bvh, const CastRay& cast);

// What a CountProbe would have counted.
Counters counted(const std::vector<Step>& steps);

}  // namespace tracer
