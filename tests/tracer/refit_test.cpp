// Refitted trees: boxes, hits, growth.
#include "tracer/bvh/refit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "make_scene.h"
#include "tracer/analyze/refit_growth.h"
#include "tracer/analyze/validate.h"
#include "tracer/bvh/traverse.h"
#include "tracer/scene/deform.h"

namespace tracer::test {
namespace {

const Deformer twist{"twist", 0.7f, "y", 0.0f};

// What a node must hold, by recursion.
Box content(const Bvh& tree, uint32_t index, std::span<const Box> boxes) {
  const BvhNode& node = tree.nodes[index];
  if (!is_leaf(node)) {
    return united(content(tree, node.first, boxes), content(tree, node.first + 1, boxes));
  }
  Box box;
  for (uint32_t i = node.first; i < node.first + node.count; ++i)
    box = united(box, boxes[tree.references[i]]);
  return box;
}

void expect_tight(const Bvh& tree, std::span<const Box> boxes) {
  for (uint32_t i = 0; i < tree.nodes.size(); ++i) {
    const BvhNode& node = tree.nodes[i];
    const Box expected =
        is_leaf(node) ? content(tree, i, boxes)
                      : united(box_of(tree.nodes[node.first]), box_of(tree.nodes[node.first + 1]));
    ASSERT_EQ(box_of(node), expected) << "node " << i;
  }
  EXPECT_EQ(box_of(tree.nodes[0]), content(tree, 0, boxes));
}

SceneBvh refitted_bvh(const Scene& rest, const Scene& moved, const BuildOptions& options) {
  std::vector<std::shared_ptr<const Blas>> blases = build_blases(rest, options, nullptr, {});
  for (size_t i = 0; i < blases.size(); ++i)
    blases[i] = refitted(*blases[i], moved.meshes[i]);
  return place_instances(moved, std::move(blases), options, 0.0f);
}

std::vector<BuildOptions> all_builders() {
  std::vector<BuildOptions> ways;
  for (const BuilderRow& builder : builders())
    ways.emplace_back().builder = builder.id;
  return ways;
}

TEST(Refit, BoxesAreThoseOfTheMovedMeshForEveryBuilder) {
  auto rest = std::make_shared<Scene>(scene_of({sphere(40, 1.0f, vec3(0.0f), 0.2f)}));
  const auto moved = deformed(rest, twist, 0.0f);
  for (const BuildOptions& options : all_builders()) {
    SCOPED_TRACE(options.builder);
    const SceneBvh bvh = refitted_bvh(*rest, *moved, options);
    expect_tight(bvh.blases[0]->tree, boxes_of(moved->meshes[0]));
  }
}

TEST(Refit, ValidateFindsNothingAfterIt) {
  auto rest = std::make_shared<Scene>(scene_of({sphere(20), soup(400, 0.2f)}));
  for (const DeformerRow& row : deformers()) {
    const auto moved = deformed(rest, {std::string(row.id), 0.5f, "x", 0.0f}, 0.0f);
    for (const BuildOptions& options : all_builders()) {
      SCOPED_TRACE(options.builder);
      const Validation result = validate(*moved, refitted_bvh(*rest, *moved, options), 2000, {});
      EXPECT_FALSE(has_errors(result)) << row.id;
      EXPECT_EQ(result.mismatches, 0u) << row.id;
    }
  }
}

TEST(Refit, HitsAreThoseOfBruteForce) {
  auto rest = std::make_shared<Scene>(scene_of({soup(300, 0.3f)}));
  const auto moved = deformed(rest, {"explode", 1.0f, "y", 0.0f}, 0.0f);
  const SceneBvh bvh = refitted_bvh(*rest, *moved, {});
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    const vec3 origin = 3.0f * random_direction(random);
    const Ray ray{origin, 0.0f, random_point(random, {vec3(0.0f), vec3(1.0f)}) - origin, infinity};
    NoProbe probe;
    ASSERT_EQ(intersect(bvh, ray, probe), brute_force(*moved, bvh, ray));
  }
}

TEST(Refit, SameForAnyNumberOfThreads) {
  auto rest = std::make_shared<Scene>(scene_of({sphere(150)}));
  const auto moved = deformed(rest, twist, 0.0f);
  std::vector<BvhNode> first;
  for (const size_t threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const SceneBvh bvh = refitted_bvh(*rest, *moved, {});
    const auto& nodes = bvh.blases[0]->tree.nodes;
    ASSERT_GT(nodes.size(), 1u << 14) << "or it is not parallel";
    if (threads == 1) {
      expect_tight(bvh.blases[0]->tree, boxes_of(moved->meshes[0]));
      first.assign(nodes.begin(), nodes.end());
    }
    for (size_t i = 0; i < nodes.size(); ++i)
      ASSERT_EQ(box_of(nodes[i]), box_of(first[i])) << threads << " threads, node " << i;
  }
}

TEST(Refit, OfATreeOverBoxes) {
  std::vector<Box> boxes = boxes_of(soup(5000, 0.1f));
  Bvh tree = build({boxes}, {}, nullptr, {});
  for (Box& box : boxes)
    box = {2.0f * box.lo - 1.0f, 2.0f * box.hi + 1.0f};
  refit(tree, boxes);
  expect_tight(tree, boxes);
}

TEST(Refit, NothingAndOneTriangle) {
  Bvh nothing;
  refit(nothing, std::span<const Box>());
  EXPECT_TRUE(nothing.nodes.empty());
  const Scene one = scene_of({soup(1, 1.0f)});
  const Scene other = scene_of({soup(1, 1.0f, 9)});
  const SceneBvh bvh = refitted_bvh(one, other, {});
  EXPECT_EQ(box_of(bvh.blases[0]->tree.nodes[0]), boxes_of(other.meshes[0])[0]);
}

// A leaf of a split triangle gets the box of the whole triangle.
TEST(Refit, SplitReferencesGetWholeTriangles) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  Blas blas;
  blas.tree.nodes.resize(3, BvhNode{});
  blas.tree.nodes[0] = {{0, 0, 0}, 1, {2, 1, 0}, 0};
  blas.tree.nodes[1] = {{0, 0, 0}, 0, {1, 1, 0}, 1};
  blas.tree.nodes[2] = {{1, 0, 0}, 1, {2, 0.5f, 0}, 1};
  blas.tree.references = {0, 0};
  blas.tree.depth = 1;
  EXPECT_TRUE(has_split_references(blas, mesh));
  const auto result = refitted(blas, mesh);
  for (const BvhNode& node : result->tree.nodes)
    EXPECT_EQ(box_of(node), (Box{{0, 0, 0}, {2, 1, 0}}));
  EXPECT_EQ(result->triangles.size(), 3u);
  EXPECT_FALSE(has_split_references(*bvh_of(scene_of({mesh})).blases[0], mesh));
}

