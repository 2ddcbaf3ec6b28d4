// Deformed meshes: positions, normals, limits.
#include "tracer/scene/deform.h"

#include <cmath>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "make_scene.h"
#include "tracer/choice.h"

namespace tracer::test {
namespace {

bool same(const Mesh& a, const Mesh& b) {
  return a.positions == b.positions && a.normals == b.normals && a.uvs == b.uvs &&
         a.triangles == b.triangles && a.materials == b.materials;
}

Mesh with_normals(Mesh mesh) {
  mesh.normals.assign(mesh.positions.size(), vec3(0.0f));
  mesh.materials.assign(mesh.triangles.size(), 0);
  fill_missing_normals(mesh);
  return mesh;
}

Deformer held(const char* kind, float amount, const char* axis = "y") {
  return {kind, amount, axis, 0.0f};
}

TEST(Deform, AmountZeroIsTheRestMesh) {
  const Mesh rest = with_normals(sphere(8, 1.0f, vec3(3, 2, 1), 0.1f));
  for (const DeformerRow& row : deformers()) {
    EXPECT_TRUE(same(deformed(rest, held(row.id.data(), 0.0f), 1.0f), rest)) << row.id;
  }
  EXPECT_TRUE(same(deformed(rest, held("none", 1.0f), 1.0f), rest));
  EXPECT_TRUE(same(deformed(rest, held("unknown", 1.0f), 1.0f), rest));
}

TEST(Deform, SwingsBeginAtRest) {
  const Mesh rest = with_normals(sphere(8));
  for (const char* kind : {"twist", "bend", "explode"}) {
    const Deformer deformer{kind, 1.0f, "y", 0.5f};
    EXPECT_TRUE(same(deformed(rest, deformer, 0.0f), rest)) << kind;
    EXPECT_TRUE(same(deformed(rest, deformer, 2.0f), rest)) << kind << " after a swing";
    EXPECT_FALSE(same(deformed(rest, deformer, 0.4f), rest)) << kind;
  }
}

TEST(Deform, AQuarterTwistTurnsTheEndsByAnEighthEach) {
  Mesh rest;
  rest.positions = {{0, 0, -1}, {1, 1, 0}, {0, 2, 1}, {-1, 1, 0}};
  rest.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Mesh mesh = deformed(with_normals(rest), held("twist", 0.25f), 0.0f);
  const float half = std::sqrt(0.5f);
  EXPECT_NEAR(std::abs(mesh.positions[0].x), half, 1e-6f);
  EXPECT_NEAR(std::abs(mesh.positions[0].z), half, 1e-6f);
  EXPECT_EQ(mesh.positions[0].y, 0.0f);
  EXPECT_EQ(mesh.positions[1], rest.positions[1]);  // in the middle
}

TEST(Deform, ABendOfHalfATurnKeepsTheLengthOfTheAxis) {
  Mesh rest;
  for (int i = 0; i <= 100; ++i)
    rest.positions.emplace_back(0.01f * float(i), 0.0f, 0.0f);
  rest.positions.emplace_back(0.0f, 1e-6f, 0.0f);
  rest.triangles = {{0, 1, 101}};
  const Mesh mesh = deformed(with_normals(rest), held("bend", 0.5f, "x"), 0.0f);
  float length = 0.0f;
  for (int i = 0; i < 100; ++i)
    length += glm::distance(mesh.positions[i], mesh.positions[i + 1]);
  EXPECT_NEAR(length, 1.0f, 1e-3f);
  EXPECT_NEAR(glm::distance(mesh.positions[0], mesh.positions[100]), 2.0f / pi, 1e-3f);
}

// The derivative that turns the normals, held against small steps along the surface.
TEST(Deform, NormalsAreThoseOfTheDeformedSurface) {
  const Mesh rest = with_normals(sphere(60));
  for (const char* kind : {"twist", "wave", "bend"}) {
    for (const char* axis : {"x", "y", "z"}) {
      const Mesh mesh = deformed(rest, held(kind, 0.2f, axis), 0.0f);
      double off = 0.0;
      for (size_t i = 0; i < rest.triangles.size(); ++i) {
        const uvec3& t = mesh.triangles[i];
        const vec3 face = glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                     mesh.positions[t.z] - mesh.positions[t.x]);
        const vec3 mean = mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z];
        const vec3 rest_face = glm::cross(rest.positions[t.y] - rest.positions[t.x],
                                          rest.positions[t.z] - rest.positions[t.x]);
        const vec3 rest_mean = rest.normals[t.x] + rest.normals[t.y] + rest.normals[t.z];
        const float rest_side = glm::dot(rest_face, rest_mean) < 0.0f ? -1.0f : 1.0f;
        off = std::max(
            off, 1.0 - double(rest_side * glm::dot(glm::normalize(face), glm::normalize(mean))));
      }
      EXPECT_LT(off, 0.01) << kind << " along " << axis;
    }
  }
}

