// Polygons to triangles.
#include "tracer/scene/triangulate.h"

#include <cmath>

#include <gtest/gtest.h>

namespace {

using tracer::uvec3;
using tracer::vec3;

double area_of(const std::vector<vec3>& corners, const std::vector<uvec3>& triangles) {
  double sum = 0.0;
  for (const uvec3& t : triangles) {
    sum +=
        0.5 *
        double(glm::length(glm::cross(corners[t.y] - corners[t.x], corners[t.z] - corners[t.x])));
  }
  return sum;
}

std::vector<uvec3> triangles_of(const std::vector<vec3>& corners) {
  std::vector<uvec3> triangles;
  tracer::triangulate(corners, triangles);
  return triangles;
}

// Every triangle has the polygon's winding about +z.
bool same_winding(const std::vector<vec3>& corners, const std::vector<uvec3>& triangles) {
  for (const uvec3& t : triangles) {
    if (glm::cross(corners[t.y] - corners[t.x], corners[t.z] - corners[t.x]).z <= 0.0f) {
      return false;
    }
  }
  return true;
}

TEST(Triangulate, ATriangleStays) {
  EXPECT_EQ(triangles_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), (std::vector<uvec3>{{0, 1, 2}}));
}

TEST(Triangulate, ConvexQuadIsAFan) {
  EXPECT_EQ(triangles_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}),
            (std::vector<uvec3>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Triangulate, ClockwiseStaysClockwise) {
  EXPECT_EQ(triangles_of({{0, 1, 0}, {1, 1, 0}, {1, 0, 0}, {0, 0, 0}}),
            (std::vector<uvec3>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Triangulate, ArrowheadIsNotFilled) {
  const std::vector<vec3> arrow = {{0, 0, 0}, {2, -1, 0}, {1, 0, 0}, {2, 1, 0}};
  const std::vector<uvec3> triangles = triangles_of(arrow);
  EXPECT_EQ(triangles.size(), 2u);
  EXPECT_TRUE(same_winding(arrow, triangles));
  EXPECT_NEAR(area_of(arrow, triangles), 1.0, 1e-6);
}

TEST(Triangulate, ConcaveFromItsReflexCorner) {
  const std::vector<vec3> arrow = {{2, 1, 0}, {0, 0, 0}, {2, -1, 0}, {1, 0, 0}};
  EXPECT_NEAR(area_of(arrow, triangles_of(arrow)), 1.0, 1e-6);
}

TEST(Triangulate, CombKeepsItsArea) {
  // Ten teeth of width 1 and height 5 on a bar of height 1.
  std::vector<vec3> comb = {{0, -1, 0}, {20, -1, 0}, {20, 0, 0}};
  for (int i = 9; i >= 0; --i) {
    const float x = 2.0f * float(i);
    comb.insert(comb.end(), {{x + 1, 0, 0}, {x + 1, 5, 0}, {x, 5, 0}, {x, 0, 0}});
  }
  const std::vector<uvec3> triangles = triangles_of(comb);
  EXPECT_EQ(triangles.size(), comb.size() - 2);
  EXPECT_NEAR(area_of(comb, triangles), 70.0, 1e-4);
}

TEST(Triangulate, CornersOnAnEdgeGiveNoFlatTriangle) {
  const std::vector<vec3> square = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  EXPECT_TRUE(same_winding(square, triangles_of(square)));
}

TEST(Triangulate, WorksInAnyPlane) {
  const std::vector<vec3> arrow = {{5, 0, 0}, {5, 2, -1}, {5, 1, 0}, {5, 2, 1}};
  EXPECT_NEAR(area_of(arrow, triangles_of(arrow)), 1.0, 1e-6);
}

TEST(Triangulate, LargeConcavePolygonEnds) {
  std::vector<vec3> star;
  for (int i = 0; i < 5000; ++i) {
    const float angle = 2.0f * tracer::pi * float(i) / 5000.0f;
    const float radius = i % 2 ? 1.0f : 0.9f;
    star.emplace_back(radius * std::cos(angle) + 2.0f, radius * std::sin(angle), 0.0f);
  }
  const std::vector<uvec3> triangles = triangles_of(star);
  EXPECT_EQ(triangles.size(), 4998u);
  const double area = 0.5 * 5000 * 0.9 * std::sin(2.0 * double(tracer::pi) / 5000.0);
  EXPECT_NEAR(area_of(star, triangles), area, 1e-3);
}

TEST(Triangulate, WithoutAreaItStillEnds) {
  EXPECT_EQ(triangles_of(std::vector<vec3>(7, vec3(1.0f))).size(), 5u);
  EXPECT_EQ(triangles_of({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}}).size(), 3u);
}

TEST(Triangulate, BowTieStillEnds) {
  EXPECT_EQ(triangles_of({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 2u);
}

}  // namespace
