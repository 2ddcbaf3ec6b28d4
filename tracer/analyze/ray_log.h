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

// All rays of a log once more, in another BVH over the same scene: from the same origins, so that
// the logs can be compared ray by ray. Whether a ray would still be cast there is not asked.
RayLog log_again(const RayLog& log, const std::shared_ptr<const SceneBvh>& bvh);

// The rays as a tree: each is followed by those that were cast from its hit.
struct RayPlace {
  uint32_t ray = 0;    // in RayLog::rays
  uint32_t level = 0;  // rays before it up to the camera's
};
std::vector<RayPlace> ray_tree(const RayLog& log);

// What a CountProbe would have counted.
Counters counted(const std::vector<Step>& steps);

// Of all rays together.
Counters counted(const RayLog& log);

}  // namespace tracer
