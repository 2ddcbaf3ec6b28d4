// T2 and T3: a box is never missed whose content is hit.
#include "tracer/bvh/box_test.h"

#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/bvh/triangle_test.h"

namespace tracer::test {
namespace {

BvhNode node_of(const Box& box) {
  BvhNode node;
  node.lo = box.lo;
  node.hi = box.hi;
  node.first = 3;
  return node;
}

bool hits(const Box& box, const Ray& ray) {
  return box_span(node_of(box), box_ray(ray.origin, ray.direction), ray.t_min, ray.t_max).hit;
}

TEST(BoxTest, KnownDistances) {
  const BvhNode node = node_of({vec3(1, -1, -1), vec3(3, 1, 1)});
  const BoxSpan span = box_span(node, box_ray(vec3(0.0f), vec3(2, 0, 0)), 0.0f, infinity);
  EXPECT_FLOAT_EQ(span.entry, 0.5f);
  EXPECT_EQ(span.exit, 1.5f * exit_padding);
  EXPECT_TRUE(span.hit);
}

TEST(BoxTest, BehindAndBesideAndTooFar) {
  const Box box{vec3(1, -1, -1), vec3(3, 1, 1)};
  EXPECT_FALSE(hits(box, {vec3(0.0f), 0.0f, vec3(-1, 0, 0), infinity}));
  EXPECT_FALSE(hits(box, {vec3(0, 1.001f, 0), 0.0f, vec3(1, 0, 0), infinity}));
  EXPECT_FALSE(hits(box, {vec3(0.0f), 0.0f, vec3(1, 0, 0), 0.999f}));
  EXPECT_TRUE(hits(box, {vec3(0.0f), 0.0f, vec3(1, 0, 0), 1.0f}));
}

TEST(BoxTest, PairAgreesWithSingle) {
  std::mt19937 random(3);
  const Box space{vec3(-1.0f), vec3(1.0f)};
  for (int i = 0; i < 100000; ++i) {
    BvhNode pair[2];
    for (BvhNode& node : pair) {
      const vec3 a = random_point(random, space), b = random_point(random, space);
      node = node_of({glm::min(a, b), glm::max(a, b)});
    }
    const BoxRay ray = box_ray(random_point(random, space), random_direction(random));
    const BoxPairSpan both = box_pair_span(pair, ray, 0.0f, 1.5f);
    for (int k = 0; k < 2; ++k) {
      const BoxSpan one = box_span(pair[k], ray, 0.0f, 1.5f);
      ASSERT_EQ((both.hit >> k) & 1, one.hit ? 1 : 0);
      ASSERT_EQ(both.entry[k], one.entry);
      ASSERT_EQ(both.exit[k], one.exit);
    }
  }
}

// T2: random triangles, many of them flat in one axis; where the triangle is hit its box is, too.
TEST(BoxTest, NoHitTriangleOutsideItsBox) {
  std::mt19937 random(5);
  const Box space{vec3(-1.0f), vec3(1.0f)};
  int hit_count = 0;
  for (int i = 0; i < ray_count(); ++i) {
    LeafTriangle triangle[2] = {};
    Box box;
    const int flat = static_cast<int>(random() % 4);
    vec3 corners[3];
    for (vec3& corner : corners) {
      corner = random_point(random, space);
      if (flat < 3) corner[flat] = 0.37f;
      box = grown(box, corner);
    }
    for (int k = 0; k < 3; ++k) {
      triangle->x[k] = corners[k].x;
      triangle->y[k] = corners[k].y;
      triangle->z[k] = corners[k].z;
    }
    Ray ray;
    ray.origin = 3.0f * random_direction(random);
    // At a corner, an edge, or anywhere in the triangle.
    vec3 weight = random_point(random, {vec3(0.0f), vec3(1.0f)});
    if (i % 3 == 0) weight = vec3(1, 0, 0);
    if (i % 3 == 1) weight.z = 0.0f;
    weight /= weight.x + weight.y + weight.z;
    ray.direction =
        weight.x * corners[0] + weight.y * corners[1] + weight.z * corners[2] - ray.origin;
    const TriangleHit hit = intersect(
        *triangle, triangle_ray(ray.origin, ray.direction, box_ray(ray.origin, ray.direction)),
        0.0f, infinity);
    if (!hit.hit) continue;
    ++hit_count;
    ASSERT_TRUE(hits(box, ray)) << "ray " << i;
  }
  EXPECT_GT(hit_count, ray_count() / 4);
}

// T3: axis-parallel rays with either zero, on the planes, edges and corners of boxes.
TEST(BoxTest, AxisParallelRaysOnTheSurface) {
  std::mt19937 random(6);
  for (int i = 0; i < ray_count(); ++i) {
    const vec3 a = random_point(random, {vec3(-1.0f), vec3(1.0f)});
    const vec3 b = random_point(random, {vec3(-1.0f), vec3(1.0f)});
    Box box{glm::min(a, b), glm::max(a, b)};
    const int flat = static_cast<int>(random() % 3);
    if (i % 5 == 0) box.hi[flat] = box.lo[flat];
    const int axis = static_cast<int>(random() % 3);
    const float sign = random() % 2 ? 1.0f : -1.0f;
    Ray ray;
    for (int k = 0; k < 3; ++k) {
      ray.direction[k] = k == axis ? sign : (random() % 2 ? 0.0f : -0.0f);
      const uint32_t where = random() % 3;
      const float inside = 0.5f * box.lo[k] + 0.5f * box.hi[k];
      ray.origin[k] = where == 0 ? box.lo[k] : where == 1 ? box.hi[k] : inside;
    }
    const float start = (random() % 2 ? 0.0f : 1.0f) * sign;
    ray.origin[axis] = (sign > 0.0f ? box.lo[axis] : box.hi[axis]) - start;
    const BoxSpan span = box_span(node_of(box), box_ray(ray.origin, ray.direction), 0.0f, infinity);
    ASSERT_TRUE(span.hit) << "ray " << i;
    ASSERT_FALSE(std::isnan(span.entry) || std::isnan(span.exit));
  }
}

}  // namespace
}  // namespace tracer::test
