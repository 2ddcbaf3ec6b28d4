// The Findings panel.
#include <gtest/gtest.h>

#include "driver.h"
#include "tracer/bvh/wide_slot.h"
#include "ui/pick.h"

namespace {

using ui::Checked;
using ui::Driver;
using ui::NodePlace;

// Shows the snapshot with one leaf of mesh 0 pulled out of its parent, and what the check says.
void show_broken(Driver& driver) {
  auto bvh = std::make_shared<tracer::SceneBvh>(*driver.snapshot->bvh);
  auto blas = std::make_shared<tracer::Blas>(*bvh->blases[0]);
  uint32_t leaf = 0;
  while (!tracer::is_leaf(blas->tree.nodes[leaf]))
    ++leaf;
  blas->tree.nodes[leaf].hi.y += 2.0f;
  bvh->blases[0] = blas;
  auto broken = std::make_shared<tracer::Snapshot>(*driver.snapshot);
  broken->bvh = bvh;
  driver.snapshot = broken;
  driver.work.checks.result = std::make_shared<const Checked>(
      Checked{bvh, tracer::validate(*broken->scene, *bvh, 100, {})});
  driver.show("findings");
}

const tracer::Finding& finding(const Driver& driver, size_t index) {
  return driver.work.checks.result->validation.findings[index];
}

TEST(FindingsPanel, AsksForACheckAndCancelsIt) {
  Driver driver;
  driver.show("findings");
  driver.click("findings/Check the trees");
  EXPECT_TRUE(driver.requests.check_trees);
  driver.work.checks.running = true;
  driver.frame(2);
  driver.click("findings/Cancel");
  EXPECT_TRUE(driver.requests.cancel_check);
}

TEST(FindingsPanel, ASoundTreeHasASummaryAndNoRows) {
  Driver driver;
  driver.work.checks.result = std::make_shared<const Checked>(
      Checked{driver.snapshot->bvh,
              tracer::validate(*driver.snapshot->scene, *driver.snapshot->bvh, 100, {})});
  driver.show("findings");
  EXPECT_TRUE(driver.is_there("findings/summary"));
  EXPECT_FALSE(driver.is_there("findings/finding 1/row"));
}

TEST(FindingsPanel, AClickSelectsTheNodeAndShowsItsFacts) {
  Driver driver;
  show_broken(driver);
  ASSERT_NE(finding(driver, 0).node, tracer::none);
  driver.click("findings/finding 1/row");
  const NodePlace place{finding(driver, 0).bvh, finding(driver, 0).node};
  EXPECT_EQ(driver.state.selection.node, place);
  EXPECT_TRUE(driver.is_there("findings/Area share"));
  ASSERT_TRUE(driver.state.findings.facts);
  EXPECT_GT(driver.state.findings.facts->depth, 0u);
  EXPECT_FALSE(ui::node_corners(*driver.snapshot, place, tracer::none).empty());
}

TEST(FindingsPanel, AFilterAndASeverityLeaveRowsOut) {
  Driver driver;
  show_broken(driver);
  ASSERT_TRUE(driver.is_there("findings/finding 1/row"));
  driver.choose("findings/Show", "warning");
  driver.frame(2);
  EXPECT_EQ(driver.is_there("findings/finding 1/row"),
            finding(driver, 0).severity == tracer::Severity::warning);
  driver.choose("findings/Show", "all");
  driver.click("findings/Filter");
  driver.type("no such text");
  driver.frame(2);
  EXPECT_FALSE(driver.is_there("findings/finding 1/row"));
}

TEST(FindingsPanel, AfterAnotherBuildItIsStaleAndNothingIsSelected) {
  Driver driver;
  show_broken(driver);
  driver.click("findings/finding 1/row");
  ASSERT_TRUE(driver.state.selection.node);
  driver.edited.settings.build.builder = "median";
  driver.trace();
  driver.frame(3);
  EXPECT_FALSE(driver.state.selection.node);
  EXPECT_TRUE(driver.is_there("findings/stale"));
  driver.click("findings/finding 1/row");
  EXPECT_FALSE(driver.state.selection.node);
}

TEST(NodeCorners, AreTheBoxThroughEachInstance) {
  Driver driver("teapots:detail=2");
  const tracer::Snapshot& snapshot = *driver.snapshot;
  EXPECT_EQ(ui::node_corners(snapshot, {0, 0}, tracer::none).size(),
            snapshot.bvh->instances.size());
  const auto one = ui::node_corners(snapshot, {0, 0}, 3);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0], *ui::instance_corners(snapshot, 3));
  const auto top = ui::node_corners(snapshot, {tracer::none, 0}, tracer::none);
  ASSERT_EQ(top.size(), 1u);
  EXPECT_EQ(top[0][7], snapshot.bvh->tlas.nodes[0].hi);
  EXPECT_TRUE(ui::node_corners(snapshot, {0, 1u << 30}, tracer::none).empty());
  EXPECT_TRUE(ui::node_corners(snapshot, {77, 0}, tracer::none).empty());
}

TEST(NodeCorners, AreThoseThatRaysAreTestedAgainst) {
  Driver driver("teapots:detail=4");
  driver.edited.settings.build.layout = "quantised8";
  driver.trace();
  const tracer::SceneBvh& bvh = *driver.snapshot->bvh;
  size_t larger = 0;
  for (const tracer::WideSlot& slot : slots(bvh.blases[0]->wide)) {
    EXPECT_EQ(ui::node_box(bvh, {0, slot.node}), slot.box);
    const auto corners = ui::node_corners(*driver.snapshot, {0, slot.node}, 3);
    ASSERT_EQ(corners.size(), 1u);
    EXPECT_EQ(corners[0], ui::box_corners(slot.box, bvh.instances[3].to_world));
    larger += slot.box == box_of(bvh.blases[0]->tree.nodes[slot.node]) ? 0 : 1;
  }
  EXPECT_GT(larger, 100u);
}

}  // namespace
