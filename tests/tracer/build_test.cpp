// T5 and T8: builders end, keep their promises on any input, and give the same tree every time.
#include "tracer/bvh/build.h"

#include <algorithm>
#include <bit>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "make_scene.h"
#include "tracer/analyze/tree_rules.h"
#include "tracer/error.h"

namespace tracer::test {
namespace {

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
      EXPECT_LE(log.optimized, boxes.size());
    }
  }
}

double sah(const Bvh& bvh) {
  double sum = 0.0;
  for (const BvhNode& node : bvh.nodes) {
    sum += half_area(box_of(node)) * (is_leaf(node) ? static_cast<double>(node.count) : 1.2);
  }
  return sum / half_area(box_of(bvh.nodes[0]));
}

// What bvh.h promises of a tree over the triangles of a mesh, which may be split.
void expect_sound_over(const Mesh& mesh, const BuildOptions& options) {
  const std::vector<Box> boxes = boxes_of(mesh);
  const Bvh bvh = build({boxes, &mesh}, options, nullptr, {});
  const auto limit = static_cast<float>(boxes.size()) * (1.0f + options.split_budget);
  EXPECT_LE(static_cast<float>(bvh.references.size()), limit);
  const TreeVerdict verdict = check_tree({bvh, boxes, options, &mesh, nullptr, 0});
  for (const Finding& finding : verdict.findings) {
    if (finding.severity == Severity::error) ADD_FAILURE() << finding.rule << finding.message;
  }
  for (const BvhNode& node : bvh.nodes) {
    std::vector<uint32_t> in_leaf(
        bvh.references.begin() + (is_leaf(node) ? node.first : 0),
        bvh.references.begin() + (is_leaf(node) ? node.first + node.count : 0));
    std::sort(in_leaf.begin(), in_leaf.end());
    ASSERT_EQ(std::adjacent_find(in_leaf.begin(), in_leaf.end()), in_leaf.end());
  }
}

void expect_sound_when_split(const Mesh& mesh) {
  for (const BuilderRow& builder : builders()) {
    for (const float budget : {0.0f, 0.3f, 4.0f}) {
      BuildOptions options;
      options.builder = builder.id;
      options.split_budget = budget;
      options.presplit = true;
      SCOPED_TRACE(fmt::format("{} {}", builder.id, budget));
      expect_sound_over(mesh, options);
      options.optimizer = "reinsertion";
      expect_sound_over(mesh, options);
      if (!builder.traits.splits_space) continue;
      options.presplit = false;
      options.min_overlap = 0.0f;
      expect_sound_over(mesh, options);
    }
  }
}

TEST(Build, SplittingIsSoundOnUsualMeshes) {
  expect_sound_when_split(soup(500, 0.7f));
  expect_sound_when_split(sphere(12));
  expect_sound_when_split(grid(12));
}

TEST(Build, SplittingIsSoundOnOddMeshes) {
  Mesh same = soup(150, 2.0f);
  for (uvec3& corners : same.triangles)
    corners = same.triangles[0];
  expect_sound_when_split(same);
  Mesh flat = soup(150, 0.5f);
  for (vec3& p : flat.positions)
    p.x = 3.0f;
  expect_sound_when_split(flat);
  Mesh huge = soup(150, 0.5f);
  for (vec3& p : huge.positions)
    p *= 1e18f;
  expect_sound_when_split(huge);
  Mesh tiny = soup(150, 0.5f);
  for (vec3& p : tiny.positions)
    p = p * 1e-30f;
  expect_sound_when_split(tiny);
  Mesh far = soup(150, 0.5f);
  for (vec3& p : far.positions)
    p += 1e6f;
  expect_sound_when_split(far);
  Mesh points = soup(150, 0.5f);
  for (const uvec3& corners : points.triangles)
    points.positions[corners.y] = points.positions[corners.z] = points.positions[corners.x];
  expect_sound_when_split(points);
}

