// The Boxes panel, and what it asks for.
#include "ui/boxes.h"

#include <gtest/gtest.h>

#include "driver.h"
#include "tracer/render/overlay.h"

namespace {

using tracer::BoxOptions;
using ui::Driver;
using ui::NodePlace;

// What the painter does.
void paint(Driver& driver) {
  driver.picture = tracer::colorize(*driver.snapshot, driver.edited.view);
  const BoxOptions& options = driver.edited.view.boxes;
  if (!options.show) return;
  const tracer::BoxSources sources = ui::box_sources(driver.state, driver.work);
  draw_boxes(driver.picture, *driver.snapshot, node_boxes(driver.snapshot->bvh, options, sources),
             options);
}

TEST(BoxesPanel, EditsTheOptions) {
  Driver driver;
  driver.show("boxes");
  driver.click("boxes/Show boxes");
  EXPECT_TRUE(driver.edited.view.boxes.show);
  driver.choose("boxes/What", "leaves");
  driver.choose("boxes/Trees", "tlas");
  driver.choose("boxes/Colour", "sah");
  driver.click("boxes/Translucent");
  driver.click("boxes/Lines");
  driver.click("boxes/Fade hidden");
  const BoxOptions& boxes = driver.edited.view.boxes;
  EXPECT_EQ(boxes.what, "leaves");
  EXPECT_EQ(boxes.tree, "tlas");
  EXPECT_EQ(boxes.color, "sah");
  EXPECT_TRUE(boxes.translucent);
  EXPECT_FALSE(boxes.wire);
  EXPECT_FALSE(boxes.fade_hidden);
  EXPECT_FALSE(driver.is_there("boxes/Levels")) << "leaves are of all levels";
}

TEST(BoxesPanel, ASegmentChoosesALevelAndADragSeveral) {
  Driver driver;
  driver.show("boxes");
  driver.click("boxes/Levels/level 3");
  BoxOptions& boxes = driver.edited.view.boxes;
  EXPECT_EQ(boxes.first_level, 3);
  EXPECT_EQ(boxes.last_level, 3);
  driver.drag(driver.middle("boxes/Levels/level 6"), driver.middle("boxes/Levels/level 4"));
  EXPECT_EQ(boxes.first_level, 4);
  EXPECT_EQ(boxes.last_level, 6);
  driver.click("boxes/Up");
  EXPECT_EQ(boxes.first_level, 3);
  EXPECT_EQ(boxes.last_level, 5);
  driver.shift = true;
  driver.click("boxes/Levels/level 7");
  driver.shift = false;
  EXPECT_EQ(boxes.first_level, 3);
  EXPECT_EQ(boxes.last_level, 7);
  driver.click("boxes/All");
  EXPECT_EQ(boxes.first_level, 0);
  driver.click("boxes/Down");
  EXPECT_EQ(boxes.first_level, 0) << "there is nothing below";
}

TEST(BoxesPanel, SaysHowManyAreDrawn) {
  Driver driver;
  driver.show("boxes");
  driver.click("boxes/Show boxes");
  EXPECT_FALSE(driver.is_there("boxes/Drawn"));
  paint(driver);
  driver.frame(2);
  EXPECT_TRUE(driver.is_there("boxes/Drawn"));
  ASSERT_TRUE(driver.picture.boxes);
  EXPECT_GT(driver.picture.boxes->drawn, 0u);
}

TEST(BoxesPanel, AsksForTheTreesAndForWhatItsColourNeeds) {
  Driver driver;
  driver.requests = {};
  driver.edited.view.boxes.show = true;
  driver.frame();
  EXPECT_TRUE(driver.requests.inspect);
  EXPECT_FALSE(driver.requests.count_visits);
  driver.edited.view.boxes.color = "observed";
  driver.frame();
  EXPECT_TRUE(driver.requests.count_visits);
  driver.requests = {};
  driver.edited.view.boxes.show = false;
  driver.frame();
  EXPECT_FALSE(driver.requests.inspect);
}

TEST(BoxesPanel, OfTheSelectedNodeWithoutOneItSaysSo) {
  Driver driver;
  driver.show("boxes");
  driver.click("boxes/Show boxes");
  driver.choose("boxes/What", "children");
  EXPECT_FALSE(driver.is_there("boxes/Selected"));
  driver.state.selection.node = NodePlace{0, 0};
  driver.frame(2);
  EXPECT_TRUE(driver.is_there("boxes/Selected"));
  paint(driver);
  EXPECT_GE(driver.picture.boxes->drawn, 3u);
}

TEST(BoxesPanel, WhatIsLeftOutCanBeShownAgain) {
  Driver driver;
  driver.show("boxes");
  EXPECT_FALSE(driver.is_there("boxes/Show all"));
  driver.state.box_filter.hidden = {{0, 0}};
  driver.edited.view.boxes.show = true;
  driver.edited.view.boxes.tree = "blas";
  paint(driver);
  const uint64_t drawn = driver.picture.boxes->drawn;
  driver.click("boxes/Show all");
  EXPECT_TRUE(driver.state.box_filter.hidden.empty());
  paint(driver);
  EXPECT_GT(driver.picture.boxes->drawn, drawn);
}

TEST(BoxesPanel, WithoutASceneItSaysWhatToDo) {
  Driver driver("");
  driver.show("boxes");
  EXPECT_FALSE(driver.is_there("boxes/Show boxes"));
}

}  // namespace
