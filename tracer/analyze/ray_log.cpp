// One pixel's rays, step by step.
#include "tracer/analyze/ray_log.h"

#include "tracer/bvh/traverse.h"

namespace tracer {

LoggedRay log_ray(const SceneBvh& bvh, const CastRay& cast) {
  LoggedRay logged{cast, {}, {}};
  LogProbe probe(bvh);
  logged.cast.hit = cast.ray_class == RayClass::shadow ? traverse<true>(bvh, cast.ray, probe)
                                                       : traverse<false>(bvh, cast.ray, probe);
  logged.steps = std::move(probe.steps);
  logged.counters = counted(logged.steps);
  return logged;
}

RayLog log_pixel(const World& world, const std::shared_ptr<const SceneBvh>& bvh,
                 const CameraFrame& camera, ivec2 pixel) {
  RayLog log{bvh, pixel, {}};
  const vec2 center = vec2(pixel) + 0.5f;
  Whitted whitted;
  for (const CastRay& cast : whitted.trace_rays(world, camera, std::span(&center, 1)))
    log.rays.push_back(log_ray(*bvh, cast));
  return log;
}

Counters counted(const std::vector<Step>& steps) {
  Counters counters;
  counters.rays = 1;
  for (const Step& step : steps) {
    const bool entered = step.result == StepResult::entered;
    if (step.kind == StepKind::triangle) ++counters.triangles;
    if (step.kind == StepKind::node && entered) ++counters.nodes;
    if (step.kind == StepKind::leaf && entered) ++counters.leaves;
    if (step.kind == StepKind::instance && entered) ++counters.instances;
  }
  return counters;
}

}  // namespace tracer
