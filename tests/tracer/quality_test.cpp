#include "tracer/analyze/quality.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/tracer/hand_made.h"
#include "tests/tracer/make_scene.h"

namespace tracer::test {
namespace {

// A unit cube in front of a 1 x 1 x 3 box: the root is 1 x 1 x 4, half area 9.
Bvh two_leaves() {
  return {{inner({0, 0, 0}, {1, 1, 4}, 1), leaf({0, 0, 0}, {1, 1, 1}, 0, 1),
           leaf({0, 0, 1}, {1, 1, 4}, 1, 2)},
          {0, 1, 2},
          1};
}

TEST(Statistics, CountsTheTree) {
  const TreeStatistics result = statistics(two_leaves(), 1.2f, 1.0f);
  EXPECT_EQ(result.nodes, 3u);
  EXPECT_EQ(result.leaves, 2u);
  EXPECT_EQ(result.references, 3u);
  EXPECT_EQ(result.primitives, 3u);
  EXPECT_EQ(result.max_depth, 1u);
  EXPECT_EQ(result.max_leaf_size, 2u);
  EXPECT_DOUBLE_EQ(result.mean_leaf_depth, 1.0);
  EXPECT_EQ(result.bytes, 3u * 32 + 3 * 4);
  EXPECT_EQ(result.leaf_size_histogram, (std::vector<uint64_t>{0, 1, 1}));
  EXPECT_EQ(result.leaf_depth_histogram, (std::vector<uint64_t>{0, 2}));
}

TEST(Statistics, SahByHand) {
  // Half areas: root 9, leaves 3 and 7.
  EXPECT_NEAR(statistics(two_leaves(), 2.0f, 5.0f).sah, 2.0 + 5.0 * (3.0 / 9.0 * 1 + 7.0 / 9.0 * 2),
              1e-6);
}

TEST(Statistics, ReferencesThatRepeatAreOnePrimitive) {
  Bvh bvh = two_leaves();
  bvh.references = {0, 0, 1};
  EXPECT_EQ(statistics(bvh, 1, 1).references, 3u);
  EXPECT_EQ(statistics(bvh, 1, 1).primitives, 2u);
}

TEST(Statistics, EmptyTreeAndTreeWithoutArea) {
  EXPECT_EQ(statistics({}, 1, 1).nodes, 0u);
  EXPECT_EQ(statistics({}, 1, 1).sah, 0.0);
  const Bvh point{{leaf(vec3(1), vec3(1), 0, 4)}, {0, 1, 2, 3}, 0};
  EXPECT_DOUBLE_EQ(statistics(point, 1, 1).sah, 4.0);
}

TEST(Statistics, BoxesOfAnySize) {
  const float big = 1.8e18f;
  const Bvh huge{{leaf(vec3(-big), vec3(big), 0, 1)}, {0}, 0};
  EXPECT_DOUBLE_EQ(statistics(huge, 1, 1).sah, 1.0);
}

TEST(Statistics, OfAllBlasesWeighsSahByTriangles) {
  auto small = std::make_shared<Blas>();
  small->tree = {{leaf(vec3(0), vec3(1), 0, 1)}, {0}, 0};  // SAH 1
  auto large = std::make_shared<Blas>();
  large->tree = {{leaf(vec3(0), vec3(1), 0, 3)}, {0, 1, 2}, 0};  // SAH 3
  SceneBvh bvh;
  bvh.blases = {small, large};
  const TreeStatistics all = blas_statistics(bvh);
  EXPECT_EQ(all.leaves, 2u);
  EXPECT_EQ(all.primitives, 4u);
  EXPECT_DOUBLE_EQ(all.sah, (1.0 * 1 + 3.0 * 3) / 4);
  EXPECT_EQ(all.max_leaf_size, 3u);
}

TEST(RayStatistics, PercentilesByNearestRank) {
  // 100 pixels whose primary ray visited 1..100 nodes.
  const Film film = hand_made_film(10, 10, [](int x, int y) {
    return pixel_of(RayClass::primary, {1, uint32_t(1 + x + 10 * y), 0, 2, 0});
  });
  const RayStatistics primary = ray_statistics(film)[0];
  EXPECT_EQ(primary.count, 100u);
  EXPECT_DOUBLE_EQ(primary.nodes.mean, 50.5);
  EXPECT_EQ(primary.nodes.p50, 50.0);
  EXPECT_EQ(primary.nodes.p95, 95.0);
  EXPECT_EQ(primary.nodes.p99, 99.0);
  EXPECT_EQ(primary.nodes.max, 100.0);
  EXPECT_EQ(primary.triangles.mean, 2.0);
}

TEST(RayStatistics, EveryClassByItself) {
  const Film film = hand_made_film(70, 1, [](int x, int) {
    PixelContent pixel;
    pixel.counters[0] = {1, 4, 0, 0, 0};
    if (x < 10) pixel.counters[1] = {2, 7, 0, 0, 0};
    return pixel;
  });
  const auto all = ray_statistics(film);
  EXPECT_EQ(all[0].count, 70u);
  EXPECT_EQ(all[1].count, 20u);
  EXPECT_EQ(all[1].nodes.p50, 3.5);
  EXPECT_EQ(all[2].count, 0u);
  EXPECT_EQ(all[2].nodes.max, 0.0);
}

TEST(RayStatistics, SamePercentilesAsSorting) {
  std::vector<float> sorted;
  const Film film = hand_made_film(200, 150, [&](int x, int y) {
    const uint32_t nodes = uint32_t(x * 7919 + y * 104729) % 5003;
    const uint32_t rays = 1 + uint32_t(x + y) % 5;
    sorted.push_back(float(nodes) / float(rays));
    return pixel_of(RayClass::shadow, {rays, nodes, 0, 0, 0});
  });
  std::sort(sorted.begin(), sorted.end());
  const Percentiles nodes = ray_statistics(film)[1].nodes;
  EXPECT_EQ(nodes.p50, sorted[sorted.size() / 2 - 1]);
  EXPECT_EQ(nodes.p95, sorted[size_t(std::ceil(0.95 * double(sorted.size()))) - 1]);
  EXPECT_EQ(nodes.p99, sorted[size_t(std::ceil(0.99 * double(sorted.size()))) - 1]);
}

}  // namespace
}  // namespace tracer::test
