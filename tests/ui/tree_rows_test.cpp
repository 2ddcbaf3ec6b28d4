// The rows of the tree list, and how long ten million of them take.
#include "ui/tree_rows.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tracer/choice.h"

namespace {

using testing::ElementsAre;
using tracer::none;
using ui::reference_bit;

// A full binary tree of this depth, with `references` in each leaf; nodes in the order of a walk
// from level to level.
tracer::TreeTable full_tree(uint32_t depth, uint32_t references) {
  tracer::TreeTable table;
  const uint32_t leaves = 1u << depth;
  table.nodes.resize(2 * leaves - 1);
  table.depth = depth;
  table.traversal_cost = table.intersection_cost = 1.0f;
  for (uint32_t i = 0; i < table.nodes.size(); ++i) {
    tracer::TableNode& node = table.nodes[i];
    node.box = {tracer::vec3(0.0f), tracer::vec3(1.0f)};
    node.parent = i == 0 ? none : (i - 1) / 2;
    node.depth = uint8_t(i == 0 ? 0 : table.nodes[node.parent].depth + 1);
    if (node.depth < depth) {
      node.children = 2;
      node.first = 2 * i;
    } else {
      node.first = (i - (leaves - 1)) * references;
      node.references = references;
    }
    node.sah = float(1 + i * 5 % 7);
  }
  for (uint32_t child = 1; child < table.nodes.size(); ++child)
    table.children.push_back(child);
  table.references.resize(size_t(leaves) * references);
  for (uint32_t i = 0; i < table.references.size(); ++i)
    table.references[i] = 100 + i;
  return table;
}

class TreeRows : public testing::Test {
 protected:
  explicit TreeRows(uint32_t depth = 2) : table(full_tree(depth, 2)) {
    facts.table = &table;
    rows = ui::tree_rows(facts, order);
  }

  tracer::TreeTable table;
  tracer::TreeFacts facts;
  ui::SiblingOrder order;
  ui::TreeRows rows;
};

TEST_F(TreeRows, BeginWithTheOpenRoot) {
  EXPECT_THAT(rows.rows, ElementsAre(0u, 1u, 2u));
}

TEST_F(TreeRows, OpenAndCloseInPlace) {
  open_row(rows, facts, order, 1);
  EXPECT_THAT(rows.rows, ElementsAre(0u, 1u, 3u, 4u, 2u));
  open_row(rows, facts, order, 3);
  EXPECT_THAT(rows.rows, ElementsAre(0u, 1u, 3u, 4u, 2u | reference_bit, 3u | reference_bit, 2u));
  EXPECT_EQ(node_of_row(rows, 5), 4u);
  close_row(rows, facts, 1);
  EXPECT_THAT(rows.rows, ElementsAre(0u, 1u, 2u));
  open_row(rows, facts, order, 1);
  EXPECT_EQ(rows.rows.size(), 7u) << "what was open below is open again";
  close_row(rows, facts, 0);
  EXPECT_THAT(rows.rows, ElementsAre(0u));
}

TEST_F(TreeRows, OpenBelowOpensLeavesOnlyIfAsked) {
  open_below(rows, facts, order, 0, false);
  EXPECT_THAT(rows.rows, ElementsAre(0u, 1u, 3u, 4u, 2u, 5u, 6u));
  open_below(rows, facts, order, 4, true);
  EXPECT_EQ(rows.rows.size(), 7u + 4u);
  close_all(rows, facts, order);
  EXPECT_THAT(rows.rows, ElementsAre(0u, 1u, 2u));
}

TEST_F(TreeRows, RevealOpensTheWayThere) {
  EXPECT_EQ(reveal_node(rows, facts, order, 5), 3u);
  EXPECT_THAT(rows.rows, ElementsAre(0u, 1u, 2u, 5u, 6u));
  EXPECT_EQ(reveal_node(rows, facts, order, 5), 3u);
  EXPECT_EQ(reveal_reference(rows, facts, order, 6, 100 + 7), 4u + 2u);
  EXPECT_EQ(rows.rows[6], 7u | reference_bit);
  EXPECT_EQ(reveal_reference(rows, facts, order, 6, 999), 4u) << "the leaf itself";
  close_row(rows, facts, 0);
  EXPECT_EQ(rows.rows[reveal_node(rows, facts, order, 3)], 3u);
}

TEST_F(TreeRows, AreSortedAmongSiblings) {
  open_below(rows, facts, order, 0, false);
  order.measure = tracer::find_row(tracer::node_measures(), "sah");  // 1 + 5 id % 7
  sort_rows(rows, facts, order);
  EXPECT_THAT(rows.rows, ElementsAre(0u, 1u, 4u, 3u, 2u, 5u, 6u));
  order.descending = false;
  sort_rows(rows, facts, order);
  EXPECT_THAT(rows.rows, ElementsAre(0u, 2u, 6u, 5u, 1u, 3u, 4u));
  order.measure = tracer::find_row(tracer::node_measures(), "visits");  // not known
  sort_rows(rows, facts, order);
  EXPECT_THAT(rows.rows, ElementsAre(0u, 1u, 3u, 4u, 2u, 5u, 6u));
}

TEST_F(TreeRows, TakeAnyNumberOfChildren) {
  tracer::TreeTable wide;
  wide.nodes.resize(5);
  wide.nodes[0].children = 4;
  wide.children = {1, 2, 3, 4};
  for (uint32_t i = 1; i < 5; ++i) {
    wide.nodes[i].depth = 1;
    wide.nodes[i].parent = 0;
  }
  facts.table = &wide;
  EXPECT_THAT(tree_rows(facts, order).rows, ElementsAre(0u, 1u, 2u, 3u, 4u));
}

TEST(TreeRowsOfNothing, AreNone) {
  const tracer::TreeTable table;
  EXPECT_TRUE(ui::tree_rows({&table, {}, {}, {}}, {}).rows.empty());
}

}  // namespace
