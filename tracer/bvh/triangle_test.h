// Ray-triangle tests. The watertight one (S. Woop, C. Benthin, I. Wald, Watertight Ray/Triangle
// Intersection, 2013) is exact at shared edges and vertices as long as both triangles round alike:
// compile without contraction of multiplications and additions (-ffp-contract=off).
// Where we differ: t is kept between where the ray enters and leaves the triangle's own box. Its
// rounding error can be larger than what box tests allow for, and of two triangles that nearly
// touch the one that is found would depend on the order of traversal.
// The fast one (T. Möller, B. Trumbore, Fast Minimum Storage Ray/Triangle Intersection, 1997) is
// none of that.
#pragma once

#include <cmath>
#include <type_traits>

#include "tracer/bvh/box_test.h"
#include "tracer/bvh/scene_bvh.h"
#include "tracer/math/ray.h"
#include "tracer/math/simd.h"

namespace tracer {

// The axes permuted so that the ray's longest one is z, and the shear that makes it (0, 0, 1).
struct ShearedRay {
  int kx, ky, kz;
  float shear_x, shear_y, shear_z;
  float origin[3];  // not permuted
};
struct TriangleRay : ShearedRay {
  BoxRay box;
};

inline ShearedRay sheared_ray(const vec3& origin, const vec3& direction, const BoxRay& box) {
  // Without branches, which random rays make hard to guess: GLM's [] has some.
  const float way[] = {direction.x, direction.y, direction.z};
  const vec3 size = glm::abs(direction);
  const int is_x = int(size.x > size.y) & int(size.x > size.z);
  const int is_y = int(size.x <= size.y) & int(size.y > size.z);
  const int kz = 2 - 2 * is_x - is_y;
  static constexpr int others[2][3][2] = {{{1, 2}, {2, 0}, {0, 1}}, {{2, 1}, {0, 2}, {1, 0}}};
  const int(&axes)[2] = others[int(way[kz] < 0.0f)][kz];  // keeps the winding
  const int kx = axes[0];
  const int ky = axes[1];
  const float inverse = box.inverse[kz];
  return {
      kx, ky, kz, way[kx] * inverse, way[ky] * inverse, inverse, {origin.x, origin.y, origin.z}};
}

struct FastTriangleRay {
  vec3 origin, direction;
};
template <Tests tests>
using TriangleRayOf = std::conditional_t<tests == Tests::fast, FastTriangleRay, TriangleRay>;

template <Tests tests = Tests::watertight>
inline TriangleRayOf<tests> triangle_ray(const vec3& origin, const vec3& direction,
                                         const BoxRay& box) {
  if constexpr (tests == Tests::fast) {
    return {origin, direction};
  } else {
    return {sheared_ray(origin, direction, box), box};
  }
}

// Where the ray is inside the box of a triangle.
inline BoxSpan own_span(const LeafTriangle& triangle, const BoxRay& ray) {
  const auto least = [](const float(&of)[3]) { return std::min(std::min(of[0], of[1]), of[2]); };
  const auto most = [](const float(&of)[3]) { return std::max(std::max(of[0], of[1]), of[2]); };
  BvhNode box;
  box.lo = {least(triangle.x), least(triangle.y), least(triangle.z)};
  box.hi = {most(triangle.x), most(triangle.y), most(triangle.z)};
  return box_span(box, ray, -infinity, infinity);
}

// t, u and v where the ray meets the triangle at t_min <= t <= t_max.
struct TriangleHit {
  bool hit = false;
  float t = 0.0f, u = 0.0f, v = 0.0f;
};

inline TriangleHit intersect(const LeafTriangle& triangle, const TriangleRay& ray, float t_min,
                             float t_max) {
  // Lanes: corners a, b, c; the fourth reads what comes next in memory and is never used.
  const float* by_axis = triangle.x;
  const float4 z = load4(by_axis + 3 * ray.kz) - broadcast(ray.origin[ray.kz]);
  const float4 x =
      load4(by_axis + 3 * ray.kx) - broadcast(ray.origin[ray.kx]) - broadcast(ray.shear_x) * z;
  const float4 y =
      load4(by_axis + 3 * ray.ky) - broadcast(ray.origin[ray.ky]) - broadcast(ray.shear_y) * z;

  // Edge functions: lane 0 is that of the edge opposite to corner a, and so on.
  float4 edge =
      __builtin_shufflevector(x, x, 2, 0, 1, 0) * __builtin_shufflevector(y, y, 1, 2, 0, 0) -
      __builtin_shufflevector(y, y, 2, 0, 1, 0) * __builtin_shufflevector(x, x, 1, 2, 0, 0);
  if (mask_bits(edge == broadcast(0.0f)) & 7) [[unlikely]] {
    // On an edge as far as float can tell: the products of floats are exact in double.
    constexpr int next[] = {2, 0, 1};
    constexpr int last[] = {1, 2, 0};
    for (int i = 0; i < 3; ++i) {
      edge[i] = static_cast<float>(static_cast<double>(x[next[i]]) * y[last[i]] -
                                   static_cast<double>(y[next[i]]) * x[last[i]]);
    }
    const bool negative = edge[0] < 0.0f || edge[1] < 0.0f || edge[2] < 0.0f;
    const bool positive = edge[0] > 0.0f || edge[1] > 0.0f || edge[2] > 0.0f;
    if (negative && positive) return {};
  } else {
    const int negative = sign_bits(edge) & 7;
    if (negative != 0 && negative != 7) return {};
  }

  const float determinant = edge[0] + edge[1] + edge[2];
  if (determinant == 0.0f) return {};
  // Weights before distances: edges are products of two coordinates, and those of three overflow.
  const float4 weight = edge / broadcast(determinant);
  const float plane_t = ray.shear_z * (weight[0] * z[0] + weight[1] * z[1] + weight[2] * z[2]);
  if (std::isnan(plane_t)) return {};
  const BoxSpan own = own_span(triangle, ray.box);
  const float t = std::min(std::max(plane_t, own.entry), own.exit);
  if (!(t >= t_min && t <= t_max)) return {};
  return {true, t, weight[1], weight[2]};
}

// Everything is compared as a multiple of the determinant, since most triangles are missed.
inline TriangleHit intersect(const LeafTriangle& triangle, const FastTriangleRay& ray, float t_min,
                             float t_max) {
  const vec3 corner(triangle.x[0], triangle.y[0], triangle.z[0]);
  const vec3 to_b = vec3(triangle.x[1], triangle.y[1], triangle.z[1]) - corner;
  const vec3 to_c = vec3(triangle.x[2], triangle.y[2], triangle.z[2]) - corner;
  const vec3 from = ray.origin - corner;
  const vec3 p = glm::cross(ray.direction, to_c);
  const vec3 q = glm::cross(from, to_b);
  const float determinant = glm::dot(to_b, p);
  const float sign = determinant < 0.0f ? -1.0f : 1.0f;
  const float size = sign * determinant;
  const float u = sign * glm::dot(from, p);
  const float v = sign * glm::dot(ray.direction, q);
  if (!(u >= 0.0f && v >= 0.0f && u + v <= size && size > 0.0f)) return {};
  const float t = sign * glm::dot(to_c, q);
  if (!(t >= t_min * size && t <= t_max * size)) return {};
  const float inverse = 1.0f / size;
  return {true, std::min(t * inverse, t_max), u * inverse, v * inverse};
}

}  // namespace tracer
