// Which boxes are drawn: levels, selections, filters, limits.
#include "tracer/analyze/box_set.h"

#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/choice.h"

namespace tracer::test {
namespace {

using BvhPointer = std::shared_ptr<const SceneBvh>;

// Three spheres: mesh 0 shown twice, mesh 1 once.
BvhPointer two_meshes() {
  Scene scene = scene_of({sphere(12), sphere(6)});
  scene.instances.push_back(scene.instances[0]);
  scene.instances[1].transform = glm::mat4(1.0f);
  scene.instances[1].transform[3] = {5, 0, 0, 1};
  scene.instances[2].transform[0] = {2, 0, 0, 0};
  scene.instances[2].transform[3] = {-5, 0, 0, 1};
  return std::make_shared<const SceneBvh>(bvh_of(scene));
}

BoxOptions with(std::string what, std::string tree = "scene") {
  BoxOptions options;
  options.show = true;
  options.what = std::move(what);
  options.tree = std::move(tree);
  return options;
}

BoxOptions levels(int first, int last, std::string tree) {
  BoxOptions options = with("levels", std::move(tree));
  options.first_level = first;
  options.last_level = last;
  return options;
}

size_t of_depth(const Bvh& tree, uint32_t depth) {
  const TreeTable table = tree_table(tree, false, 1.0f, 1.0f);
  return size_t(std::count_if(table.nodes.begin(), table.nodes.end(),
                              [&](const TableNode& node) { return node.depth == depth; }));
}

size_t leaves(const Bvh& tree) {
  return size_t(std::count_if(tree.nodes.begin(), tree.nodes.end(),
                              [](const BvhNode& node) { return is_leaf(node); }));
}

TEST(NodeBoxes, OfLevelsThroughEachInstance) {
  const BvhPointer bvh = two_meshes();
  const Bvh& a = bvh->blases[0]->tree;
  const Bvh& b = bvh->blases[1]->tree;
  for (int level = 0; level < 6; ++level) {
    const NodeBoxes boxes = node_boxes(bvh, levels(level, level, "blas"), {});
    const uint32_t depth = uint32_t(level);
    EXPECT_EQ(boxes.boxes.size(), 2 * of_depth(a, depth) + of_depth(b, depth)) << level;
    EXPECT_EQ(boxes.found, boxes.boxes.size());
    EXPECT_FALSE(boxes.at_least);
  }
}

TEST(NodeBoxes, LevelsAreCountedThroughTheTlas) {
  const BvhPointer bvh = two_meshes();
  ASSERT_EQ(bvh->instances.size(), 3u);
  const NodeBoxes top = node_boxes(bvh, levels(0, 255, "tlas"), {});
  EXPECT_EQ(top.boxes.size(), bvh->tlas.nodes.size());
  const NodeBoxes all = node_boxes(bvh, levels(0, 255, "scene"), {});
  EXPECT_EQ(all.boxes.size(), bvh->tlas.nodes.size() + 2 * bvh->blases[0]->tree.nodes.size() +
                                  bvh->blases[1]->tree.nodes.size());
  for (const NodeBox& box : node_boxes(bvh, levels(4, 4, "scene"), {}).boxes)
    EXPECT_EQ(box.value, 4.0f) << "the colour says so too";
  const NodeBoxes root = node_boxes(bvh, levels(0, 0, "scene"), {});
  ASSERT_EQ(root.boxes.size(), 1u);
  EXPECT_EQ(root.boxes[0].place, (NodePlace{none, 0}));
}

TEST(NodeBoxes, OfLeaves) {
  const BvhPointer bvh = two_meshes();
  EXPECT_EQ(node_boxes(bvh, with("leaves"), {}).boxes.size(),
            2 * leaves(bvh->blases[0]->tree) + leaves(bvh->blases[1]->tree));
  EXPECT_EQ(node_boxes(bvh, with("leaves", "tlas"), {}).boxes.size(), leaves(bvh->tlas));
}

std::set<uint32_t> nodes_of(const NodeBoxes& boxes) {
  std::set<uint32_t> nodes;
  for (const NodeBox& box : boxes.boxes)
    nodes.insert(box.place.node);
  return nodes;
}

TEST(NodeBoxes, OfTheSelectedNode) {
  const BvhPointer bvh = two_meshes();
  const TreeTable table = tree_table(bvh->blases[0]->tree, false, 1.0f, 1.0f);
  const uint32_t node = children_of(table, children_of(table, 0)[1])[0];
  BoxSources sources;
  EXPECT_TRUE(node_boxes(bvh, with("node"), sources).boxes.empty()) << "nothing is selected";
  sources.selected = NodePlace{0, node};
  EXPECT_EQ(node_boxes(bvh, with("node"), sources).boxes.size(), 2u) << "two instances";
  sources.instance = 0;
  EXPECT_EQ(node_boxes(bvh, with("node"), sources).boxes.size(), 1u);
  EXPECT_EQ(node_boxes(bvh, with("node"), sources).boxes[0].depth, 2u);

  const uint32_t first = children_of(table, node)[0];
  EXPECT_EQ(nodes_of(node_boxes(bvh, with("children"), sources)),
            (std::set<uint32_t>{node, first, first + 1}));
  const NodeBoxes above = node_boxes(bvh, with("ancestors", "blas"), sources);
  const std::vector<uint32_t> way = path_to(table, node);
  EXPECT_EQ(nodes_of(above), std::set<uint32_t>(way.begin(), way.end()));
  EXPECT_GT(node_boxes(bvh, with("ancestors"), sources).boxes.size(), above.boxes.size())
      << "and the TLAS above the instance";

  BoxOptions subtree = with("subtree");
  subtree.first_level = 0;
  subtree.last_level = 255;
  size_t below = 0;
  for (uint32_t other = 0; other < table.nodes.size(); ++other) {
    const std::vector<uint32_t> path = path_to(table, other);
    below += size_t(std::count(path.begin(), path.end(), node));
  }
  EXPECT_EQ(node_boxes(bvh, subtree, sources).boxes.size(), below);
  sources.selected = NodePlace{0, 1u << 30};
  EXPECT_TRUE(node_boxes(bvh, with("node"), sources).boxes.empty());
}

TEST(NodeBoxes, WhatIsHiddenOrNotIsolatedIsLeftOut) {
  const BvhPointer bvh = two_meshes();
  const uint32_t left = bvh->blases[0]->tree.nodes[0].first;
  const size_t all = node_boxes(bvh, with("leaves"), {}).boxes.size();
  BoxSources hiding;
  hiding.hidden = {{0, left}};
  BoxSources isolating;
  isolating.isolated = NodePlace{0, left};
  const size_t others = node_boxes(bvh, with("leaves"), hiding).boxes.size();
  const size_t own = node_boxes(bvh, with("leaves"), isolating).boxes.size();
  EXPECT_GT(own, 0u);
  EXPECT_EQ(others + own, all);
  hiding.hidden = {{none, 0}};
  EXPECT_TRUE(node_boxes(bvh, with("leaves"), hiding).boxes.empty());
  isolating.isolated = NodePlace{none, 0};
  EXPECT_EQ(node_boxes(bvh, with("leaves"), isolating).boxes.size(), all);
  EXPECT_EQ(node_boxes(bvh, with("leaves", "blas"), isolating).boxes.size(), all)
      << "the TLAS is not drawn";
}

TEST(NodeBoxes, OfTooManyTheLargestAreDrawn) {
  const auto bvh = std::make_shared<const SceneBvh>(bvh_of(scene_of({soup(120000, 0.004f)})));
  const NodeBoxes boxes = node_boxes(bvh, with("leaves"), {});
  ASSERT_EQ(boxes.boxes.size(), max_drawn_boxes);
  EXPECT_GT(boxes.found, max_drawn_boxes);
  EXPECT_EQ(boxes.found, leaves(bvh->blases[0]->tree));
  EXPECT_FALSE(boxes.at_least);
  std::vector<float> areas;
  for (const BvhNode& node : bvh->blases[0]->tree.nodes) {
    if (is_leaf(node)) areas.push_back(half_area(box_of(node)));
  }
  std::sort(areas.begin(), areas.end(), std::greater<>());
  EXPECT_EQ(boxes.boxes.front().area, areas.front());
  // Small leaves high up may take the place of larger ones far down, but not many.
  EXPECT_NEAR(boxes.boxes.back().area, areas[max_drawn_boxes - 1],
              0.1f * areas[max_drawn_boxes - 1]);
}

TEST(NodeBoxes, OfAMassiveSceneAreChosenInBoundedTime) {
  std::vector<Mesh> meshes = {soup(20000, 0.01f)};
  Scene scene = scene_of(std::move(meshes));
  scene.instances.resize(500, scene.instances[0]);
  for (size_t i = 0; i < scene.instances.size(); ++i)
    scene.instances[i].transform[3] = {float(i), 0, 0, 1};
  const auto bvh = std::make_shared<const SceneBvh>(bvh_of(scene));
  const Bvh& tree = bvh->blases[0]->tree;
  const NodeBoxes all = node_boxes(bvh, levels(0, 255, "scene"), {});
  EXPECT_EQ(all.boxes.size(), max_drawn_boxes);
  EXPECT_EQ(all.found, 500 * tree.nodes.size() + bvh->tlas.nodes.size());
  EXPECT_EQ(node_boxes(bvh, levels(9, 9, "blas"), {}).found, 500 * of_depth(tree, 9));
  EXPECT_EQ(node_boxes(bvh, with("leaves"), {}).found, 500 * leaves(tree));
  BoxSources hiding;
  hiding.hidden = {{0, tree.nodes[0].first}};
  EXPECT_TRUE(node_boxes(bvh, with("leaves"), hiding).at_least);
}

TEST(NodeBoxes, AreasAreThoseInTheWorld) {
  const BvhPointer bvh = two_meshes();
  BoxSources sources;
  sources.selected = NodePlace{0, 0};
  sources.instance = 2;  // stretched along x
  const Box box = box_of(bvh->blases[0]->tree.nodes[0]);
  const vec3 size = extent(box) * vec3(2, 1, 1);
  EXPECT_NEAR(node_boxes(bvh, with("node"), sources).boxes.at(0).area,
              size.x * size.y + size.y * size.z + size.z * size.x, 1e-3f);
}

TEST(NodeBoxes, ValuesAreThoseOfTheMeasure) {
  const BvhPointer bvh = two_meshes();
  const Inspection inspection = inspect(bvh, nullptr, {});
  for (const NodeMeasureRow& measure : node_measures()) {
    BoxOptions options = levels(0, 3, "blas");
    options.color = measure.id;
    const NodeBoxes boxes = node_boxes(bvh, options, {});
    for (const NodeBox& box : boxes.boxes) {
      const TreeFacts facts{inspection.blases[box.place.mesh].get(), {}, {}, {}};
      const auto value = float(measure.value(facts, box.place.node));
      if (std::isnan(value)) {
        EXPECT_TRUE(std::isnan(box.value)) << measure.id;
      } else {
        EXPECT_EQ(box.value, value) << measure.id;
        EXPECT_GE(value, boxes.range.lo) << measure.id;
        EXPECT_LE(value, boxes.range.hi) << measure.id;
      }
    }
    EXPECT_EQ(boxes.has_values, measure.source == MeasureSource::tree) << measure.id;
  }
}

TEST(NodeBoxes, SharedIsWhatTheChildrenHaveInCommon) {
  const auto bvh = std::make_shared<const SceneBvh>(bvh_of(scene_of({soup(500, 0.5f)})));
  BoxSources sources;
  sources.selected = NodePlace{0, 0};
  const Bvh& tree = bvh->blases[0]->tree;
  const NodeBoxes boxes = node_boxes(bvh, with("node"), sources);
  ASSERT_EQ(boxes.shared.size(), 1u);
  const uint32_t left = tree.nodes[0].first;
  EXPECT_EQ(boxes.shared[0].box,
            intersected(box_of(tree.nodes[left]), box_of(tree.nodes[left + 1])));
  BoxOptions without = with("node");
  without.sibling_overlap = false;
  EXPECT_TRUE(node_boxes(bvh, without, sources).shared.empty());
}

TEST(NodeBoxes, AreMadeAgainOnlyForWhatTheyDependOn) {
  const BvhPointer bvh = two_meshes();
  BoxSources sources;
  sources.visits = std::make_shared<const CountedVisits>();
  BoxOptions options = levels(1, 2, "blas");
  const NodeBoxes boxes = node_boxes(bvh, options, sources);
  EXPECT_TRUE(is_of(boxes, bvh, options, sources));
  EXPECT_TRUE(is_of(boxes, bvh, options, {})) << "depth needs no visits";
  options.translucent = true;
  options.line_width = 3.0f;
  EXPECT_TRUE(is_of(boxes, bvh, options, sources));
  sources.hidden = {{0, 1}};
  EXPECT_FALSE(is_of(boxes, bvh, options, sources));
  sources.hidden.clear();
  options.color = "visits";
  EXPECT_FALSE(is_of(boxes, bvh, options, sources));
  EXPECT_FALSE(is_of(node_boxes(bvh, options, sources), bvh, options, {}));
}

TEST(NodeBoxes, OfNoTree) {
  EXPECT_TRUE(node_boxes(nullptr, with("levels"), {}).boxes.empty());
}

}  // namespace
}  // namespace tracer::test
