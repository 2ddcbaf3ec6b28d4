// Mesh bounds and missing normals.
#include "tracer/scene/mesh.h"

#include <cmath>

#include <gtest/gtest.h>

namespace {

using tracer::fill_missing_normals;
using tracer::Mesh;
using tracer::vec3;

// Two squares of size 1 that share the y axis as an edge; the second is bent back by an angle.
Mesh folded(float degrees) {
  const float angle = degrees * tracer::pi / 180.0f;
  Mesh mesh;
  mesh.positions = {{-1, 0, 0},
                    {0, 0, 0},
                    {0, 1, 0},
                    {-1, 1, 0},
                    {std::cos(angle), 0, -std::sin(angle)},
                    {std::cos(angle), 1, -std::sin(angle)}};
  mesh.normals.assign(6, vec3(0.0f));
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  mesh.materials.assign(4, 0);
  return mesh;
}

void expect_near(const vec3& a, const vec3& b) {
  EXPECT_LT(glm::length(a - b), 1e-5f) << a.x << " " << a.y << " " << a.z;
}

TEST(MeshBounds, HoldAllPositions) {
  const tracer::Box box = bounds(folded(0.0f));
  EXPECT_EQ(box.lo, vec3(-1, 0, 0));
  EXPECT_EQ(box.hi, vec3(1, 1, 0));
}

TEST(FillNormals, FlatSheet) {
  Mesh mesh = folded(0.0f);
  fill_missing_normals(mesh);
  for (const vec3& normal : mesh.normals)
    expect_near(normal, {0, 0, 1});
}

TEST(FillNormals, SmoothEdgeGetsTheMean) {
  Mesh mesh = folded(90.0f);
  fill_missing_normals(mesh);
  EXPECT_EQ(mesh.positions.size(), 6u);
  expect_near(mesh.normals[0], {0, 0, 1});
  expect_near(mesh.normals[4], {1, 0, 0});
  // At entry 2 both triangles of the first square count, one of the second.
  expect_near(mesh.normals[2], glm::normalize(vec3(1, 0, 2)));
}

TEST(FillNormals, LargerFacesCountMore) {
  Mesh mesh = folded(90.0f);
  mesh.positions[4] *= 3.0f;
  mesh.positions[5] = {0, 1, -3};
  fill_missing_normals(mesh);
  expect_near(mesh.normals[2], glm::normalize(vec3(3, 0, 2)));
}

TEST(FillNormals, CreaseSplitsEntries) {
  Mesh mesh = folded(90.0f);
  mesh.uvs.assign(6, tracer::vec2(0.5f));
  fill_missing_normals(mesh, 50.0f);
  EXPECT_EQ(mesh.positions.size(), 8u);
  EXPECT_EQ(mesh.uvs.size(), 8u);
  for (const tracer::uvec3& t : mesh.triangles) {
    const vec3 face =
        t == mesh.triangles[0] || t == mesh.triangles[1] ? vec3(0, 0, 1) : vec3(1, 0, 0);
    for (int k = 0; k < 3; ++k)
      expect_near(mesh.normals[t[k]], face);
  }
}

TEST(FillNormals, BelowTheCreaseIsSmooth) {
  Mesh mesh = folded(45.0f);
  fill_missing_normals(mesh, 50.0f);
  EXPECT_EQ(mesh.positions.size(), 6u);
}

TEST(FillNormals, EqualPositionsShareWithoutSharedEntries) {
  Mesh soup = folded(20.0f);
  Mesh mesh;
  for (const tracer::uvec3& t : soup.triangles) {
    const uint32_t first = uint32_t(mesh.positions.size());
    for (int k = 0; k < 3; ++k)
      mesh.positions.push_back(soup.positions[t[k]]);
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  mesh.normals.assign(mesh.positions.size(), vec3(0.0f));
  fill_missing_normals(soup, 50.0f);
  fill_missing_normals(mesh, 50.0f);
  EXPECT_EQ(mesh.positions.size(), 12u);
  for (size_t t = 0; t < 4; ++t) {
    for (int k = 0; k < 3; ++k) {
      expect_near(mesh.normals[mesh.triangles[t][k]], soup.normals[soup.triangles[t][k]]);
    }
  }
}

TEST(FillNormals, GivenNormalsStay) {
  Mesh mesh = folded(90.0f);
  mesh.normals[2] = vec3(0, 1, 0);
  fill_missing_normals(mesh, 50.0f);
  EXPECT_EQ(mesh.normals[2], vec3(0, 1, 0));
}

TEST(FillNormals, BackToBackFacesHaveUnitNormals) {
  Mesh mesh = folded(0.0f);
  mesh.triangles = {{0, 1, 2}, {2, 1, 0}};
  fill_missing_normals(mesh);
  for (const vec3& normal : mesh.normals)
    EXPECT_NEAR(glm::length(normal), 1.0f, 1e-5f);
}

TEST(FillNormals, TinyAndHugeMeshesWork) {
  for (const float scale : {1e-25f, 1e18f}) {
    Mesh mesh = folded(0.0f);
    for (vec3& p : mesh.positions)
      p *= scale;
    fill_missing_normals(mesh, 50.0f);
    for (const vec3& normal : mesh.normals)
      expect_near(normal, {0, 0, 1});
  }
}

TEST(FillNormals, ManyFacesAtOnePointStayFast) {
  Mesh mesh = folded(0.0f);
  mesh.triangles.assign(100'000, {0, 1, 2});
  fill_missing_normals(mesh, 50.0f);
  expect_near(mesh.normals[0], {0, 0, 1});
  EXPECT_EQ(mesh.positions.size(), 6u);
}

}  // namespace