TEST(RefitGrowth, IsOneWithoutARefit) {
  const RefitGrowth growth = refit_growth(bvh_of(scene_of({sphere(8)})));
  EXPECT_EQ(growth.mean, 1.0);
  EXPECT_EQ(growth.max, 1.0);
  EXPECT_EQ(growth.node, none);
}

TEST(RefitGrowth, OfAMeshTwiceAsLargeIsFour) {
  const Scene rest = scene_of({sphere(12)});
  Scene moved = rest;
  for (vec3& p : moved.meshes[0].positions)
    p *= 2.0f;
  const SceneBvh bvh = refitted_bvh(rest, moved, {});
  const RefitGrowth growth = refit_growth(bvh);
  EXPECT_NEAR(growth.mean, 4.0, 1e-5);
  EXPECT_NEAR(growth.max, 4.0, 1e-4);
  EXPECT_EQ(growth.mesh, 0u);
  EXPECT_THAT(triangle_growth(*bvh.blases[0], rest.meshes[0].triangles.size()),
              testing::Each(testing::FloatNear(4.0f, 1e-4f)));
}

TEST(RefitGrowth, ASecondRefitCountsFromTheBuild) {
  Mesh mesh = sphere(12);
  const auto built = build_blas(mesh, {}, nullptr, {});
  for (vec3& p : mesh.positions)
    p *= 3.0f;
  const auto once = refitted(*built, mesh);
  const auto twice = refitted(*once, mesh);
  EXPECT_EQ(node_growth(*twice), node_growth(*once));
  EXPECT_EQ(once->built_areas, twice->built_areas);
  EXPECT_NEAR(node_growth(*twice)[0], 9.0f, 1e-4f);
}

TEST(RefitGrowth, NodesWithoutAreaStayFinite) {
  Mesh mesh = soup(200, 0.1f);
  Mesh line = mesh;
  for (vec3& p : line.positions)
    p = vec3(p.x, 0.0f, 0.0f);
  const auto blas = refitted(*build_blas(line, {}, nullptr, {}), mesh);
  for (const float growth : node_growth(*blas))
    EXPECT_TRUE(std::isfinite(growth));
}

}  // namespace
}  // namespace tracer::test
