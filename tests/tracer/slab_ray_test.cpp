// A box is never missed that a ray passes through: by multiply-adds, rounded once or twice.
#include "tracer/bvh/slab_ray.h"

#include <algorithm>
#include <cmath>

#include <glm/gtx/string_cast.hpp>
#include <gtest/gtest.h>

#include "make_scene.h"

namespace tracer::test {
namespace {

// Where the ray is inside of a box, by both ways that processors multiply and add.
bool enters(const SlabRay& ray, const Box& box, bool is_fused) {
  float entry = 0.0f;
  float exit = infinity;
  for (int axis = 0; axis < 3; ++axis) {
    const bool backwards = ray.near_inverse[axis] < 0.0f;
    const float near = backwards ? box.hi[axis] : box.lo[axis];
    const float far = backwards ? box.lo[axis] : box.hi[axis];
    const auto distance = [&](float plane, float inverse, float from) {
      return is_fused ? std::fma(plane, inverse, -from) : plane * inverse - from;
    };
    entry = std::max(entry, distance(near, ray.near_inverse[axis], ray.from_near[axis]));
    exit = std::min(exit, distance(far, ray.far_inverse[axis], ray.from_far[axis]));
  }
  return entry <= exit;
}

// The least box around origin + t * direction.
Box around(const vec3& origin, const vec3& direction, double t) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = double(origin[axis]) + t * double(direction[axis]);
    const auto nearest = float(at);
    box.lo[axis] = double(nearest) <= at ? nearest : std::nextafter(nearest, -infinity);
    box.hi[axis] = double(nearest) >= at ? nearest : std::nextafter(nearest, infinity);
  }
  return box;
}

void expect_entered(const vec3& origin, const vec3& direction, double t) {
  const SlabRay ray = slab_ray<Tests::watertight>(origin, direction);
  const Box box = around(origin, direction, t);
  for (const bool is_fused : {true, false})
    ASSERT_TRUE(enters(ray, box, is_fused))
        << glm::to_string(origin) << " " << glm::to_string(direction) << " t " << t
        << (is_fused ? " fused" : "");
}

float power_of_ten(std::mt19937& random, float least, float most) {
  return std::pow(10.0f, std::uniform_real_distribution<float>(least, most)(random));
}

TEST(SlabRay, EntersTheLeastBoxesOnItsWay) {
  std::mt19937 random(7);
  for (int i = 0; i < 300000; ++i) {
    const float far = power_of_ten(random, -3.0f, 3.0f);
    const vec3 origin = random_point(random, {vec3(-far), vec3(far)});
    const vec3 direction = random_direction(random) * power_of_ten(random, -2.0f, 2.0f);
    expect_entered(origin, direction, double(power_of_ten(random, -4.0f, 4.0f)));
  }
}

// Some components are nothing, or nearly.
TEST(SlabRay, EntersThemAlongAxesAndPlanes) {
  std::mt19937 random(8);
  std::uniform_int_distribution<int> kind(0, 3);
  for (int i = 0; i < 300000; ++i) {
    vec3 origin = random_point(random, {vec3(-10.0f), vec3(10.0f)});
    vec3 direction = random_direction(random);
    for (int axis = 0; axis < 3; ++axis) {
      const int which = kind(random);
      if (which == 0) direction[axis] = std::copysign(0.0f, direction[axis]);
      if (which == 1) direction[axis] *= power_of_ten(random, -38.0f, -5.0f);
      if (kind(random) == 0) origin[axis] = 0.0f;
    }
    if (glm::length(direction) < 0.1f) continue;
    expect_entered(origin, direction, double(power_of_ten(random, -3.0f, 5.0f)));
  }
}

// Origins and directions of sizes that nobody wants.
TEST(SlabRay, EntersThemAtAbsurdSizes) {
  std::mt19937 random(9);
  for (int i = 0; i < 300000; ++i) {
    const float size = power_of_ten(random, -15.0f, 18.0f);
    const vec3 origin = random_point(random, {vec3(-size), vec3(size)});
    const float length = power_of_ten(random, -10.0f, 10.0f);
    const double t = double(size) / double(length) * double(power_of_ten(random, -2.0f, 2.0f));
    expect_entered(origin, random_direction(random) * length, t);
  }
}

TEST(SlabRay, PassesBoxesBeside) {
  const SlabRay ray = slab_ray<Tests::watertight>(vec3(0.0f, 2.0f, 0.0f), vec3(1, 0, 0));
  EXPECT_TRUE(enters(ray, {vec3(5, 1, -1), vec3(6, 3, 1)}, true));
  EXPECT_FALSE(enters(ray, {vec3(5, 2.00001f, -1), vec3(6, 3, 1)}, true));
  EXPECT_FALSE(enters(ray, {vec3(5, 1, -1), vec3(6, 1.99999f, 1)}, true));
  EXPECT_FALSE(enters(ray, {vec3(-6, 1, -1), vec3(-5, 3, 1)}, true));
}

}  // namespace
}  // namespace tracer::test
