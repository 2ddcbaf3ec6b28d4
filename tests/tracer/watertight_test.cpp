// T1: no ray leaves a closed mesh, aimed at vertices and edges, through the whole BVH.
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/bvh/traverse.h"

namespace tracer::test {
namespace {

// Rays from near `inside` to vertices and to points of edges of instance 0; counts the misses.
int leaks(const Scene& scene, const SceneBvh& bvh, const vec3& inside, float spread, int rays) {
  const Mesh& mesh = scene.meshes[0];
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  int missed = 0;
  for (int i = 0; i < rays; ++i) {
    const uvec3 corners = mesh.triangles[random() % mesh.triangles.size()];
    const vec3 a = mesh.positions[corners[random() % 3]];
    const vec3 b = mesh.positions[corners[random() % 3]];
    const vec3 target = i % 2 == 0 ? a : a + unit(random) * (b - a);
    Ray ray;
    ray.origin =
        vec3(bvh.instances[0].to_world * vec4(inside + spread * random_direction(random), 1.0f));
    ray.direction = vec3(bvh.instances[0].to_world * vec4(target, 1.0f)) - ray.origin;
    NoProbe probe;
    missed += is_hit(intersect(bvh, ray, probe)) ? 0 : 1;
    missed += occluded(bvh, ray, probe) ? 0 : 1;
  }
  return missed;
}

int leaks(const Scene& scene, const vec3& inside, float spread) {
  return leaks(scene, bvh_of(scene), inside, spread, ray_count(5));
}

TEST(Watertight, SphereAtTheOrigin) {
  EXPECT_EQ(leaks(scene_of({sphere(40)}), vec3(0.0f), 0.5f), 0);
}

TEST(Watertight, SphereFarAway) {
  const vec3 far(148376.0f, 1234.0f, -223423.0f);
  EXPECT_EQ(leaks(scene_of({sphere(100, 2.0f, far)}), far, 0.5f), 0);
}

TEST(Watertight, NoisySphere) {
  EXPECT_EQ(leaks(scene_of({sphere(60, 1.0f, vec3(0.3f, -0.2f, 0.1f), 3.0f)}),
                  vec3(0.3f, -0.2f, 0.1f), 0.1f),
            0);
}

TEST(Watertight, ThinNeedle) {
  Scene scene = scene_of({sphere(30)});
  for (vec3& position : scene.meshes[0].positions)
    position *= vec3(1e-3f, 1.0f, 2e-3f);
  EXPECT_EQ(leaks(scene, vec3(0.0f), 1e-4f), 0);
}

TEST(Watertight, ShearedInstance) {
  Scene scene = scene_of({sphere(40)});
  mat4 shear(1.0f);
  shear[1][0] = 0.7f;
  shear[2][1] = -1.3f;
  scene.instances[0].transform = glm::translate(mat4(1.0f), vec3(12.5f, -3.0f, 7.7f)) *
                                 glm::rotate(mat4(1.0f), 0.4f, vec3(1, 2, 3)) * shear *
                                 glm::scale(mat4(1.0f), vec3(0.1f, 5.0f, 1.0f));
  EXPECT_EQ(leaks(scene, vec3(0.0f), 0.4f), 0);
}

TEST(Watertight, TinyAndHugeMeshes) {
  EXPECT_EQ(leaks(scene_of({sphere(20, 1e-12f)}), vec3(0.0f), 1e-13f), 0);
  EXPECT_EQ(leaks(scene_of({sphere(20, 1e15f)}), vec3(0.0f), 1e14f), 0);
}

TEST(Watertight, DistancesInTinyAndHugeMeshes) {
  for (const float size : {1e-15f, 1e-12f, 1.0f, 1e12f, 1e15f, 1e18f}) {
    const SceneBvh bvh = bvh_of(scene_of({sphere(40, size)}));
    NoProbe probe;
    const Ray ray{size * vec3(3, 0.1f, 0.2f), 0.0f, vec3(-1, 0, 0), infinity};
    const Hit hit = intersect(bvh, ray, probe);
    ASSERT_TRUE(is_hit(hit)) << size;
    EXPECT_NEAR(hit.t / size, 3.0f - std::sqrt(1.0f - 0.05f), 0.02f) << size;
  }
}

// The tests above must be able to see a leak.
TEST(Watertight, AHoleIsFound) {
  Scene scene = scene_of({sphere(40)});
  scene.meshes[0].triangles.pop_back();
  const Scene closed = scene_of({sphere(40)});
  EXPECT_GT(leaks(closed, bvh_of(scene), vec3(0.0f), 0.5f, 200000), 0);
}

}  // namespace
}  // namespace tracer::test
