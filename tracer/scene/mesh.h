// A triangle mesh with one set of attributes per corner.
#pragma once

#include <string>
#include <vector>

#include "tracer/math/box.h"

namespace tracer {

// positions and normals have the same size; uvs too, or none at all. Corners that differ in normal
// or uv are separate entries whose positions are equal to the bit, so edges stay watertight.
struct Mesh {
  std::string name;
  std::vector<vec3> positions;      // finite, |x| <= 1.844e18
  std::vector<vec3> normals;        // unit length
  std::vector<vec2> uvs;            // (0,0) is the lower left of a texture
  std::vector<uvec3> triangles;     // indices in range
  std::vector<uint32_t> materials;  // one a triangle: index into Scene::materials
};

Box bounds(const Mesh& mesh);

// Fills every entry of mesh.normals that is zero with the area-weighted mean of the faces around
// its position (of those that have no normal either). Faces that meet at an angle above the crease,
// or not at an edge, do not share: entries are then added. 180: all that share a position share.
void fill_missing_normals(Mesh& mesh, float crease_degrees = 180.0f);

}  // namespace tracer
