// T7: rays that no traversal should choke on, and what they give: nothing.
#include <chrono>
#include <limits>

#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/bvh/traverse.h"

namespace tracer::test {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

class OddRays : public testing::Test {
 protected:
  Scene scene = scene_of({sphere(20)});
  SceneBvh bvh = bvh_of(scene);

  bool hits(const Ray& ray) const {
    NoProbe probe;
    const bool hit = is_hit(intersect(bvh, ray, probe));
    EXPECT_EQ(hit, occluded(bvh, ray, probe));
    return hit;
  }
};

TEST_F(OddRays, NotANumberMisses) {
  EXPECT_FALSE(hits({vec3(nan, 0, 0), 0.0f, vec3(1, 0, 0), infinity}));
  EXPECT_FALSE(hits({vec3(0.0f), 0.0f, vec3(1, nan, 0), infinity}));
  EXPECT_FALSE(hits({vec3(0.0f), nan, vec3(1, 0, 0), infinity}));
  EXPECT_FALSE(hits({vec3(0.0f), 0.0f, vec3(1, 0, 0), nan}));
}

TEST_F(OddRays, InfinityMisses) {
  EXPECT_FALSE(hits({vec3(infinity, 0, 0), 0.0f, vec3(-1, 0, 0), infinity}));
  EXPECT_FALSE(hits({vec3(0.0f), 0.0f, vec3(infinity, 0, 0), infinity}));
  EXPECT_FALSE(hits({vec3(0.0f), infinity, vec3(1, 0, 0), infinity}));
}

TEST_F(OddRays, NoDirectionMisses) {
  EXPECT_FALSE(hits({vec3(0.0f), 0.0f, vec3(0.0f), infinity}));
  EXPECT_FALSE(hits({vec3(0.0f), 0.0f, vec3(0.0f, -0.0f, 1e-45f), infinity}));
}

TEST_F(OddRays, EmptyIntervalMisses) {
  EXPECT_FALSE(hits({vec3(0.0f), 3.0f, vec3(1, 0, 0), 2.0f}));
}

TEST_F(OddRays, AnyLengthOfDirectionHits) {
  EXPECT_TRUE(hits({vec3(0.0f), 0.0f, vec3(1e-30f, 2e-30f, 0), infinity}));
  EXPECT_TRUE(hits({vec3(0.0f), 0.0f, vec3(1e15f, 2e15f, 0), infinity}));
  EXPECT_TRUE(hits({vec3(0.0f), -5.0f, vec3(1, 1e-40f, -0.0f), infinity}));
}

TEST_F(OddRays, CostNoMoreThanOthers) {
  const auto seconds = [&](const Ray& ray) {
    const auto start = std::chrono::steady_clock::now();
    NoProbe probe;
    for (int i = 0; i < 20000; ++i) {
      EXPECT_LE(is_hit(intersect(bvh, ray, probe)) ? 1 : 0, 1);
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const double normal = seconds({vec3(0.0f), 0.0f, vec3(1, 2, 3), infinity});
  EXPECT_LT(seconds({vec3(nan), 0.0f, vec3(1, 0, 0), infinity}), 2.5 * normal);
  EXPECT_LT(seconds({vec3(0.0f), 0.0f, vec3(infinity, 0, 0), infinity}), 2.5 * normal);
}

}  // namespace
}  // namespace tracer::test
