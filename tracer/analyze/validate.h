// Whether a scene's BVH is right: rules for every tree, and brute force on random rays.
#pragma once

#include "tracer/analyze/tree_rules.h"
#include "tracer/progress.h"

namespace tracer {

struct Validation {
  std::vector<Finding> findings;  // of the TLAS, of the BLASes by mesh, then of the rays
  uint64_t trees_checked = 0;
  uint64_t rays_checked = 0;  // 0 if the trees cannot be walked
  uint64_t mismatches = 0;    // rays with another hit than by brute force
};
bool has_errors(const Validation& validation);

// Ids of the findings that are not of one tree's rules.
inline constexpr std::string_view instances_rule = "instances";  // they have a mesh and an inverse
inline constexpr std::string_view hits_rule = "hits";            // as by brute force

inline constexpr uint64_t max_validation_rays = 100'000'000;

// How many rays take a few seconds: 100..20000.
uint64_t default_ray_count(const Scene& scene);

// Half of the rays are random lines through the scene, a quarter each aims at vertices and at
// edges. The blases' sizes fit the scene: bvh was made from it, though it may have been damaged
// since. Deterministic for any number of threads. Stopped: what is known by then.
Validation validate(const Scene& scene, const SceneBvh& bvh, uint64_t rays, const Job& job);

}  // namespace tracer
