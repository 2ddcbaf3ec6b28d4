// One pixel's rays, step by step.
#include "tracer/analyze/ray_log.h"

#include <utility>

#include "tracer/bvh/trace.h"

namespace tracer {

LoggedRay log_ray(const SceneBvh& bvh, const CastRay& cast) {
  LoggedRay logged{cast, {}, {}};
  LogProbe probe;
  logged.cast.hit = cast.ray_class == RayClass::shadow ? trace<true>(bvh, cast.ray, probe)
                                                       : trace<false>(bvh, cast.ray, probe);
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

RayLog log_again(const RayLog& log, const std::shared_ptr<const SceneBvh>& bvh) {
  RayLog again{bvh, log.pixel, {}};
  for (const LoggedRay& ray : log.rays)
    again.rays.push_back(log_ray(*bvh, ray.cast));
  return again;
}

std::vector<RayPlace> ray_tree(const RayLog& log) {
  // Lists of children, linked backwards so that the first child comes first from the stack.
  const size_t count = log.rays.size();
  std::vector<uint32_t> last_child(count, none), sibling(count, none);
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t parent = log.rays[i].cast.parent;
    if (parent != none) sibling[i] = std::exchange(last_child[parent], i);
  }
  std::vector<RayPlace> tree, waiting;
  if (count > 0) waiting.push_back({0, 0});
  while (!waiting.empty()) {
    const RayPlace place = waiting.back();
    waiting.pop_back();
    tree.push_back(place);
    for (uint32_t child = last_child[place.ray]; child != none; child = sibling[child])
      waiting.push_back({child, place.level + 1});
  }
  return tree;
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

Counters counted(const RayLog& log) {
  Counters sum;
  for (const LoggedRay& ray : log.rays)
    sum += ray.counters;
  return sum;
}

}  // namespace tracer
