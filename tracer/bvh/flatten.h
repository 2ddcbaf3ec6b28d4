// All instances of a scene as one mesh in the world.
#pragma once

#include <cstdint>
#include <span>

#include "tracer/bvh/scene_bvh.h"

namespace tracer {

inline constexpr uint64_t max_flattened_triangles = 100'000'000;

// The instances stand as in `instances`. The result has one mesh and one instance, in the order of
// the instances and of their triangles; materials, lights, sky and camera stay. Throws Error if
// there are too many triangles.
Scene flattened(const Scene& scene, std::span<const PlacedInstance> instances);

}  // namespace tracer
