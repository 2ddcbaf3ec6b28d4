// The Icicle panel: choosing, zooming, hovering and selecting.
#include "ui/icicle.h"

#include <gtest/gtest.h>

#include "driver.h"

namespace {

using tracer::Icicle;
using ui::Driver;
using ui::NodePlace;

// What the background work does.
void lay_out(Driver& driver) {
  driver.requests = {};
  driver.frame();
  ASSERT_TRUE(driver.requests.inspect);
  ASSERT_TRUE(driver.requests.icicle);
  driver.work.inspection.result = std::make_shared<const tracer::Inspection>(
      tracer::inspect(driver.snapshot->bvh, driver.work.inspection.result.get(), {}));
  driver.work.icicle.result = std::make_shared<const Icicle>(
      make_icicle(tracer::icicle_sources(*driver.requests.icicle, driver.work.inspection.result,
                                         driver.work.visits.result, driver.work.measures.result),
                  {}));
  driver.frame(2);
}

void open(Driver& driver) {
  driver.show("icicle");
  lay_out(driver);
}

// In the level, at a part of the width.
ImVec2 place(Driver& driver, size_t level, float part) {
  const ui::Item item = driver.find("icicle/cells");
  const auto levels = static_cast<float>(driver.work.icicle.result->levels.size());
  const float row = std::min((item.hi.y - item.lo.y) / levels, 1.6f * ImGui::GetFontSize());
  return {item.lo.x + part * (item.hi.x - item.lo.x),
          item.lo.y + row * (static_cast<float>(level) + 0.5f)};
}

TEST(IciclePanel, HoveringLightsANodeUpAndAClickSelectsIt) {
  Driver driver;
  open(driver);
  driver.move_to(place(driver, 0, 0.5f));
  EXPECT_EQ(driver.state.hovered.node, (NodePlace{0, 0}));
  EXPECT_EQ(driver.state.was_hovered.node, (NodePlace{0, 0})) << "for the viewport";
  driver.move_to(place(driver, 1, 0.01f));
  const uint32_t left = driver.snapshot->bvh->blases[0]->tree.nodes[0].first;
  EXPECT_EQ(driver.state.hovered.node, (NodePlace{0, left}));
  EXPECT_FALSE(driver.state.selection.node);
  driver.click_at(place(driver, 1, 0.01f));
  EXPECT_EQ(driver.state.selection.node, (NodePlace{0, left}));
  driver.frame(2);
  EXPECT_TRUE(driver.is_there("icicle/selected"));
}

TEST(IciclePanel, TheWheelZoomsAboutTheCursor) {
  Driver driver;
  open(driver);
  driver.move_to(place(driver, 0, 0.25f));
  driver.wheel(3.0f);
  const ui::IcicleState& state = driver.state.icicle;
  const double length = state.to - state.from;
  EXPECT_NEAR(length, 0.512, 1e-6);
  EXPECT_NEAR(state.from + 0.25 * length, 0.25, 0.01);
  driver.wheel(-20.0f);
  EXPECT_EQ(state.from, 0.0);
  EXPECT_EQ(state.to, 1.0);
}

TEST(IciclePanel, ADragMovesWhatIsShownAndSelectsNothing) {
  Driver driver;
  open(driver);
  driver.state.icicle.from = 0.4;
  driver.state.icicle.to = 0.6;
  const ImVec2 from = place(driver, 1, 0.5f);
  driver.drag(from, {from.x + 60.0f, from.y});
  EXPECT_LT(driver.state.icicle.from, 0.4);
  EXPECT_NEAR(driver.state.icicle.to - driver.state.icicle.from, 0.2, 1e-9);
  EXPECT_FALSE(driver.state.selection.node);
}

TEST(IciclePanel, ADoubleClickFillsTheWidthAndShowAllGoesBack) {
  Driver driver;
  open(driver);
  const auto icicle = driver.work.icicle.result;
  const ImVec2 at = place(driver, 1, 0.01f);
  driver.frame(30);
  driver.click_at(at);
  driver.click_at(at);
  EXPECT_NEAR(driver.state.icicle.from, 0.0, 1e-9);
  EXPECT_NEAR(driver.state.icicle.to, icicle->levels[1].end[0] / tracer::icicle_width, 1e-9);
  driver.click("icicle/Show all");
  EXPECT_EQ(driver.state.icicle.to, 1.0);
}

TEST(IciclePanel, ChoicesAreAskedFor) {
  Driver driver;
  open(driver);
  driver.choose("icicle/Width", "visits");
  driver.choose("icicle/Colour", "observed");
  driver.choose("icicle/Rays", "shadow");
  driver.requests = {};
  driver.frame();
  EXPECT_TRUE(driver.requests.count_visits);
  ASSERT_TRUE(driver.requests.icicle);
  EXPECT_EQ(driver.requests.icicle->width, "visits");
  EXPECT_EQ(driver.requests.icicle->color, "observed");
  EXPECT_EQ(driver.requests.icicle->ray_class, int(tracer::RayClass::shadow));
  driver.click("icicle/Tree");
  driver.click("icicle/Tree/tlas");
  driver.frame();
  EXPECT_EQ(driver.requests.icicle->mesh, tracer::none) << "the TLAS comes first";
}

TEST(IciclePanel, EveryWidthAndColourCanBeShown) {
  Driver driver;
  driver.show("icicle");
  for (const tracer::IcicleWidthRow& width : tracer::icicle_widths()) {
    for (const tracer::NodeMeasureRow& color : tracer::node_measures()) {
      for (const bool logarithmic : {false, true}) {
        driver.state.icicle.width = width.id;
        driver.state.icicle.color = color.id;
        driver.state.icicle.logarithmic = logarithmic;
        lay_out(driver);
        driver.move_to(place(driver, 2, 0.3f));
        EXPECT_TRUE(driver.is_there("icicle/colours")) << color.id;
      }
    }
  }
}

TEST(IciclePanel, ANodeSelectedElsewhereBringsItsTree) {
  Driver driver;
  open(driver);
  driver.state.selection.node = NodePlace{tracer::none, 0};
  driver.frame(2);
  ASSERT_TRUE(driver.requests.icicle);
  EXPECT_EQ(driver.requests.icicle->mesh, tracer::none);
  lay_out(driver);
  EXPECT_TRUE(driver.is_there("icicle/selected"));
}

TEST(IciclePanel, OfATreeThatIsGoneNothingCanBeSelected) {
  Driver driver;
  open(driver);
  driver.edited.settings.build.builder = "median";
  driver.trace();
  driver.frame(2);
  driver.click_at(place(driver, 1, 0.01f));
  EXPECT_FALSE(driver.state.selection.node);
  lay_out(driver);
  driver.frame(30);  // so that it is not a double click
  driver.click_at(place(driver, 1, 0.01f));
  EXPECT_TRUE(driver.state.selection.node);
}

TEST(IciclePanel, TheTreemapShowsALevelAndSelects) {
  Driver driver;
  open(driver);
  driver.choose("icicle/Drawing", "treemap");
  driver.state.icicle.level = 0;
  driver.click("icicle/tiles");
  EXPECT_EQ(driver.state.selection.node, (NodePlace{0, 0}));
  driver.drag("icicle/Level", 60.0f);
  EXPECT_GT(driver.state.icicle.level, 0);
  driver.state.icicle.level = 1;
  driver.frame(30);
  const ui::Item tiles = driver.find("icicle/tiles");
  driver.click_at({tiles.lo.x + 3.0f, tiles.lo.y + 3.0f});
  const uint32_t left = driver.snapshot->bvh->blases[0]->tree.nodes[0].first;
  EXPECT_EQ(driver.state.hovered.node, (NodePlace{0, left}));
  EXPECT_EQ(driver.state.selection.node, (NodePlace{0, left}));
}

void open_treemap(Driver& driver) {
  open(driver);
  driver.choose("icicle/Drawing", "treemap");
  driver.state.icicle.level = 2;
  driver.frame(30);
}

// A part of the way through the treemap.
ImVec2 in_tiles(Driver& driver, float x, float y) {
  const ui::Item tiles = driver.find("icicle/tiles");
  return {tiles.lo.x + x * (tiles.hi.x - tiles.lo.x), tiles.lo.y + y * (tiles.hi.y - tiles.lo.y)};
}

TEST(IciclePanel, TheWheelZoomsTheTreemapAboutTheCursor) {
  Driver driver;
  open_treemap(driver);
  driver.move_to(in_tiles(driver, 0.25f, 0.5f));
  driver.wheel(3.0f);
  const tracer::TreemapView& view = driver.state.icicle.view;
  EXPECT_NEAR(view.length, 0.512, 1e-6);
  EXPECT_NEAR(view.lo.x + 0.25 * view.length, 0.25, 0.01);
  EXPECT_NEAR(view.lo.y + 0.5 * view.length, 0.5, 0.01);
  EXPECT_GT(driver.state.icicle.tiles.size(), 4u) << "deeper levels";
  driver.wheel(-20.0f);
  EXPECT_EQ(view, tracer::TreemapView{});
}

TEST(IciclePanel, ADragMovesTheTreemapAndSelectsNothing) {
  Driver driver;
  open_treemap(driver);
  driver.state.icicle.view = {{0.4, 0.4}, 0.2};
  const ImVec2 from = in_tiles(driver, 0.5f, 0.5f);
  driver.drag(from, {from.x + 60.0f, from.y});
  const tracer::TreemapView& view = driver.state.icicle.view;
  EXPECT_LT(view.lo.x, 0.4);
  EXPECT_EQ(view.lo.y, 0.4);
  EXPECT_EQ(view.length, 0.2);
  EXPECT_FALSE(driver.state.selection.node);
}

TEST(IciclePanel, ADoubleClickFillsTheTreemapAndAnotherGoesBack) {
  Driver driver;
  open_treemap(driver);
  const ImVec2 at = in_tiles(driver, 0.01f, 0.01f);
  driver.move_to(at);
  const uint32_t node = driver.state.hovered.node->node;
  driver.click_at(at);
  driver.click_at(at);
  const tracer::TreemapView& view = driver.state.icicle.view;
  EXPECT_EQ(view,
            treemap_view_of(*driver.work.icicle.result, node, driver.state.icicle.tiles_size));
  EXPECT_LT(view.length, 1.0);
  driver.click("icicle/Show all");
  EXPECT_EQ(view, tracer::TreemapView{});
  driver.state.icicle.level = 0;  // the root is all there is
  driver.frame(30);
  driver.state.icicle.view = {};
  driver.click_at(at);
  driver.click_at(at);
  EXPECT_EQ(view, tracer::TreemapView{});
}

TEST(IciclePanel, WithoutASceneItSaysWhatToDo) {
  Driver driver("");
  driver.show("icicle");
  EXPECT_FALSE(driver.is_there("icicle/Tree"));
}

}  // namespace
