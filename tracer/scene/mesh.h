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

// Area-weighted vertex normals; corners with equal position and no normal share it.
// Fills every entry of mesh.normals that is zero.
void fill_missing_normals(Mesh& mesh);

}  // namespace tracer
