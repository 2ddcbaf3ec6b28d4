// T5 and T8: builders end, keep their promises on any input, and give the same tree every time.
#include "tracer/bvh/build.h"

#include <algorithm>
#include <bit>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "make_scene.h"
#include "tracer/error.h"

namespace tracer::test {
namespace {

std::vector<Box> boxes_of(const Mesh& mesh) {
  std::vector<Box> boxes;
  for (const uvec3& corners : mesh.triangles) {
    Box box;
    for (int k = 0; k < 3; ++k)
      box = grown(box, mesh.positions[corners[k]]);
    boxes.push_back(box);
  }
  return boxes;
}

// Everything that bvh.h promises.
void expect_sound(const Bvh& bvh, std::span<const Box> boxes, const BuildOptions& options) {
  ASSERT_FALSE(bvh.nodes.empty());
  std::vector<uint32_t> depth(bvh.nodes.size(), none);
  depth[0] = 0;
  uint32_t deepest = 0;
  std::vector<int> used(boxes.size());
  for (uint32_t i = 0; i < bvh.nodes.size(); ++i) {
    const BvhNode& node = bvh.nodes[i];
    ASSERT_NE(depth[i], none) << "node " << i << " has no parent before it";
    if (!is_leaf(node)) {
      ASSERT_GT(node.first, i);
      ASSERT_LT(node.first + 1, bvh.nodes.size());
      for (const uint32_t child : {node.first, node.first + 1}) {
        ASSERT_EQ(depth[child], none) << "node " << child << " has two parents";
        depth[child] = depth[i] + 1;
        ASSERT_TRUE(contains(box_of(node), box_of(bvh.nodes[child])));
      }
      continue;
    }
    deepest = std::max(deepest, depth[i]);
    Box content;
    for (uint32_t k = node.first; k < node.first + node.count; ++k) {
      ++used[bvh.references[k]];
      content = united(content, boxes[bvh.references[k]]);
    }
    ASSERT_EQ(content, box_of(node));
  }
  EXPECT_EQ(bvh.depth, deepest);
  EXPECT_LE(deepest, options.max_depth);
  EXPECT_THAT(used, testing::Each(1));
}

void expect_sound_everywhere(std::span<const Box> boxes, BuildOptions options = {}) {
  for (const BuilderRow& builder : builders()) {
    SCOPED_TRACE(std::string(builder.id));
    options.builder = builder.id;
    for (const OptimizerRow& optimizer : optimizers()) {
      SCOPED_TRACE(std::string(optimizer.id));
      options.optimizer = optimizer.id;
      BuildLog log;
      expect_sound(build({boxes}, options, &log, {}), boxes, options);
      EXPECT_EQ(log.placed, boxes.size());
    }
  }
}

TEST(Build, NothingGivesNothing) {
  EXPECT_TRUE(build({}, {}, nullptr, {}).nodes.empty());
}

TEST(Build, OneTriangleIsOneLeaf) {
  const Bvh bvh = build({boxes_of(soup(1, 1.0f))}, {}, nullptr, {});
  ASSERT_EQ(bvh.nodes.size(), 1u);
  EXPECT_EQ(bvh.nodes[0].count, 1u);
  EXPECT_EQ(bvh.depth, 0u);
}

TEST(Build, SoundOnUsualMeshes) {
  expect_sound_everywhere(boxes_of(sphere(50)));
  expect_sound_everywhere(boxes_of(soup(3000, 0.5f)));
  expect_sound_everywhere(boxes_of(grid(40)));
}

TEST(Build, SoundAboveTheParallelThreshold) {
  expect_sound_everywhere(boxes_of(grid(300)));
  expect_sound_everywhere(boxes_of(soup(150000, 0.02f)));
}

TEST(Build, DuplicatesEndInSmallLeaves) {
  const std::vector<Box> boxes(100000, Box{vec3(1.0f), vec3(2.0f)});
  expect_sound_everywhere(boxes);
  const Bvh bvh = build({boxes}, {}, nullptr, {});
  for (const BvhNode& node : bvh.nodes)
    ASSERT_LE(node.count, BuildOptions{}.max_leaf_size);
  EXPECT_LE(bvh.depth, 17u);
}

TEST(Build, OnePointAndOneLine) {
  expect_sound_everywhere(std::vector<Box>(5000, Box{vec3(3.0f), vec3(3.0f)}));
  std::vector<Box> line(5000);
  for (int i = 0; i < 5000; ++i)
    line[i] = {vec3(i, 0, 0), vec3(i, 0, 0)};
  expect_sound_everywhere(line);
}

TEST(Build, SameCentroidOtherSizes) {
  std::vector<Box> boxes;
  for (int i = 1; i < 5000; ++i)
    boxes.push_back({vec3(-i), vec3(i)});
  expect_sound_everywhere(boxes);
}

TEST(Build, GrowingGapsStayInTheDepthLimit) {
  // Each step doubles the distance: SAH alone would peel one box a level.
  std::vector<Box> boxes;
  float x = 1e-18f;
  for (int i = 0; i < 118; ++i, x *= 2.0f)
    boxes.push_back({vec3(x), vec3(x * 1.01f)});
  for (const uint32_t depth : {96u, 64u, 10u, 7u, 2u, 1u}) {
    BuildOptions options;
    options.max_depth = depth;
    expect_sound_everywhere(boxes, options);
  }
}

TEST(Build, GarbageOfAnyBitPattern) {
  std::mt19937 random(31);
  for (int scene = 0; scene < 300; ++scene) {
    std::vector<Box> boxes;
    while (boxes.size() < 1 + random() % 255) {
      Box box;
      for (int corner = 0; corner < 3; ++corner) {
        vec3 p(0.0f);
        for (int axis = 0; axis < 3; ++axis)
          p[axis] = std::bit_cast<float>(static_cast<uint32_t>(random()));
        box = grown(box, p);
      }
      const float size = std::max(glm::length(box.lo), glm::length(box.hi));
      if (size <= 1.844e18f) boxes.push_back(box);
    }
    expect_sound_everywhere(boxes);
  }
}

bool same(const Bvh& a, const Bvh& b) {
  return a.references == b.references && a.nodes.size() == b.nodes.size() &&
         std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(),
                    [](const BvhNode& m, const BvhNode& n) {
                      return m.lo == n.lo && m.hi == n.hi && m.first == n.first &&
                             m.count == n.count;
                    });
}

// Each builder alone, and each optimizer after one of them.
std::vector<BuildOptions> all_ways() {
  std::vector<BuildOptions> ways;
  for (const BuilderRow& builder : builders())
    ways.emplace_back().builder = builder.id;
  for (const OptimizerRow& optimizer : optimizers()) {
    ways.emplace_back().builder = "lbvh";
    ways.back().optimizer = optimizer.id;
  }
  return ways;
}

TEST(Build, SameTreeForAnyNumberOfThreads) {
  const std::vector<Box> boxes = boxes_of(soup(200000, 0.05f));
  for (const BuildOptions& options : all_ways()) {
    Bvh first;
    for (const size_t threads : {1, 2, 8}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      const Bvh bvh = build({boxes}, options, nullptr, {});
      if (threads == 1) first = bvh;
      EXPECT_TRUE(same(first, bvh))
          << options.builder << ", " << options.optimizer << ", threads " << threads;
    }
  }
}

TEST(Build, AStoppedBuildIsEmpty) {
  std::stop_source stop;
  stop.request_stop();
  for (const BuildOptions& options : all_ways()) {
    EXPECT_TRUE(build({boxes_of(grid(20))}, options, nullptr, stop.get_token()).nodes.empty());
  }
}

double sah(const Bvh& bvh) {
  double sum = 0.0;
  for (const BvhNode& node : bvh.nodes) {
    sum += half_area(box_of(node)) * (is_leaf(node) ? static_cast<double>(node.count) : 1.2);
  }
  return sum / half_area(box_of(bvh.nodes[0]));
}

double sah_of(std::span<const Box> boxes, BuildOptions options) {
  return sah(build({boxes}, options, nullptr, {}));
}

TEST(Build, BetterBuildersHaveLowerSah) {
  const std::vector<Box> boxes = boxes_of(soup(20000, 0.3f));
  const auto of = [&](const char* builder) {
    BuildOptions options;
    options.builder = builder;
    return sah_of(boxes, options);
  };
  EXPECT_LT(of("sweep"), 1.02 * of("binned"));
  EXPECT_LT(of("binned"), of("midpoint"));
  EXPECT_LT(of("binned"), of("median"));
  EXPECT_LT(of("ploc"), of("lbvh"));
}

TEST(Build, OptimizersLowerSah) {
  const std::vector<Box> boxes = boxes_of(soup(20000, 0.3f));
  for (const BuilderRow& builder : builders()) {
    BuildOptions options;
    options.builder = builder.id;
    const double before = sah_of(boxes, options);
    for (const char* optimizer : {"rotations", "reinsertion"}) {
      options.optimizer = optimizer;
      EXPECT_LT(sah_of(boxes, options), before) << builder.id << ", " << optimizer;
    }
  }
}

TEST(Build, CollapsingLowersSahAndKeepsTheLeafSize) {
  const std::vector<Box> boxes = boxes_of(grid(60));
  BuildOptions options;
  options.builder = "lbvh";
  options.max_leaf_size = 8;
  const Bvh collapsed = build({boxes}, options, nullptr, {});
  options.collapse = false;
  const Bvh single = build({boxes}, options, nullptr, {});
  EXPECT_EQ(single.nodes.size(), 2 * boxes.size() - 1);
  EXPECT_LT(collapsed.nodes.size(), single.nodes.size());
  EXPECT_LT(sah(collapsed), sah(single));
}

TEST(Build, UnknownBuilderNamesTheKnownOnes) {
  BuildOptions options;
  options.builder = "magic";
  try {
    check(options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("magic"));
    EXPECT_THAT(error.what(), testing::HasSubstr("binned"));
  }
}

TEST(Build, OptionsOutsideTheirRange) {
  BuildOptions options;
  options.bins = 1;
  EXPECT_THROW(check(options), Error);
  options = {};
  options.max_leaf_size = 0;
  EXPECT_THROW(check(options), Error);
  options = {};
  options.max_depth = 97;
  EXPECT_THROW(check(options), Error);
  options = {};
  options.traversal_cost = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(check(options), Error);
}

}  // namespace
}  // namespace tracer::test
