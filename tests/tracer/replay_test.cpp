// Builds step by step.
#include "tracer/analyze/replay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "make_scene.h"

namespace tracer::test {
namespace {

using testing::ElementsAre;
using testing::UnorderedElementsAre;

std::shared_ptr<const TreeTable> table_of(const Bvh& tree) {
  return std::make_shared<const TreeTable>(tree_table(tree, false, 2.0f, 5.0f));
}

TEST(Replay, SplitsFromTheRootDown) {
  const Replay steps = replay(table_of(three_leaves()), false);
  EXPECT_THAT(steps.order, ElementsAre(0u, 2u));
  EXPECT_THAT(boxes_after(steps, 0, 100), ElementsAre(0u));
  EXPECT_THAT(boxes_after(steps, 1, 100), UnorderedElementsAre(1u, 2u));
  EXPECT_THAT(boxes_after(steps, 2, 100), UnorderedElementsAre(1u, 3u, 4u));
}

TEST(Replay, MergesFromTheLeavesUp) {
  const Replay steps = replay(table_of(three_leaves()), true);
  EXPECT_THAT(steps.order, ElementsAre(2u, 0u));
  EXPECT_THAT(boxes_after(steps, 0, 100), UnorderedElementsAre(1u, 3u, 4u));
  EXPECT_THAT(boxes_after(steps, 1, 100), UnorderedElementsAre(1u, 2u));
  EXPECT_THAT(boxes_after(steps, 2, 100), ElementsAre(0u));
}

TEST(Replay, CostByHand) {
  const Replay steps = replay(table_of(three_leaves()), false);
  EXPECT_NEAR(steps.sah[0], 6 * 5.0, 1e-4);
  // Half areas 9; 3 with 1 reference, 7 with 5.
  EXPECT_NEAR(steps.sah[1], 2.0 + (3.0 * 1 * 5 + 7.0 * 5 * 5) / 9.0, 1e-4);
  EXPECT_NEAR(gain_of(steps, 0), 30.0 - steps.sah[1], 1e-4);
}

TEST(Replay, EndsWithTheTree) {
  const SceneBvh bvh = bvh_of(scene_of({soup(3000, 0.1f)}));
  const auto table = table_of(bvh.blases[0]->tree);
  for (const bool bottom_up : {false, true}) {
    const Replay steps = replay(table, bottom_up);
    ASSERT_EQ(steps.sah.size(), steps.order.size() + 1);
    EXPECT_NEAR(steps.sah.back(), table->nodes[0].sah, 1e-3 * table->nodes[0].sah);
    EXPECT_EQ(2 * steps.order.size() + 1, table->nodes.size());
    // Whatever the step, the boxes hold every reference once.
    for (const size_t step : {size_t{0}, steps.order.size() / 3, steps.order.size()}) {
      uint64_t references = 0;
      for (const uint32_t node : boxes_after(steps, step, table->nodes.size()))
        references += table->nodes[node].references;
      EXPECT_EQ(references, table->references.size());
      EXPECT_EQ(boxes_after(steps, step, table->nodes.size()).size(), steps.boxes[step]);
    }
  }
}

TEST(Replay, ChildrenComeBeforeTheirParentBottomUp) {
  const SceneBvh bvh = bvh_of(scene_of({sphere(20)}));
  const Replay steps = replay(table_of(bvh.blases[0]->tree), true);
  for (uint32_t node = 1; node < steps.table->nodes.size(); ++node) {
    if (is_leaf(steps.table->nodes[node])) continue;
    EXPECT_LT(steps.step_of[node], steps.step_of[steps.table->nodes[node].parent]);
  }
}

TEST(Replay, ShowsTheLargestBoxesIfThereAreTooMany) {
  const SceneBvh bvh = bvh_of(scene_of({sphere(20)}));
  const Replay steps = replay(table_of(bvh.blases[0]->tree), false);
  const auto all = boxes_after(steps, steps.order.size(), 1 << 20);
  const auto some = boxes_after(steps, steps.order.size(), 10);
  ASSERT_EQ(some.size(), 10u);
  EXPECT_TRUE(std::equal(some.begin(), some.end(), all.begin()));
}

TEST(Replay, OfNothingAndOfOneLeaf) {
  EXPECT_TRUE(replay(table_of({}), false).order.empty());
  const SceneBvh bvh = bvh_of(scene_of({soup(1, 1.0f)}));
  for (const bool bottom_up : {false, true}) {
    const Replay steps = replay(table_of(bvh.blases[0]->tree), bottom_up);
    EXPECT_TRUE(steps.order.empty());
    EXPECT_EQ(steps.sah.size(), 1u);
  }
}

}  // namespace
}  // namespace tracer::test
