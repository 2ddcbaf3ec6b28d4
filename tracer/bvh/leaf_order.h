// Triangles as the leaves of a tree hold them.
#pragma once

#include <span>

#include "tracer/bvh/scene_bvh.h"
#include "tracer/scene/mesh.h"

namespace tracer {

inline void copy_corners(LeafTriangle& to, const Mesh& mesh, uint32_t triangle) {
  const uvec3& corners = mesh.triangles[triangle];
  for (int k = 0; k < 3; ++k) {
    const vec3& position = mesh.positions[corners[k]];
    to.x[k] = position.x;
    to.y[k] = position.y;
    to.z[k] = position.z;
  }
}

// Before entry i of the references is looked at: fetches the corners of a later one into the cache,
// and the indices of one that comes after that. In a mesh whose triangles are not in a tree's
// order each of the two would be a wait. (Not inlined early, GCC takes a function that only fetches
// for one that does nothing and drops the call.)
[[gnu::always_inline]] inline void prefetch_ahead(const Mesh& mesh,
                                                  std::span<const uint32_t> references, size_t i) {
  constexpr size_t ahead = 8;
  if (i + 2 * ahead >= references.size()) return;
  __builtin_prefetch(&mesh.triangles[references[i + 2 * ahead]]);
  const uvec3& soon = mesh.triangles[references[i + ahead]];
  for (int k = 0; k < 3; ++k)
    __builtin_prefetch(&mesh.positions[soon[k]]);
}

}  // namespace tracer