TEST(Deform, NormalsStayUnitLength) {
  const Mesh rest = with_normals(sphere(20, 3.0f, vec3(1.0f), 0.3f));
  for (const DeformerRow& row : deformers()) {
    for (const vec3& n : deformed(rest, held(row.id.data(), 1.0f, "x"), 0.3f).normals)
      ASSERT_NEAR(glm::length(n), 1.0f, 1e-5f) << row.id;
  }
}

TEST(Deform, ExplodeMovesStiffTrianglesOutward) {
  const Mesh rest = with_normals(sphere(10));
  const Mesh mesh = deformed(rest, held("explode", 1.0f), 0.0f);
  ASSERT_EQ(mesh.triangles.size(), rest.triangles.size());
  EXPECT_EQ(mesh.positions.size(), 3 * rest.triangles.size());
  EXPECT_EQ(mesh.materials, rest.materials);
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const uvec3& from = rest.triangles[i];
    const uvec3& to = mesh.triangles[i];
    const vec3 step = mesh.positions[to.x] - rest.positions[from.x];
    const vec3 centroid =
        (rest.positions[from.x] + rest.positions[from.y] + rest.positions[from.z]) / 3.0f;
    EXPECT_GT(glm::dot(step, centroid), 0.0f);
    for (int k = 1; k < 3; ++k) {
      const vec3 other = mesh.positions[to[k]] - rest.positions[from[k]];
      EXPECT_LT(glm::distance(other, step), 1e-5f);
    }
  }
}

TEST(Deform, EqualPositionsStayTogether) {
  Mesh rest = sphere(6);
  const uint32_t copy = uint32_t(rest.positions.size());
  rest.positions.push_back(rest.positions[5]);
  rest.triangles[0] = {copy, 5, 6};
  rest.normals.assign(rest.positions.size(), vec3(0, 1, 0));
  rest.normals[5] = vec3(1, 0, 0);
  for (const char* kind : {"twist", "wave", "bend"}) {
    const Mesh mesh = deformed(rest, held(kind, 0.7f, "z"), 0.0f);
    EXPECT_EQ(mesh.positions[copy], mesh.positions[5]) << kind;
  }
}

// Flat, thin, on a point, as large as a mesh may be: all finite.
TEST(Deform, FiniteForAnyMesh) {
  std::vector<Mesh> meshes = {grid(3), soup(20, 0.1f), soup(20, 0.1f), soup(20, 0.1f)};
  for (vec3& p : meshes[1].positions)
    p = vec3(4.0f);
  for (vec3& p : meshes[2].positions)
    p *= 1.6e18f;
  for (vec3& p : meshes[3].positions)
    p = vec3(p.x, 1e-40f * p.y, 1e18f * p.z);
  for (Mesh& mesh : meshes)
    mesh.normals.assign(mesh.positions.size(), vec3(0.6f, 0.8f, 0.0f));
  for (const DeformerRow& row : deformers()) {
    for (const AxisRow& axis : axes()) {
      for (const float amount : {-max_amount, 1e-30f, max_amount}) {
        for (const Mesh& mesh : meshes) {
          const Deformer deformer{std::string(row.id), amount, std::string(axis.id), 0.1f};
          const Mesh moved = deformed(mesh, deformer, 1.3f);
          for (size_t i = 0; i < moved.positions.size(); ++i) {
            const vec3 p = glm::abs(moved.positions[i]);
            ASSERT_TRUE(p.x <= 1.845e18f && p.y <= 1.845e18f && p.z <= 1.845e18f) << row.id;
            ASSERT_NEAR(glm::length(moved.normals[i]), 1.0f, 1e-4f) << row.id;
          }
        }
      }
    }
  }
}

TEST(Deform, SameForAnyNumberOfThreads) {
  const Mesh rest = with_normals(sphere(80));
  for (const DeformerRow& row : deformers()) {
    Mesh first;
    for (const size_t threads : {1, 4}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      const Mesh mesh = deformed(rest, held(row.id.data(), 0.5f), 0.0f);
      if (threads == 1) first = mesh;
      EXPECT_TRUE(same(mesh, first)) << row.id;
    }
  }
}

TEST(Deform, ASceneSharesItsPictures) {
  auto rest = std::make_shared<Scene>(scene_of({sphere(5), grid(2)}));
  rest->textures.push_back({"t", 1, 1, std::vector<uint32_t>{7}});
  const auto scene = deformed(rest, held("twist", 1.0f), 0.0f);
  EXPECT_NE(scene, rest);
  EXPECT_EQ(scene->textures[0].texels.data(), rest->textures[0].texels.data());
  EXPECT_NE(scene->meshes[0].positions, rest->meshes[0].positions);
  EXPECT_EQ(deformed(rest, held("twist", 0.0f), 0.0f), rest);
}

}  // namespace
}  // namespace tracer::test
