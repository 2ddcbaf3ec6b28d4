#include "tracer/scene/teapot.h"

#include <cstring>
#include <map>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

namespace tracer {
namespace {

using Point = std::tuple<uint32_t, uint32_t, uint32_t>;  // the bits: tells -0 from 0

Point bits(vec3 point) {
  uint32_t word[3];
  std::memcpy(word, &point, sizeof word);
  return {word[0], word[1], word[2]};
}

bool has_control_point(vec3 point) {
  for (const TeapotPatch& patch : teapot_patches()) {
    for (const auto& row : patch.points) {
      for (const vec3& candidate : row) {
        if (candidate == point) return true;
      }
    }
  }
  return false;
}

TEST(Teapot, HasThePublishedControlPoints) {
  EXPECT_TRUE(has_control_point({1.4f, -0.784f, 2.4f}));         // rim
  EXPECT_TRUE(has_control_point({-0.749f, 1.3375f, 2.53125f}));  // rim, opposite quarter
  EXPECT_TRUE(has_control_point({0.0f, 0.0f, 3.15f}));           // top of the lid
  EXPECT_TRUE(has_control_point({0.8f, -0.45f, 3.15f}));         // knob
  EXPECT_TRUE(has_control_point({-3.0f, 0.3f, 1.8f}));           // handle
  EXPECT_TRUE(has_control_point({3.525f, -0.25f, 2.49375f}));    // spout
  EXPECT_TRUE(has_control_point({1.425f, -0.798f, 0.0f}));       // bottom
}

TEST(Teapot, HasAsManyDistinctControlPointsAsThePublishedSet) {
  std::set<Point> points;
  for (const TeapotPatch& patch : teapot_patches()) {
    for (const auto& row : patch.points) {
      for (const vec3& point : row)
        points.insert(bits(point + 0.0f));
    }
  }
  // The 306 published entries repeat some points; these are the different ones.
  EXPECT_EQ(points.size(), 290u);
}

TEST(Teapot, RingsHaveThePublishedRoundness) {
  const auto patches = teapot_patches();
  for (size_t quarter = 0; quarter < 24; quarter += 4) {
    for (const auto& row : patches[quarter].points) {
      const float roundness = row[0].z == 3.15f ? 0.5625f : 0.56f;  // the knob is rounded to 0.45
      EXPECT_NEAR(row[1].y, -roundness * row[0].x, 1e-5f);
      EXPECT_EQ(row[2], vec3(-row[1].y, -row[0].x, row[0].z));
    }
  }
}

TEST(Teapot, CountsItsTriangles) {
  EXPECT_EQ(make_teapot(10).triangles.size(), 6320u);
  for (const uint32_t n : {2u, 3u, 7u, 24u}) {
    EXPECT_EQ(make_teapot(n).triangles.size(), 64u * n * n - 8u * n) << n;
  }
}

TEST(Teapot, StandsOnTheGroundAndIsOneHigh) {
  const Box box = bounds(make_teapot(16));
  EXPECT_FLOAT_EQ(box.lo.y, 0.0f);
  EXPECT_FLOAT_EQ(box.hi.y, 1.0f);
  EXPECT_FLOAT_EQ(box.lo.z, -box.hi.z);
  EXPECT_NEAR(box.hi.x - box.lo.x, 2.06f, 0.05f);
  EXPECT_GT(box.hi.x, -box.lo.x);  // the spout reaches further than the handle
}

// The number of edges that only one triangle has; every other edge must have two, running opposite
// ways.
int open_edges(const Mesh& mesh) {
  std::map<std::pair<Point, Point>, int> directed;
  for (const uvec3& triangle : mesh.triangles) {
    for (int k = 0; k < 3; k++) {
      directed[{bits(mesh.positions[triangle[k]]), bits(mesh.positions[triangle[(k + 1) % 3]])}]++;
    }
  }
  int open = 0;
  for (const auto& [edge, count] : directed) {
    EXPECT_EQ(count, 1);
    if (!directed.count({edge.second, edge.first})) open++;
  }
  return open;
}

TEST(Teapot, PatchesMeetToTheBit) {
  // Open are the rim and the lid's edge (4 patches each) and both ends of handle and spout (2
  // each).
  for (const uint32_t n : {2u, 3u, 10u, 17u}) {
    EXPECT_EQ(open_edges(make_teapot(n)), static_cast<int>(16 * n)) << n;
  }
}

TEST(Teapot, NormalsAreUnitAndOnTheSideOfTheWinding) {
  const Mesh mesh = make_teapot(20);
  for (const vec3& normal : mesh.normals)
    EXPECT_NEAR(glm::length(normal), 1.0f, 1e-5f);
  for (const uvec3& t : mesh.triangles) {
    const vec3 face = glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                 mesh.positions[t.z] - mesh.positions[t.x]);
    ASSERT_GT(glm::length(face), 0.0f);
    for (int k = 0; k < 3; k++) {
      EXPECT_GT(glm::dot(glm::normalize(face), mesh.normals[t[k]]), 0.3f);
    }
  }
}

TEST(Teapot, BodyNormalsPointAwayFromTheAxis) {
  const Mesh mesh = make_teapot(8);
  for (size_t i = 0; i < mesh.positions.size(); i++) {
    const vec3 point = mesh.positions[i];
    if (point.y < 0.3f || point.y > 0.6f || glm::length(vec2(point.x, point.z)) > 0.64f) continue;
    if (std::abs(point.z) < 0.3f) continue;  // the roots of handle and spout
    EXPECT_GT(glm::dot(mesh.normals[i], vec3(point.x, 0, point.z)), 0.0f);
  }
}

TEST(Teapot, PolesHaveAxialNormals) {
  const Mesh mesh = make_teapot(6);
  int poles = 0;
  for (size_t i = 0; i < mesh.positions.size(); i++) {
    if (mesh.positions[i].x != 0.0f || mesh.positions[i].z != 0.0f) continue;
    const float expected = mesh.positions[i].y > 0.5f ? 1.0f : -1.0f;
    EXPECT_FLOAT_EQ(mesh.normals[i].y, expected);
    poles++;
  }
  EXPECT_EQ(poles, 2 * 4 * 7);  // lid and bottom, four patches, seven points each
}

TEST(Teapot, NormalsAgreeWhereTheBodysPatchesMeet) {
  const Mesh mesh = make_teapot(5);
  // Rim, upper and lower body: patches 0..11, 36 points each. All meet smoothly.
  std::map<Point, vec3> normals;
  for (size_t i = 0; i < 12 * 36; i++) {
    const auto [place, added] = normals.emplace(bits(mesh.positions[i]), mesh.normals[i]);
    if (!added) {
      EXPECT_LT(glm::distance(place->second, mesh.normals[i]), 1e-3f) << i;
    }
  }
}

TEST(Teapot, TextureIsContinuousAcrossTheBodysPatches) {
  const Mesh mesh = make_teapot(5);
  std::map<Point, vec2> uvs;
  for (size_t i = 0; i < 12 * 36; i++) {
    const vec2 uv(mesh.uvs[i].x == 4.0f ? 0.0f : mesh.uvs[i].x, mesh.uvs[i].y);
    const auto [place, added] = uvs.emplace(bits(mesh.positions[i]), uv);
    if (!added) {
      EXPECT_LT(glm::distance(place->second, uv), 1e-5f) << i;
    }
  }
}

TEST(Teapot, TextureCoordinatesAreInRange) {
  const Mesh mesh = make_teapot(9);
  ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
  for (const vec2& uv : mesh.uvs) {
    EXPECT_GE(uv.x, 0.0f);
    EXPECT_LE(uv.x, 4.0f);
    EXPECT_GE(uv.y, 0.0f);
    EXPECT_LE(uv.y, 2.0f);
  }
}

}  // namespace
}  // namespace tracer
