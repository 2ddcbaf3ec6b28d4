// All instances of a scene as one mesh in the world.
#pragma once

#include <cstdint>
#include <span>

#include "tracer/scene/scene.h"

namespace tracer {

inline constexpr uint64_t max_flattened_triangles = 100'000'000;

// Where each instance stands (object to world), in the order of scene.instances. The result has one
// mesh and one instance, in the order of the instances and of their triangles; materials, lights,
// sky and camera stay. Throws Error if there are too many triangles.
Scene flattened(const Scene& scene, std::span<const mat4> to_world);

}  // namespace tracer
