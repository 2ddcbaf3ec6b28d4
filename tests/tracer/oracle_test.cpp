// T6: what the BVH hits is what brute force and Embree hit.
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "make_scene.h"
#include "tests/embree_scene.h"
#include "tracer/bvh/traverse.h"

namespace tracer::test {
namespace {

Ray random_ray(std::mt19937& random, const Box& box, int i) {
  Ray ray;
  ray.origin = i % 3 == 0 ? random_point(random, box)
                          : center(box) + glm::length(extent(box)) * random_direction(random);
  ray.direction = random_point(random, box) - ray.origin;
  if (i % 7 == 0) {
    ray.t_min = 0.3f;
    ray.t_max = 0.8f;
  }
  return ray;
}

void expect_brute_force(const Scene& scene, const BuildOptions& options, int rays) {
  const SceneBvh bvh = bvh_of(scene, options);
  std::mt19937 random(21);
  int hit_count = 0;
  for (int i = 0; i < rays; ++i) {
    const Ray ray = random_ray(random, bounds(bvh), i);
    NoProbe probe;
    const Hit expected = brute_force(scene, bvh, ray);
    ASSERT_EQ(intersect(bvh, ray, probe), expected) << "ray " << i;
    ASSERT_EQ(occluded(bvh, ray, probe), is_hit(expected)) << "ray " << i;
    hit_count += is_hit(expected) ? 1 : 0;
  }
  EXPECT_GT(hit_count, rays / 20);
}

std::vector<Scene> oracle_scenes() {
  std::vector<Scene> scenes;
  scenes.push_back(scene_of({soup(800, 0.05f)}));
  scenes.push_back(scene_of({soup(300, 3.0f)}));
  scenes.push_back(scene_of({sphere(16), grid(8), soup(100, 0.2f, 5)}));
  Mesh copies = soup(1, 0.5f);
  copies.triangles.resize(500, copies.triangles[0]);
  scenes.push_back(scene_of({copies}));
  Scene instanced = scene_of({sphere(8)});
  for (int i = 0; i < 20; ++i) {
    Instance instance;
    instance.transform =
        glm::translate(mat4(1.0f), vec3(i % 5, i / 5, 0.3f * static_cast<float>(i))) *
        glm::scale(glm::rotate(mat4(1.0f), 0.3f * static_cast<float>(i), vec3(1, 1, 0)),
                   vec3(0.5f, 1.0f, -0.7f));
    instanced.instances.push_back(instance);
  }
  scenes.push_back(std::move(instanced));
  return scenes;
}

TEST(Oracle, EveryBuilderEqualsBruteForce) {
  for (const BuilderRow& builder : builders()) {
    SCOPED_TRACE(std::string(builder.id));
    BuildOptions options;
    options.builder = builder.id;
    for (const OptimizerRow& optimizer : optimizers()) {
      SCOPED_TRACE(std::string(optimizer.id));
      options.optimizer = optimizer.id;
      for (const Scene& scene : oracle_scenes())
        expect_brute_force(scene, options, ray_count(2000));
    }
  }
}

// Rays along the sides of the boxes of turned instances far from the origin, where transforming a
// ray rounds most away.
TEST(Oracle, RaysAlongTheSidesOfInstancesEqualBruteForce) {
  std::mt19937 random(5);
  for (const float scale : {1.0f, 0.01f}) {
    SCOPED_TRACE(scale);
    Scene scene = scene_of({sphere(16)});
    scene.instances[0].transform =
        glm::translate(mat4(1.0f), vec3(0.0f, 1000.0f * scale, 0.0f)) *
        glm::scale(glm::rotate(mat4(1.0f), 0.9f, glm::normalize(vec3(1, 2, 3))), vec3(scale));
    const SceneBvh bvh = bvh_of(scene);
    const Box box = instance_boxes(bvh)[0];
    std::vector<vec3> points;
    for (const vec3& position : scene.meshes[0].positions) {
      points.push_back(vec3(bvh.instances[0].to_world * vec4(position, 1.0f)));
      EXPECT_EQ(united(box, grown(Box{}, points.back())), box);
    }
    int hit_count = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto less = [&](const vec3& a, const vec3& b) { return a[axis] < b[axis]; };
      const auto [least, most] = std::minmax_element(points.begin(), points.end(), less);
      for (int i = 0; i < 1000; ++i) {
        Ray ray;
        ray.direction = random_direction(random);
        ray.direction[axis] = 0.0f;
        ray.origin = (i % 2 == 0 ? *least : *most) - 3.0f * scale * ray.direction;
        NoProbe probe;
        const Hit expected = brute_force(scene, bvh, ray);
        EXPECT_EQ(intersect(bvh, ray, probe), expected) << "axis " << axis << " ray " << i;
        hit_count += is_hit(expected) ? 1 : 0;
      }
    }
    EXPECT_GT(hit_count, 500);
  }
}

TEST(Oracle, InstanceBoxesFitTurnedInstancesBetterThanTheirTurnedBox) {
  Scene scene = scene_of({sphere(16)});
  const mat4 turned = glm::rotate(mat4(1.0f), 0.8f, glm::normalize(vec3(1, 2, 3)));
  const Box upright = bounds(bvh_of(scene));
  Box corners;
  for (int i = 0; i < 8; ++i) {
    const vec3 corner((i & 1) != 0 ? upright.hi.x : upright.lo.x,
                      (i & 2) != 0 ? upright.hi.y : upright.lo.y,
                      (i & 4) != 0 ? upright.hi.z : upright.lo.z);
    corners = grown(corners, vec3(turned * vec4(corner, 1.0f)));
  }
  scene.instances[0].transform = turned;
  EXPECT_LT(half_area(instance_boxes(bvh_of(scene))[0]), 0.8f * half_area(corners));
}

TEST(Oracle, SplitTrianglesEqualBruteForce) {
  for (const char* builder : {"binned", "sbvh", "ploc"}) {
    for (const bool presplit : {false, true}) {
      BuildOptions options;
      options.builder = builder;
      options.presplit = presplit;
      options.split_budget = 4.0f;
      options.min_overlap = 0.0f;
      for (const Scene& scene : oracle_scenes())
        expect_brute_force(scene, options, ray_count(1000));
    }
  }
}

TEST(Oracle, EveryOptionEqualsBruteForce) {
  BuildOptions options;
  const Scene scene = scene_of({soup(500, 0.1f)});
  for (const uint32_t bins : {2u, 7u, 256u}) {
    options.bins = bins;
    expect_brute_force(scene, options, ray_count(1000));
  }
  options = {};
  for (const uint32_t leaf : {1u, 64u}) {
    options.max_leaf_size = leaf;
    expect_brute_force(scene, options, ray_count(1000));
  }
  options = {};
  for (const uint32_t depth : {1u, 5u, 96u}) {
    options.max_depth = depth;
    expect_brute_force(scene, options, ray_count(1000));
  }
}

// Embree computes t in another order of operations: equal up to rounding, and the same triangle
// unless two are equally near.
void expect_embree(const Mesh& mesh) {
  const Scene scene = scene_of({mesh});
  const SceneBvh bvh = bvh_of(scene);
  const EmbreeScene embree(scene, bvh.instances);
  std::mt19937 random(22);
  const int rays = ray_count(5);
  int differences = 0;
  int other_triangle = 0;
  for (int i = 0; i < rays; ++i) {
    const Ray ray = random_ray(random, bounds(bvh), 1);
    NoProbe probe;
    const Hit ours = intersect(bvh, ray, probe);
    const Hit theirs = embree.intersect(ray);
    if (is_hit(ours) != is_hit(theirs)) {
      ++differences;
    } else if (is_hit(ours)) {
      const float tolerance = 1e-5f * std::max(1.0f, theirs.t);
      differences += std::abs(ours.t - theirs.t) > tolerance ? 1 : 0;
      other_triangle += ours.triangle != theirs.triangle ? 1 : 0;
      if (ours.triangle == theirs.triangle) {
        ASSERT_NEAR(ours.u, theirs.u, 2e-3f);
        ASSERT_NEAR(ours.v, theirs.v, 2e-3f);
      }
    }
  }
  // Rays through an edge or silhouette, as rare as rounding errors are.
  EXPECT_LE(differences, rays / 50000);
  EXPECT_LE(other_triangle, rays / 1000);
}

TEST(Oracle, EmbreeAgreesOnASphere) {
  expect_embree(sphere(64, 1.0f, vec3(0.1f, 0.2f, 0.3f), 0.3f));
}

TEST(Oracle, EmbreeAgreesOnASoup) {
  expect_embree(soup(20000, 0.03f));
}

}  // namespace
}  // namespace tracer::test
