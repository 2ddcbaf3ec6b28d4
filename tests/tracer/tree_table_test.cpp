// Trees as tables, and what they say of their nodes.
#include "tracer/analyze/tree_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/analyze/node_measures.h"
#include "tracer/analyze/quality.h"
#include "tracer/choice.h"

namespace tracer::test {
namespace {

using testing::ElementsAre;

TreeTable table_by_hand() {
  return tree_table(three_leaves(), false, 2.0f, 5.0f);
}

double value(const TreeFacts& facts, std::string_view id, uint32_t node) {
  return find_row(node_measures(), id)->value(facts, node);
}

TEST(TreeTable, LinksCountsAndPlaces) {
  const TreeTable table = table_by_hand();
  ASSERT_EQ(table.nodes.size(), 5u);
  EXPECT_EQ(table.nodes[0].parent, none);
  EXPECT_EQ(table.nodes[4].parent, 2u);
  EXPECT_EQ(table.nodes[4].depth, 2);
  EXPECT_EQ(table.nodes[0].references, 6u);
  EXPECT_EQ(table.nodes[2].references, 5u);
  EXPECT_EQ(table.nodes[3].order, 1u);
  EXPECT_EQ(table.nodes[4].order, 3u);
  EXPECT_TRUE(is_leaf(table.nodes[1]));
  EXPECT_EQ(table.nodes[0].children, 2);
  EXPECT_THAT(path_to(table, 4), ElementsAre(0u, 2u, 4u));
  EXPECT_THAT(leaves_of(table, 2), ElementsAre(3u));
  EXPECT_THAT(leaves_of(table, 9), ElementsAre());
}

TEST(TreeTable, SahByHand) {
  const TreeTable table = table_by_hand();
  EXPECT_NEAR(area_share(table, 2), 7.0 / 9.0, 1e-12);
  EXPECT_NEAR(own_sah(table, 2), 2.0 * 7.0 / 9.0, 1e-6);
  EXPECT_NEAR(own_sah(table, 4), 5.0 * 3.0 * 5.0 / 9.0, 1e-6);
  EXPECT_NEAR(table.nodes[2].sah, (2.0 * 7.0 + 5.0 * (2.0 * 3.0 + 3.0 * 5.0)) / 9.0, 1e-5);
}

TEST(TreeTable, RootsSahIsThatOfTheStatistics) {
  BuildOptions options;
  for (const char* builder : {"binned", "sbvh", "lbvh"}) {
    options.builder = builder;
    const SceneBvh bvh = bvh_of(scene_of({soup(3000, 0.2f)}), options);
    const TreeTable table = tree_table(bvh.blases[0]->tree, false, 1.2f, 1.0f);
    EXPECT_NEAR(table.nodes[0].sah, statistics(bvh.blases[0]->tree, 1.2f, 1.0f).sah, 1e-2);
    EXPECT_EQ(table.nodes[0].references, bvh.blases[0]->tree.references.size());
    EXPECT_EQ(table.depth, bvh.blases[0]->tree.depth);
  }
}

TEST(TreeTable, KnowsWhatItsReferencesAre) {
  EXPECT_TRUE(tree_table(three_leaves(), true, 2.0f, 5.0f).tlas);
  EXPECT_FALSE(table_by_hand().tlas);
}

TEST(TreeTable, OfAPointEachNodeIsAlwaysMet) {
  Bvh tree;
  tree.nodes.resize(3);
  tree.nodes[0] = inner(vec3(1.0f), vec3(1.0f), 1);
  tree.nodes[1] = leaf(vec3(1.0f), vec3(1.0f), 0, 1);
  tree.nodes[2] = leaf(vec3(1.0f), vec3(1.0f), 1, 1);
  tree.references = {0, 1};
  tree.depth = 1;
  EXPECT_EQ(area_share(tree_table(tree, false, 1.0f, 1.0f), 1), 1.0);
}

TEST(TreeTable, OfNothingIsEmpty) {
  EXPECT_TRUE(tree_table({}, true, 1.0f, 1.0f).nodes.empty());
}

TEST(NodeMeasures, ByHand) {
  const TreeTable table = table_by_hand();
  const std::vector<uint32_t> visits = {90, 30, 35, 0, 50};
  const std::vector<float> growth = {1.0f, 1.0f, 2.0f, 1.0f, 0.5f};
  const TreeFacts facts{&table, visits, {}, growth};
  EXPECT_EQ(value(facts, "visits", 1), 30.0);
  EXPECT_NEAR(value(facts, "observed", 1), 0.0, 1e-9) << "30 = 90 * 3 / 9";
  EXPECT_NEAR(value(facts, "observed", 2), -1.0, 1e-9) << "70 were predicted";
  EXPECT_NEAR(value(facts, "observed", 3), std::log2(0.5 / 30.0), 1e-9);
  EXPECT_NEAR(value(facts, "growth", 2), 1.0, 1e-6);
  EXPECT_NEAR(value(facts, "growth", 4), -1.0, 1e-6);
  EXPECT_NEAR(value(facts, "area", 2), 700.0 / 9.0, 1e-4);
  EXPECT_EQ(value(facts, "sah", 0), 100.0);
  EXPECT_EQ(value(facts, "kind", 1), 1.0);
  EXPECT_NEAR(value(facts, "empty_space", 0), 0.0, 1e-6) << "the children fill the root";
  EXPECT_EQ(value(facts, "overlap", 0), 0.0) << "they only touch";
  EXPECT_TRUE(std::isnan(value(facts, "overlap", 1))) << "a leaf has no children";
}

TEST(NodeMeasures, SharesAddUp) {
  const SceneBvh bvh = bvh_of(scene_of({sphere(30)}));
  const TreeTable table = tree_table(bvh.blases[0]->tree, false, 1.2f, 1.0f);
  const TreeFacts facts{&table, {}, {}, {}};
  double sum = 0.0;
  for (uint32_t node = 0; node < table.nodes.size(); ++node)
    sum += value(facts, "sah_self", node);
  EXPECT_NEAR(sum, 100.0, 0.01);
}

TEST(NodeMeasures, WhatIsNotMeasuredIsNotKnown) {
  const TreeTable table = table_by_hand();
  const TreeFacts facts{&table, {}, {}, {}};
  for (const NodeMeasureRow& row : node_measures()) {
    EXPECT_EQ(is_known(facts, row), row.source == MeasureSource::tree) << row.id;
  }
}

}  // namespace
}  // namespace tracer::test