// Long triangles along the diagonal of the unit cube.
Mesh diagonals(int count) {
  Mesh mesh = soup(count, 0.0f);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> offset(-0.3f, 0.3f);
  for (const uvec3& corners : mesh.triangles) {
    const vec3 at(offset(random), offset(random), offset(random));
    mesh.positions[corners.x] = at;
    mesh.positions[corners.y] = at + 1.0f;
    mesh.positions[corners.z] = at + vec3(1.0f, 1.0f, 1.01f);
  }
  return mesh;
}

TEST(Build, SplittingLowersTheSahOfDiagonals) {
  const Mesh mesh = diagonals(500);
  const std::vector<Box> boxes = boxes_of(mesh);
  BuildOptions options;
  options.split_budget = 4.0f;
  const double whole = sah(build({boxes, &mesh}, options, nullptr, {}));
  options.presplit = true;
  const Bvh split = build({boxes, &mesh}, options, nullptr, {});
  EXPECT_LT(sah(split), 0.6 * whole);
  EXPECT_GT(split.references.size(), 2 * boxes.size());
}

// Diagonals through a grid: their boxes hold all of it.
TEST(Build, SpatialSplitsPartWhatObjectSplitsCannot) {
  Mesh mesh = grid(30);
  const Mesh across = diagonals(200);
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (const uvec3& corners : across.triangles) {
    mesh.triangles.push_back(corners + first);
    mesh.materials.push_back(0);
  }
  mesh.positions.insert(mesh.positions.end(), across.positions.begin(), across.positions.end());
  mesh.normals.resize(mesh.positions.size(), vec3(0, 1, 0));
  const std::vector<Box> boxes = boxes_of(mesh);
  BuildOptions options;
  options.split_budget = 4.0f;
  const double whole = sah(build({boxes, &mesh}, options, nullptr, {}));
  options.builder = "sbvh";
  EXPECT_LT(sah(build({boxes, &mesh}, options, nullptr, {})), 0.9 * whole);
}

TEST(Build, WithoutAMeshNothingIsSplit) {
  const std::vector<Box> boxes = boxes_of(diagonals(300));
  BuildOptions options;
  options.builder = "sbvh";
  options.presplit = true;
  expect_sound(build({boxes}, options, nullptr, {}), boxes, options);
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
  expect_sound_everywhere(boxes_of(soup(80000, 0.02f)));
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
  ways.emplace_back().presplit = true;
  ways.emplace_back().presplit = true;
  ways.back().builder = "sbvh";
  for (const BuilderRow& builder : builders())
    ways.emplace_back().builder = builder.id;
  for (const OptimizerRow& optimizer : optimizers()) {
    ways.emplace_back().builder = "lbvh";
    ways.back().optimizer = optimizer.id;
  }
  return ways;
}

TEST(Build, SameTreeForAnyNumberOfThreads) {
  const Mesh mesh = soup(80000, 0.05f);
  const std::vector<Box> boxes = boxes_of(mesh);
  for (const BuildOptions& options : all_ways()) {
    Bvh first;
    for (const size_t threads : {1, 2, 8}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      const Bvh bvh = build({boxes, &mesh}, options, nullptr, {});
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
    const Mesh mesh = grid(20);
    EXPECT_TRUE(build({boxes_of(mesh), &mesh}, options, nullptr, stop.get_token()).nodes.empty());
  }
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

TEST(Build, ReinsertionTurnsToOtherNodesWhereSomeCannotMove) {
  const std::vector<Box> boxes = boxes_of(soup(20000, 0.3f));
  BuildOptions options;
  options.builder = "lbvh";
  const double before = sah_of(boxes, options);
  const auto gain = [&](float share, uint32_t rounds) {
    options.optimizer = "reinsertion";
    options.reinsertion_share = share;
    options.reinsertion_rounds = rounds;
    return before - sah_of(boxes, options);
  };
  // The largest twentieth alone: less than a fiftieth.
  EXPECT_GT(gain(0.05f, 30), 0.06 * gain(1.0f, 8));
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
