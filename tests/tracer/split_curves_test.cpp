// Split candidates of a node against brute force and against what the builders did.
#include "tracer/analyze/split_curves.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/choice.h"

namespace tracer::test {
namespace {

struct Built {
  Built(Mesh mesh, const BuildOptions& options) : scene(scene_of({std::move(mesh)})) {
    bvh = std::make_shared<const SceneBvh>(bvh_of(scene, options));
    table =
        tree_table(bvh->blases[0]->tree, false, options.traversal_cost, options.intersection_cost);
  }
  NodeSplits splits(uint32_t node) const { return node_splits(scene, bvh, table, 0, node, {}); }

  Scene scene;
  std::shared_ptr<const SceneBvh> bvh;
  TreeTable table;
};

BuildOptions options_of(const char* builder) {
  BuildOptions options;
  options.builder = builder;
  options.traversal_cost = 1.5f;
  options.intersection_cost = 2.0f;
  return options;
}

std::vector<Box> boxes_below(const Built& built, uint32_t node) {
  std::vector<Box> boxes;
  const std::vector<Box> all = boxes_of(built.scene.meshes[0]);
  std::vector<uint32_t> stack = {node};
  while (!stack.empty()) {
    const uint32_t at = stack.back();
    const TableNode row = built.table.nodes[at];
    stack.pop_back();
    for (uint32_t i = 0; is_leaf(row) && i < row.references; ++i)
      boxes.push_back(all[built.table.references[row.first + i]]);
    for (const uint32_t child : children_of(built.table, at))
      stack.push_back(child);
  }
  return boxes;
}

// NaN where a side is empty.
double brute_force_cost(const std::vector<Box>& boxes, int axis, double at) {
  Box left, right, all;
  double left_count = 0.0, right_count = 0.0;
  for (const Box& box : boxes) {
    const bool goes_left = 0.5 * (double(box.lo[axis]) + double(box.hi[axis])) < at;
    (goes_left ? left : right) = united(goes_left ? left : right, box);
    (goes_left ? left_count : right_count) += 1.0;
    all = united(all, box);
  }
  if (left_count == 0.0 || right_count == 0.0) return NAN;
  const double children =
      double(half_area(left)) * left_count + double(half_area(right)) * right_count;
  return 1.5 + 2.0 * children / double(half_area(all));
}

const SplitChoice& choice(const NodeSplits& splits, std::string_view id) {
  return *find_row(std::span<const SplitChoice>(splits.builders), id);
}

TEST(SplitCurves, AreThoseOfBruteForce) {
  const Built built(soup(700, 0.2f), options_of("binned"));
  for (const uint32_t node : {0u, 1u, 5u}) {
    const NodeSplits splits = built.splits(node);
    const std::vector<Box> boxes = boxes_below(built, node);
    ASSERT_EQ(splits.references, boxes.size());
    EXPECT_DOUBLE_EQ(splits.leaf_cost, 2.0 * double(boxes.size()));
    for (int axis = 0; axis < 3; ++axis) {
      const SplitCurve& curve = splits.axes[axis];
      ASSERT_EQ(curve.at.size(), split_places);
      ASSERT_EQ(curve.objects.size(), split_places);
      ASSERT_EQ(curve.space.size(), split_places);
      EXPECT_TRUE(std::is_sorted(curve.at.begin(), curve.at.end()));
      for (size_t i = 0; i < curve.at.size(); ++i) {
        const double wanted = brute_force_cost(boxes, axis, curve.at[i]);
        EXPECT_EQ(std::isnan(wanted), std::isnan(curve.objects[i]));
        if (std::isnan(wanted)) continue;
        EXPECT_NEAR(curve.objects[i], wanted, 1e-4 * wanted);
      }
    }
  }
}

// Where no triangle crosses a plane, cutting there is the same as going by centres.
TEST(SplitCurves, InSpaceCountsWhatTheCutMakes) {
  Mesh mesh;  // two flat triangles side by side, and a long one over both
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3, 0, 0}, {4, 0, 0},
                    {4, 1, 0}, {0, 0, 1}, {4, 0, 1}, {4, 1, 1}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  const NodeSplits splits = Built(mesh, options_of("binned")).splits(0);
  const SplitCurve& x = splits.axes[0];
  const size_t middle = split_places / 2;
  ASSERT_NEAR(x.at[middle], 2.0, 1e-6);
  // Left: box (0,0,0)-(2,.5,1) with the first triangle (0,0,0)-(1,1,0): (0,0,0)-(2,1,1), two of
  // them; right likewise.
  const double area = 4.0 * 1.0 + 1.0 * 1.0 + 1.0 * 4.0, half = 2.0 + 1.0 + 2.0;
  EXPECT_NEAR(x.space[middle], 1.5 + 2.0 * (2.0 * half + 2.0 * half) / area, 1e-4);
  // By centres the long one goes whole to the right: (0,0,0)-(4,1,1).
  EXPECT_NEAR(x.objects[middle], 1.5 + 2.0 * (1.0 * 1.0 + 2.0 * area) / area, 1e-4);
}

class EveryBuilderSplits : public testing::TestWithParam<const char*> {};

// The panel says what a builder would choose: the builder itself has to agree at every node.
TEST_P(EveryBuilderSplits, AsThePanelSays) {
  const Built built(soup(3000, 0.05f), options_of(GetParam()));
  int inner = 0;
  for (uint32_t node = 0; node < built.table.nodes.size(); node += 1 + node / 16) {
    const NodeSplits splits = built.splits(node);
    const SplitChoice& said = choice(splits, GetParam());
    const bool leaf = is_leaf(built.table.nodes[node]);
    EXPECT_EQ(splits.tree.leaf, leaf);
    if (splits.references < 2) continue;
    EXPECT_EQ(said.leaf, leaf) << node;
    if (leaf) continue;
    ++inner;
    EXPECT_NEAR(splits.tree.cost, said.cost, 1e-4 * said.cost) << node;
    EXPECT_EQ(std::min(splits.tree.left, splits.tree.right), std::min(said.left, said.right));
    ASSERT_GE(splits.tree.axis, 0) << node;
    if (splits.references < 100) continue;  // of a few, more than one axis may tell them apart
    EXPECT_EQ(splits.tree.axis, said.axis) << node;
    const float size = extent(built.table.nodes[node].box)[said.axis];
    EXPECT_NEAR(splits.tree.at, said.at, 0.05 * double(size)) << node;
  }
  EXPECT_GT(inner, 20);
}

INSTANTIATE_TEST_SUITE_P(SplitCurves, EveryBuilderSplits,
                         testing::Values("midpoint", "median", "binned", "sweep"),
                         [](const auto& info) { return std::string(info.param); });

TEST(SplitCurves, SweepIsTheCheapestOfWholeTriangles) {
  const NodeSplits splits = Built(soup(2000, 0.3f), options_of("median")).splits(0);
  const double best = choice(splits, "sweep").cost;
  for (const char* id : {"midpoint", "median", "binned"})
    EXPECT_GE(choice(splits, id).cost, best - 1e-6) << id;
  for (const SplitCurve& curve : splits.axes) {
    for (const double cost : curve.objects)
      EXPECT_FALSE(cost < best - 1e-6);
  }
  EXPECT_NEAR(splits.tree.cost, choice(splits, "median").cost, 1e-4);
}

// Two heaps of small triangles far from each other, and a few long ones over both.
Mesh heaps() {
  Mesh mesh = soup(400, 0.1f);
  for (size_t i = 0; i < mesh.positions.size() / 2; ++i)
    mesh.positions[i].x += 10.0f;
  for (uint32_t i = 0; i < 8; ++i) {
    const float y = 0.1f * float(i);
    mesh.triangles.push_back(uvec3(0, 1, 2) + uint32_t(mesh.positions.size()));
    for (const vec3 corner : {vec3(0, y, 0), vec3(11, y, 1), vec3(11, y + 0.1f, 0)})
      mesh.positions.push_back(corner);
  }
  return mesh;
}

TEST(SplitCurves, SbvhCutsLongTrianglesWhereItSaid) {
  BuildOptions options = options_of("sbvh");
  options.split_budget = 4.0f;
  const Built built(heaps(), options);
  const NodeSplits splits = built.splits(0);
  const SplitChoice& said = choice(splits, "sbvh");
  ASSERT_TRUE(said.space);
  EXPECT_LT(said.cost, choice(splits, "sweep").cost);
  ASSERT_TRUE(splits.tree.space) << "the tree has triangles on both sides";
  EXPECT_EQ(splits.tree.axis, said.axis);
  EXPECT_NEAR(splits.tree.at, said.at, 1e-4);
  EXPECT_LE(splits.tree.cost, said.cost * 1.0001) << "leaving some whole is cheaper";
  EXPECT_GT(splits.tree.left + splits.tree.right, splits.references);
}

TEST(SplitCurves, OfTheTopLevelAreOverInstances) {
  std::vector<Mesh> meshes;
  for (int i = 0; i < 9; ++i)
    meshes.push_back(sphere(4, 0.4f, vec3(float(i), 0, 0)));
  const Scene scene = scene_of(meshes);
  const auto bvh = std::make_shared<const SceneBvh>(bvh_of(scene, options_of("sweep")));
  const TreeTable table = tree_table(bvh->tlas, true, 1.5f, 2.0f);
  const NodeSplits splits = node_splits(scene, bvh, table, none, 0, {});
  EXPECT_EQ(splits.references, 9u);
  EXPECT_EQ(splits.tree.axis, 0);
  EXPECT_TRUE(splits.axes[0].space.empty());
  EXPECT_NEAR(splits.tree.cost, choice(splits, "sweep").cost, 1e-4);
}

TEST(SplitCurves, OfOneTriangleAndOfFlatOnesAreEmpty) {
  const NodeSplits one = Built(soup(1, 0.1f), options_of("binned")).splits(0);
  EXPECT_EQ(one.references, 1u);
  EXPECT_TRUE(one.builders.empty());
  EXPECT_TRUE(one.tree.leaf);
  const NodeSplits flat = Built(grid(8), options_of("binned")).splits(0);
  EXPECT_TRUE(flat.axes[1].at.empty()) << "the plane y = 0 has no extent there";
  EXPECT_FALSE(flat.axes[0].at.empty());
}

TEST(SplitCurves, StoppedIsOfNothing) {
  std::stop_source source;
  source.request_stop();
  const Built built(soup(100, 0.1f), options_of("binned"));
  const Job job{source.get_token(), nullptr};
  EXPECT_EQ(node_splits(built.scene, built.bvh, built.table, 0, 0, job).bvh, nullptr);
}

}  // namespace
}  // namespace tracer::test
