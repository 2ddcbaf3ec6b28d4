// Points spread evenly over the surface of a mesh: prefix sums of areas, and the square root that
// maps a square to a triangle.
#include "tracer/analyze/surface_points.h"

#include <algorithm>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace tracer {

AreaTable area_table(const Mesh& mesh) {
  AreaTable table;
  std::vector<double>& sums = table.sums;
  sums.resize(mesh.triangles.size());
  tbb::parallel_for(tbb::blocked_range<size_t>(0, sums.size(), 8192), [&](const auto& range) {
    for (size_t i = range.begin(); i < range.end(); ++i) {
      const uvec3 corners = mesh.triangles[i];
      const glm::dvec3 a(mesh.positions[corners.x]);
      const glm::dvec3 b(mesh.positions[corners.y]);
      const glm::dvec3 c(mesh.positions[corners.z]);
      sums[i] = 0.5 * glm::length(glm::cross(b - a, c - a));
    }
  });
  double sum = 0.0;
  for (double& entry : sums)
    entry = sum += entry;
  if (sum > 0.0) return table;
  for (size_t i = 0; i < sums.size(); ++i)
    sums[i] = double(i + 1);
  return table;
}

Choice choose(std::span<const double> sums, double share) {
  const double wanted = share * sums.back();
  const auto found = std::upper_bound(sums.begin(), sums.end() - 1, wanted);
  const double before = found == sums.begin() ? 0.0 : found[-1];
  const double width = *found - before;
  const double rest = width > 0.0 ? (wanted - before) / width : 0.0;
  return {uint32_t(found - sums.begin()), std::clamp(rest, 0.0, 1.0)};
}

vec3 point_in_triangle(const Mesh& mesh, uint32_t triangle, double u, double v) {
  const uvec3 corners = mesh.triangles[triangle];
  const vec3 a = mesh.positions[corners.x];
  const vec3 b = mesh.positions[corners.y];
  const vec3 c = mesh.positions[corners.z];
  const double root = std::sqrt(u);
  const vec3 point((1.0 - root) * glm::dvec3(a) + root * (1.0 - v) * glm::dvec3(b) +
                   root * v * glm::dvec3(c));
  // A triangle in a plane of an axis must not leave the flat boxes around it.
  return glm::clamp(point, glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)));
}

}  // namespace tracer
