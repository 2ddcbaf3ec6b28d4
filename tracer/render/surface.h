// The surface at a hit: everything that shading and the debug views need to know.
#pragma once

#include <span>

#include "tracer/bvh/scene_bvh.h"
#include "tracer/math/ray.h"
#include "tracer/scene/scene.h"

namespace tracer {

struct Surface {
  vec3 position{0.0f};          // world
  vec3 position_error{0.0f};    // how far off it may be on each axis, as a new ray sees it
  vec3 geometric_normal{0.0f};  // world, unit, as the winding says
  vec3 shading_normal{0.0f};    // world, unit, interpolated, on the geometric normal's side
  vec2 uv{0.0f};                // 0 for a mesh without
  vec3 barycentric{0.0f};       // weights of the three corners
  uint32_t material = 0;
  uint32_t triangle = 0;
  uint32_t instance = 0;
  bool front = true;  // the ray comes from the side that the geometric normal points to
};

// Directions are those of the rays which gave the hits, in the world; one for each.
void surfaces_at(const Scene& scene, const SceneBvh& bvh, std::span<const vec3> directions,
                 std::span<const Hit> hits, std::span<Surface> surfaces);
Surface surface_at(const Scene& scene, const SceneBvh& bvh, const vec3& direction, const Hit& hit);

// Fetches into the cache what surface_at will read of a hit: first its corner indices, some hits
// later what is at the corners.
void prefetch_indices(const Scene& scene, const Hit& hit);
void prefetch_corners(const Scene& scene, const Hit& hit);

// Single parts of it, for a tenth of the memory accesses. The uv is 0 for a mesh without.
uint32_t material_at(const Scene& scene, const Hit& hit);
vec2 uv_at(const Scene& scene, const Hit& hit);
vec3 geometric_normal_at(const Scene& scene, const SceneBvh& bvh, const Hit& hit);

// Where a ray that leaves the surface in this direction begins, so that it does not hit the surface
// again. No fixed epsilon: the distance follows from the rounding errors of the position (as in
// M. Pharr, W. Jakob, G. Humphreys, Physically Based Rendering, 2016, section 3.9), of the
// instance's transform and of the intersection test.
vec3 spawn_point(const Surface& surface, const vec3& direction);

// Linear albedo with its texture; at once, or in the two steps of texture.h.
vec3 albedo_at(const Scene& scene, const Material& material, vec2 uv);
TexturePlace fetch_albedo(const Scene& scene, const Material& material, vec2 uv);
vec3 albedo_at(const Scene& scene, const Material& material, const TexturePlace& place);

}  // namespace tracer
