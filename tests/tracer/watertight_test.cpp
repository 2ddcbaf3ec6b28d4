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

// Rays to where an edge of a triangle meets a face of the box of a leaf that holds it: there the
// pieces of split triangles meet.
int leaks_between_pieces(const Scene& scene, const SceneBvh& bvh, const vec3& inside) {
  const Mesh& mesh = scene.meshes[0];
  const Bvh& tree = bvh.blases[0]->tree;
  std::mt19937 random(12);
  int missed = 0;
  const int rays = ray_count(20);
  for (int cast = 0; cast < rays;) {
    const BvhNode& leaf = tree.nodes[random() % tree.nodes.size()];
    if (!is_leaf(leaf)) continue;
    const uvec3 corners = mesh.triangles[tree.references[leaf.first + random() % leaf.count]];
    const vec3 a = mesh.positions[corners[random() % 3]];
    const vec3 b = mesh.positions[corners[random() % 3]];
    const int axis = static_cast<int>(random() % 3);
    const float at = random() % 2 == 0 ? leaf.lo[axis] : leaf.hi[axis];
    if ((a[axis] < at) == (b[axis] < at)) continue;
    const vec3 target = a + (at - a[axis]) / (b[axis] - a[axis]) * (b - a);
    const vec3 origin = inside + 0.3f * random_direction(random);
    NoProbe probe;
    missed += is_hit(intersect(bvh, {origin, 0.0f, target - origin, infinity}, probe)) ? 0 : 1;
    ++cast;
  }
  return missed;
}

TEST(Watertight, SplitTriangles) {
  const vec3 far(1483.0f, 123.0f, -2234.0f);
  for (const vec3& center : {vec3(0.0f), far}) {
    const Scene scene = scene_of({sphere(12, 2.0f, center, 1.0f)});
    BuildOptions options;
    options.builder = "sbvh";
    options.min_overlap = 0.0f;
    options.split_budget = 4.0f;
    for (const bool presplit : {false, true}) {
      options.presplit = presplit;
      const SceneBvh bvh = bvh_of(scene, options);
      ASSERT_GT(bvh.blases[0]->tree.references.size(), 350u);
      EXPECT_EQ(leaks(scene, bvh, center, 0.3f, ray_count(10)), 0);
      EXPECT_EQ(leaks_between_pieces(scene, bvh, center), 0);
    }
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
