// Measured cost by node: how often the rays of one frame entered each.
#pragma once

#include <memory>

#include "tracer/progress.h"
#include "tracer/render/whitted.h"

namespace tracer {

struct FrameVisits {
  ClassVisits classes;        // by RayClass
  double milliseconds = 0.0;  // that counting took
};

// One sample through the centre of each pixel, with all rays that it casts: those of pass 0. The
// same for any number of threads. Stopped: nullptr.
std::shared_ptr<const FrameVisits> count_visits(const World& world, const CameraFrame& camera,
                                                const Job& job);

// Of one tree, by node: the BLAS of a mesh, or the TLAS (mesh: none); by rays of one class (index),
// or all (ray_class_count).
std::vector<uint32_t> tree_visits(const FrameVisits& visits, uint32_t mesh, int ray_class);

}  // namespace tracer
