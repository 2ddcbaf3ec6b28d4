// Polygons to triangles.
#pragma once

#include <span>
#include <vector>

#include "tracer/math/types.h"

namespace tracer {

// Appends corners.size() - 2 triangles that cover the polygon, as indices of its corners, wound as
// the polygon is. Convex polygons become a fan of the first corner, others are clipped ear by ear.
// Linear for convex polygons; never worse than quadratic for long.
void triangulate(std::span<const vec3> corners, std::vector<uvec3>& triangles);

}  // namespace tracer
