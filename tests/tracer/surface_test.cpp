// T4: a ray that leaves a surface does not hit it again; normals under any affine transform.
#include "tracer/render/surface.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/bvh/traverse.h"

namespace tracer::test {
namespace {

struct SelfHits {
  int cast = 0;
  int hits = 0;
  int with_fixed_epsilon = 0;
};

// Hits random triangles of a soup, spawns rays to the same side, to the other side and grazing, and
// counts those that meet the triangle they left.
SelfHits self_hits(float coordinate, float size, const mat4& transform, int rays) {
  Mesh mesh = soup(2000, size);
  for (vec3& position : mesh.positions)
    position = position * size + vec3(coordinate);
  Scene scene = scene_of({std::move(mesh)});
  scene.instances[0].transform = transform;
  const SceneBvh bvh = bvh_of(scene);
  const Box box = bounds(bvh);
  std::mt19937 random(9);
  SelfHits result;
  for (int i = 0; i < rays; ++i) {
    const Mesh& aimed = scene.meshes[0];
    const vec3 target =
        aimed.positions[random() % aimed.positions.size()] + 0.3f * size * random_direction(random);
    Ray ray;
    ray.origin = center(box) + glm::length(extent(box)) * random_direction(random);
    ray.direction = glm::normalize(vec3(transform * vec4(target, 1.0f)) - ray.origin);
    NoProbe probe;
    const Hit hit = intersect(bvh, ray, probe);
    if (!is_hit(hit)) continue;
    const Surface surface = surface_at(scene, bvh, ray.direction, hit);
    vec3 way = random_direction(random);
    if (result.cast % 3 == 0) {
      const vec3& normal = surface.geometric_normal;
      way = glm::normalize(way - 0.999f * glm::dot(way, normal) * normal);
    }
    Ray next;
    next.direction = way;
    next.origin = spawn_point(surface, way);
    const Hit again = intersect(bvh, next, probe);
    ++result.cast;
    result.hits += is_hit(again) && again.triangle == hit.triangle ? 1 : 0;
    next.origin = surface.position + 1e-4f * way;
    const Hit old_way = intersect(bvh, next, probe);
    result.with_fixed_epsilon += is_hit(old_way) && old_way.triangle == hit.triangle ? 1 : 0;
  }
  return result;
}

TEST(Surface, NoSelfHitsAtAnyScale) {
  for (const float coordinate : {0.0f, 1e-3f, 1.0f, 100.0f, 1e4f, 1e6f}) {
    for (const float size : {0.01f, 1.0f, 100.0f}) {
      if (size < 1e-6f * coordinate) continue;  // no triangle is left
      const SelfHits found = self_hits(coordinate, size, mat4(1.0f), ray_count(50));
      EXPECT_EQ(found.hits, 0) << "of " << found.cast << " at " << coordinate << ", size " << size;
      EXPECT_GT(found.cast, 0);
    }
  }
}

TEST(Surface, NoSelfHitsInInstances) {
  mat4 shear(1.0f);
  shear[1][0] = 2.0f;
  const mat4 transforms[] = {
      glm::scale(mat4(1.0f), vec3(1e-3f)),
      glm::scale(mat4(1.0f), vec3(1e4f, 1.0f, 1e-2f)),
      glm::translate(mat4(1.0f), vec3(1e5f, -3e4f, 10.0f)),
      glm::translate(mat4(1.0f), vec3(50.0f, 20.0f, -70.0f)) *
          glm::rotate(mat4(1.0f), 1.1f, vec3(1, -2, 0.5f)) * shear,
      glm::scale(mat4(1.0f), vec3(-1.0f, 1.0f, 1.0f)),
  };
  for (const mat4& transform : transforms) {
    for (const float coordinate : {0.0f, 1.0f, 1e4f}) {
      const SelfHits found = self_hits(coordinate, 1.0f, transform, ray_count(50));
      EXPECT_EQ(found.hits, 0) << "of " << found.cast << " at " << coordinate;
      EXPECT_GT(found.cast, 0);
    }
  }
}

TEST(Surface, AFixedEpsilonFails) {
  const SelfHits found = self_hits(1e4f, 1.0f, mat4(1.0f), 2000);
  EXPECT_GT(found.with_fixed_epsilon, 100);
}

TEST(Surface, NormalsUnderNonUniformScale) {
  // The plane x + y = 1 scaled by 2 in x is x / 2 + y = 1: its normal is (1, 2, 0) / sqrt(5).
  Mesh mesh;
  mesh.positions = {vec3(1, 0, -1), vec3(0, 1, -1), vec3(0.5f, 0.5f, 1)};
  mesh.triangles = {{0, 1, 2}};
  mesh.normals.assign(3, glm::normalize(vec3(1, 1, 0)));
  Scene scene = scene_of({mesh});
  scene.instances[0].transform = glm::scale(mat4(1.0f), vec3(2, 1, 1));
  const SceneBvh bvh = bvh_of(scene);
  Ray ray{vec3(5, 2, 0), 0.0f, glm::normalize(vec3(-4, -1.5f, -0.3f)), infinity};
  NoProbe probe;
  const Hit hit = intersect(bvh, ray, probe);
  ASSERT_TRUE(is_hit(hit));
  const Surface surface = surface_at(scene, bvh, ray.direction, hit);
  const vec3 expected = glm::normalize(vec3(1, 2, 0));
  EXPECT_LT(glm::length(surface.geometric_normal - expected), 1e-5f);
  EXPECT_LT(glm::length(surface.shading_normal - expected), 1e-5f);
  EXPECT_TRUE(surface.front);
  EXPECT_LT(glm::length(surface.position - (ray.origin + hit.t * ray.direction)), 1e-5f);
}

TEST(Surface, NormalsUnderShear) {
  // Shearing x by y moves the ground y = 0 within itself and tilts the wall x = 0.
  Mesh mesh;
  mesh.positions = {vec3(0, -1, -1), vec3(0, 1, -1), vec3(0, 0, 1)};
  mesh.triangles = {{0, 1, 2}};
  mesh.normals.assign(3, vec3(1, 0, 0));
  Scene scene = scene_of({mesh});
  scene.instances[0].transform[1][0] = 1.0f;
  const SceneBvh bvh = bvh_of(scene);
  Ray ray{vec3(5, 0.1f, 0), 0.0f, vec3(-1, 0, 0), infinity};
  NoProbe probe;
  const Hit hit = intersect(bvh, ray, probe);
  ASSERT_TRUE(is_hit(hit));
  const Surface surface = surface_at(scene, bvh, ray.direction, hit);
  EXPECT_LT(glm::length(surface.shading_normal - glm::normalize(vec3(1, -1, 0))), 1e-5f);
}

TEST(Surface, InstanceMaterialReplacesTheMeshs) {
  Scene scene = scene_of({sphere(8)});
  scene.materials.resize(2);
  scene.instances[0].material = 1;
  const SceneBvh bvh = bvh_of(scene);
  Ray ray{vec3(0, 0.1f, 5), 0.0f, vec3(0, 0, -1), infinity};
  NoProbe probe;
  const Hit hit = intersect(bvh, ray, probe);
  ASSERT_TRUE(is_hit(hit));
  EXPECT_EQ(surface_at(scene, bvh, ray.direction, hit).material, 1u);
}

}  // namespace
}  // namespace tracer::test
