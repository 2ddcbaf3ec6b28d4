// Rays through a BVH in its own layout, with probes that may record the way.
#pragma once

#include <span>

#include "tracer/bvh/probe.h"
#include "tracer/bvh/scene_bvh.h"
#include "tracer/math/ray.h"

namespace tracer {

// The nearest hit in [t_min, t_max], or any; a negative t_min counts as 0. Watertight. For the
// probes of probe.h; the nodes that they see are those of the canonical tree, of which a wide
// layout keeps some. Kernels for many rays without probes: ray_kernels.h.
template <bool any_hit, class Probe>
Hit trace(const SceneBvh& bvh, const Ray& ray, Probe& probe);

// The same for many rays, each with its own probe, which records what it would record of the ray
// alone. In packets if neighbours go nearly the same way. Spans of one
// length; VisitProbes are all for the same visits, WatchProbes for the same node.
template <bool any_hit, class Probe>
void trace_all(const SceneBvh& bvh, std::span<const Ray> rays, std::span<Probe> probes,
               std::span<Hit> hits);

}  // namespace tracer
