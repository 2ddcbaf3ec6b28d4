// Polygons to triangles by ear clipping (G. Meisters, Polygons Have Ears, 1975), in the polygon's
// plane after M. Newell's normal. Polygons that cross themselves get some triangles, not good ones.
#include "tracer/scene/triangulate.h"

#include <cmath>
#include <cstdint>

namespace tracer {
namespace {

using Point = glm::dvec2;

// Twice the signed area of a triangle.
double area(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

// The polygon seen along the axis closest to its normal, counter-clockwise.
std::vector<Point> flattened(std::span<const vec3> corners) {
  glm::dvec3 normal(0.0);
  const glm::dvec3 origin(corners[0]);
  for (size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = glm::dvec3(corners[i]) - origin;
    const glm::dvec3 b = glm::dvec3(corners[(i + 1) % corners.size()]) - origin;
    normal += glm::cross(a, b);
  }
  const glm::dvec3 size = glm::abs(normal);
  const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const double sign = normal[axis] < 0.0 ? -1.0 : 1.0;
  std::vector<Point> points(corners.size());
  for (size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 p = glm::dvec3(corners[i]) - origin;
    points[i] = Point(sign * p[u], p[v]);
  }
  return points;
}

bool is_fan(const std::vector<Point>& points) {
  for (size_t i = 1; i + 1 < points.size(); ++i) {
    if (area(points[0], points[i], points[i + 1]) <= 0.0) return false;
  }
  return true;
}

class EarClipper {
 public:
  explicit EarClipper(std::vector<Point> points) : points_(std::move(points)) {
    const uint32_t count = uint32_t(points_.size());
    previous_.resize(count);
    next_.resize(count);
    for (uint32_t i = 0; i < count; ++i) {
      previous_[i] = (i + count - 1) % count;
      next_[i] = (i + 1) % count;
    }
    for (uint32_t i = 0; i < count; ++i) {
      if (turn(i) < 0.0) reflex_.push_back(i);
    }
  }

  void clip(std::vector<uvec3>& triangles) {
    uint32_t left = uint32_t(points_.size());
    uint32_t at = 0;
    uint32_t refused = 0;
    while (left > 3) {
      // A full round without an ear (a polygon that crosses itself, or no patience left): take any.
      if (refused < left && work_ < most_work && !is_ear(at)) {
        at = next_[at];
        ++refused;
        continue;
      }
      triangles.emplace_back(previous_[at], at, next_[at]);
      next_[previous_[at]] = next_[at];
      previous_[next_[at]] = previous_[at];
      const uint32_t after = next_[at];
      next_[at] = at;     // marks it as gone
      at = next_[after];  // skipping one makes fewer slivers
      --left;
      refused = 0;
      forget_reflex();
    }
    triangles.emplace_back(previous_[at], at, next_[at]);
  }

 private:
  static constexpr uint64_t most_work = 50'000'000;  // point tests, under a second

  double turn(uint32_t i) const {
    return area(points_[previous_[i]], points_[i], points_[next_[i]]);
  }

  bool is_ear(uint32_t i) {
    if (turn(i) <= 0.0) return false;
    const Point a = points_[previous_[i]];
    const Point b = points_[i];
    const Point c = points_[next_[i]];
    work_ += reflex_.size();
    for (const uint32_t other : reflex_) {
      const Point p = points_[other];
      if (p == a || p == b || p == c) continue;
      if (area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0) return false;
    }
    return true;
  }

  // Clipping an ear can make its neighbours convex; never the other way round.
  void forget_reflex() {
    work_ += reflex_.size();
    std::erase_if(reflex_, [&](uint32_t i) { return next_[i] == i || turn(i) >= 0.0; });
  }

  std::vector<Point> points_;
  std::vector<uint32_t> previous_;
  std::vector<uint32_t> next_;
  std::vector<uint32_t> reflex_;
  uint64_t work_ = 0;
};

}  // namespace

void triangulate(std::span<const vec3> corners, std::vector<uvec3>& triangles) {
  const uint32_t count = uint32_t(corners.size());
  if (count < 3) return;
  if (count > 3) {
    std::vector<Point> points = flattened(corners);
    if (!is_fan(points)) return EarClipper(std::move(points)).clip(triangles);
  }
  for (uint32_t i = 1; i + 1 < count; ++i)
    triangles.emplace_back(0u, i, i + 1);
}

}  // namespace tracer
