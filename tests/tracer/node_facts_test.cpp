#include "tracer/analyze/node_facts.h"

#include <gtest/gtest.h>

#include "make_scene.h"

namespace tracer::test {
namespace {

TEST(NodeFacts, OfTheRoot) {
  const auto facts = node_facts(three_leaves(), 0);
  ASSERT_TRUE(facts);
  EXPECT_EQ(facts->parent, none);
  EXPECT_EQ(facts->depth, 0u);
  EXPECT_EQ(facts->references, 6u);
  EXPECT_EQ(facts->area_share, 1.0);
  EXPECT_FALSE(facts->leaf);
}

TEST(NodeFacts, OfANodeBelow) {
  const auto middle = node_facts(three_leaves(), 2);
  EXPECT_EQ(middle->parent, 0u);
  EXPECT_EQ(middle->references, 5u);
  EXPECT_NEAR(middle->area_share, 7.0 / 9.0, 1e-12);
  const auto last = node_facts(three_leaves(), 4);
  EXPECT_TRUE(last->leaf);
  EXPECT_EQ(last->parent, 2u);
  EXPECT_EQ(last->depth, 2u);
  EXPECT_EQ(last->references, 3u);
  EXPECT_EQ(last->box.lo.z, 2.0f);
}

TEST(NodeFacts, NothingForANodeThatIsNotThere) {
  EXPECT_FALSE(node_facts(three_leaves(), 5));
  EXPECT_FALSE(node_facts({}, 0));
}

TEST(NodeFacts, EndInATreeWithACycle) {
  Bvh tree = three_leaves();
  tree.nodes[2].first = 1;  // itself and its sibling
  EXPECT_TRUE(node_facts(tree, 2));
  tree.nodes[2].first = 0xfffffffe;
  EXPECT_TRUE(node_facts(tree, 0));
}

}  // namespace
}  // namespace tracer::test
