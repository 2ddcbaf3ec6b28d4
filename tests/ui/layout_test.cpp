// Where the panels are, and how that is remembered.
#include "ui/layout.h"

#include <gtest/gtest.h>

#include "driver.h"
#include "ui/panels.h"

namespace {

using ui::Region;

TEST(Layout, TheDefaultShowsEveryPanelOnce) {
  const ui::Layout layout = ui::default_layout();
  EXPECT_EQ(layout.panels.size(), ui::panels().size());
  for (const ui::PanelRow& row : ui::panels())
    EXPECT_TRUE(ui::is_shown(layout, row.id)) << row.id;
}

TEST(Layout, EveryRegionHasAPanelInFront) {
  for (const std::string& front : ui::default_layout().front)
    EXPECT_FALSE(front.empty());
}

TEST(Layout, AHiddenPanelLeavesTheFrontToAnother) {
  ui::Layout layout = ui::default_layout();
  ui::hide_panel(layout, "statistics");
  EXPECT_FALSE(ui::is_shown(layout, "statistics"));
  EXPECT_EQ(layout.front[static_cast<int>(Region::bottom)], "builders");
}

TEST(Layout, AMovedPanelIsLastInItsRegionAndInFront) {
  ui::Layout layout = ui::default_layout();
  ui::move_panel(layout, "scene", Region::right);
  EXPECT_EQ(layout.panels.back().panel, "scene");
  EXPECT_EQ(layout.front[static_cast<int>(Region::right)], "scene");
  EXPECT_EQ(layout.front[static_cast<int>(Region::left)], "materials");
}

TEST(Layout, AnUnknownPanelIsIgnored) {
  ui::Layout layout = ui::default_layout();
  ui::move_panel(layout, "nonsense", Region::right);
  ui::hide_panel(layout, "nonsense");
  EXPECT_EQ(layout, ui::default_layout());
}

ui::UiState rearranged() {
  ui::UiState state;
  state.layout.left = 345.0f;
  state.layout.bottom = 111.0f;
  ui::move_panel(state.layout, "lights", Region::bottom);
  ui::hide_panel(state.layout, "camera");
  state.user_scale = 1.5f;
  state.picture_size = ui::PictureSize::half_panel;
  state.fly_speed = 3.0f;
  state.show_gizmo = false;
  state.recent_files = {"/a/b.obj", "/c/\xc3\xa4.obj"};
  return state;
}

TEST(LayoutJson, ComesBackAsItWas) {
  const ui::UiState state = rearranged();
  ui::UiState read;
  ui::layout_from_json(read, ui::layout_to_json(state));
  EXPECT_EQ(ui::layout_to_json(read), ui::layout_to_json(state));
  EXPECT_EQ(read.layout.left, 345.0f);
  EXPECT_FALSE(ui::is_shown(read.layout, "camera"));
  EXPECT_EQ(ui::find_place(read.layout, "lights")->region, Region::bottom);
  EXPECT_EQ(read.user_scale, 1.5f);
  EXPECT_EQ(read.picture_size, ui::PictureSize::half_panel);
  EXPECT_FALSE(read.show_gizmo);
  EXPECT_EQ(read.recent_files, state.recent_files);
}

class LayoutGarbage : public testing::TestWithParam<const char*> {};

TEST_P(LayoutGarbage, ChangesNothing) {
  ui::UiState state = rearranged();
  const std::string before = ui::layout_to_json(state);
  ui::layout_from_json(state, GetParam());
  EXPECT_EQ(ui::layout_to_json(state), before);
}

INSTANTIATE_TEST_SUITE_P(
    All, LayoutGarbage,
    testing::Values("", "{", "null", "[]", "42", "\xff\xfe\x00", R"({"left":"wide"})",
                    R"({"panels":17,"front":[],"recent_files":"x"})",
                    R"({"panels":[1,{"panel":"nonsense","region":"left"},{"panel":"scene"}]})",
                    R"({"panels":[{"panel":"scene","region":"nowhere","shown":3}]})",
                    R"({"front":{"left":"nonsense"},"scale":[],"picture_size":"big"})"));

TEST(LayoutJson, NumbersOutOfRangeAreBroughtIntoIt) {
  ui::UiState state;
  ui::layout_from_json(state, R"({"left":-1e30,"bottom":1e30,"scale":99,"picture_size":77})");
  EXPECT_EQ(state.layout.left, 120.0f);
  EXPECT_EQ(state.layout.bottom, 4000.0f);
  EXPECT_EQ(state.user_scale, 4.0f);
  EXPECT_EQ(state.picture_size, ui::PictureSize::fixed);
}

TEST(LayoutJson, AFileOfAnOlderVersionKeepsNewPanels) {
  ui::UiState state;
  ui::layout_from_json(state, R"({"panels":[{"panel":"view","region":"left","shown":true}]})");
  EXPECT_EQ(ui::find_place(state.layout, "view")->region, Region::left);
  EXPECT_EQ(state.layout.panels.size(), ui::panels().size());
}

TEST(Workspace, DraggingABorderResizesItsRegion) {
  ui::Driver driver("");
  driver.drag("splitter/left", 60.0f);
  EXPECT_EQ(driver.state.layout.left, ui::default_layout().left + 60.0f);
  driver.drag("splitter/right", -40.0f);
  EXPECT_EQ(driver.state.layout.right, 380.0f);
  driver.drag("splitter/bottom", 0.0f, -50.0f);
  EXPECT_EQ(driver.state.layout.bottom, 280.0f);
}

TEST(Workspace, ADoubleClickOnABorderGivesItsDefaultSize) {
  ui::Driver driver("");
  driver.drag("splitter/left", 60.0f);
  driver.double_click("splitter/left");
  EXPECT_EQ(driver.state.layout.left, ui::default_layout().left);
}

TEST(Workspace, ABorderLeavesRoomForTheCentre) {
  ui::Driver driver("");
  driver.drag("splitter/left", 1000.0f);
  const ui::Item picture = driver.find("viewport/picture");
  EXPECT_GT(picture.hi.x - picture.lo.x, 100.0f);
}

TEST(Workspace, AClickOnATabBringsItToTheFront) {
  ui::Driver driver("");
  driver.click("camera/tab");
  EXPECT_EQ(driver.state.layout.front[static_cast<int>(Region::right)], "camera");
}

TEST(Workspace, APanelMovesByTheMenuOfItsTab) {
  ui::Driver driver("");
  driver.click("scene/tab", 1);
  driver.click("scene/Move to the right");
  EXPECT_EQ(ui::find_place(driver.state.layout, "scene")->region, Region::right);
  EXPECT_GT(driver.find("scene/tab").lo.x, 900.0f);
  EXPECT_EQ(driver.state.layout.front[static_cast<int>(Region::right)], "scene");
}

TEST(Workspace, APanelHidesByTheMenuOfItsTabAndComesBackByTheViewMenu) {
  ui::Driver driver("");
  driver.click("messages/tab", 1);
  driver.click("messages/Hide");
  driver.frame(3);
  EXPECT_FALSE(driver.is_there("messages/tab"));
  driver.menu({"View", "Messages"});
  driver.frame(3);
  EXPECT_TRUE(driver.is_there("messages/tab"));
  driver.menu({"View", "Messages"});
  EXPECT_FALSE(ui::is_shown(driver.state.layout, "messages"));
}

TEST(Workspace, ARegionWithoutPanelsGivesItsRoomAway) {
  ui::Driver driver("");
  const float before = driver.find("viewport/picture").hi.y;
  for (const ui::PanelRow& row : ui::panels()) {
    if (row.region == ui::Region::bottom) ui::hide_panel(driver.state.layout, row.id);
  }
  driver.frame(3);
  EXPECT_GT(driver.find("viewport/picture").hi.y, before + 150.0f);
  EXPECT_FALSE(driver.is_there("splitter/bottom"));
}

TEST(Workspace, EveryPanelHiddenIsStillAWorkspace) {
  ui::Driver driver("");
  for (const ui::PanelRow& row : ui::panels())
    ui::hide_panel(driver.state.layout, row.id);
  driver.frame(5);
  driver.menu({"View", "Reset layout"});
  driver.frame(3);
  EXPECT_TRUE(driver.is_there("viewport/picture"));
}

TEST(Workspace, ResetBringsEverythingBack) {
  ui::Driver driver("");
  driver.drag("splitter/left", 60.0f);
  ui::move_panel(driver.state.layout, "viewport", Region::left);
  driver.frame(3);
  driver.press('0', true);
  driver.frame(3);
  driver.state.layout.raise = ui::default_layout().raise;  // done by now
  EXPECT_EQ(driver.state.layout, ui::default_layout());
}

TEST(Workspace, EveryPanelWorksInEveryRegion) {
  ui::Driver driver;
  for (const ui::PanelRow& row : ui::panels()) {
    for (int i = 0; i < ui::region_count; ++i) {
      ui::move_panel(driver.state.layout, row.id, static_cast<Region>(i));
      driver.frame(3);
      EXPECT_TRUE(driver.is_there(std::string(row.id) + "/tab")) << row.id;
    }
  }
}

TEST(Workspace, ATinyWindowDoesNotBreakIt) {
  ui::Driver driver("showcase", {90.0f, 60.0f});
  driver.frame(10);
  SUCCEED();
}

}  // namespace
