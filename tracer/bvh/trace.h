// One ray through a BVH in its own layout, with a probe that may record the way.
#pragma once

#include "tracer/bvh/probe.h"
#include "tracer/bvh/scene_bvh.h"
#include "tracer/math/ray.h"

namespace tracer {

// The nearest hit in [t_min, t_max], or any; a negative t_min counts as 0. Watertight. For the
// probes of probe.h; the nodes that they see are those of the canonical tree, of which a wide
// layout keeps some. Kernels for many rays without probes: ray_kernels.h.
template <bool any_hit, class Probe>
Hit trace(const SceneBvh& bvh, const Ray& ray, Probe& probe);

}  // namespace tracer
