// The surface at a hit: everything shading and the debug views need to know.
#pragma once

#include "tracer/bvh/scene_bvh.h"
#include "tracer/scene/scene.h"

namespace tracer {

struct Surface {
  vec3 position;          // world
  vec3 position_error;    // bound of its rounding error, each axis
  vec3 geometric_normal;  // world, unit, as the winding says
  vec3 shading_normal;    // world, unit, interpolated, on the geometric normal's side
  vec2 uv{0.0f};
  vec3 barycentric{0.0f};  // weights of the three corners
  uint32_t material = 0;
  uint32_t triangle = 0;
  uint32_t instance = 0;
  bool front = true;  // the ray came from the side the geometric normal points to
};

// The ray must be the one that gave the hit.
Surface surface_at(const Scene& scene, const SceneBvh& bvh, const Ray& ray, const Hit& hit);

// Linear albedo with its texture.
vec3 albedo_at(const Scene& scene, const Material& material, vec2 uv);

}  // namespace tracer
