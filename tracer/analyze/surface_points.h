// Points spread evenly over the surface of a mesh.
#pragma once

#include <span>
#include <vector>

#include "tracer/scene/mesh.h"

namespace tracer {

// sums[i]: area of the triangles 0..i. Where no triangle has an area, each counts as one.
struct AreaTable {
  std::vector<double> sums;
};
AreaTable area_table(const Mesh& mesh);
inline double total(const AreaTable& table) {
  return table.sums.empty() ? 0.0 : table.sums.back();
}

// The entry of increasing sums in which share * sums.back() falls, and where in it: 0..1.
struct Choice {
  uint32_t index;
  double rest;
};
Choice choose(std::span<const double> sums, double share);

// In a triangle's plane up to rounding, and never outside its box. u and v are 0..1.
vec3 point_in_triangle(const Mesh& mesh, uint32_t triangle, double u, double v);

}  // namespace tracer
