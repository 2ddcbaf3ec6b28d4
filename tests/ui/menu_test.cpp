// Menus and keys.
#include <gtest/gtest.h>

#include "driver.h"
#include "tracer/render/views.h"
#include "ui/keys.h"

namespace {

using ui::Driver;

TEST(Menu, ABuiltInSceneIsOpened) {
  Driver driver;
  driver.menu({"File", "Built-in scenes", "Needles"});
  EXPECT_EQ(driver.requests.open, "needles");
}

TEST(Menu, ARecentFileIsOpened) {
  Driver driver;
  driver.state.recent_files = {"cow.obj"};
  driver.menu({"File", "Recent files", "cow.obj"});
  EXPECT_EQ(driver.requests.open, "cow.obj");
}

TEST(Menu, Quit) {
  Driver driver;
  driver.menu({"File", "Quit"});
  EXPECT_TRUE(driver.requests.quit);
}

TEST(Menu, Screenshot) {
  Driver driver;
  driver.menu({"File", "Save screenshot"});
  EXPECT_TRUE(driver.requests.screenshot);
}

TEST(Menu, TheScaleIsChosen) {
  Driver driver;
  driver.menu({"View", "Scale", "150 %"});
  EXPECT_EQ(driver.state.user_scale, 1.5f);
}

TEST(Menu, OverlaysAreSwitched) {
  Driver driver;
  driver.menu({"View", "Axes"});
  EXPECT_FALSE(driver.state.show_gizmo);
  driver.menu({"View", "Light handles"});
  EXPECT_FALSE(driver.state.show_lights);
  driver.menu({"View", "Values under the cursor"});
  EXPECT_FALSE(driver.state.show_values);
}

TEST(Menu, HelpExplains) {
  Driver driver;
  driver.menu({"Help", "About the numbers"});
  EXPECT_TRUE(driver.state.show_about);
  driver.frame(3);
  driver.click("Close");
  EXPECT_FALSE(driver.state.show_about);
  driver.menu({"Help", "Keys and mouse"});
  EXPECT_TRUE(driver.state.show_keys);
}

TEST(Keys, DigitsChooseTheFirstNineViews) {
  Driver driver;
  for (int digit = 1; digit <= 9; ++digit) {
    driver.press('0' + digit);
    EXPECT_EQ(driver.edited.view.view, tracer::views()[digit - 1].id);
  }
}

TEST(Keys, WireframeAndBack) {
  Driver driver;
  driver.edited.view.view = "normal";
  driver.press('M');
  EXPECT_EQ(driver.edited.view.view, "wireframe");
  driver.press('M');
  EXPECT_EQ(driver.edited.view.view, "normal");
}

TEST(Keys, FitHoldsTheRangeOfThePicture) {
  Driver driver;
  driver.edited.view.view = "counter";
  driver.trace();
  driver.press('C');
  ASSERT_TRUE(driver.edited.view.range.has_value());
  EXPECT_EQ(*driver.edited.view.range, driver.picture.histogram.range);
}

TEST(Keys, FitDoesNothingWithoutValues) {
  Driver driver;
  driver.press('C');
  EXPECT_FALSE(driver.edited.view.range.has_value());
}

TEST(Keys, SpacePlaysAndPauses) {
  Driver driver;
  driver.press(ui::key_space);
  EXPECT_TRUE(driver.state.playing);
  driver.press(ui::key_space);
  EXPECT_FALSE(driver.state.playing);
}

TEST(Keys, EscapeClearsTheSelection) {
  Driver driver;
  driver.state.selection.instance = 1;
  driver.press(ui::key_escape);
  EXPECT_EQ(driver.state.selection, ui::Selection());
}

TEST(Keys, DeleteRemovesTheSelectedLightOnly) {
  Driver driver;
  const size_t before = driver.edited.settings.look->lights.size();
  driver.press(ui::key_delete);
  EXPECT_EQ(driver.edited.settings.look->lights.size(), before);
  driver.state.selection.light = 0;
  driver.press(ui::key_delete);
  EXPECT_EQ(driver.edited.settings.look->lights.size(), before - 1);
}

TEST(Keys, CameraKeys) {
  Driver driver;
  driver.press('O');
  EXPECT_TRUE(driver.edited.settings.look->camera.orthographic);
  driver.edited.settings.look->camera.eye.x += 2.0f;
  driver.press('R');
  EXPECT_EQ(driver.edited.settings.look->camera, driver.snapshot->scene->camera);
}

TEST(Keys, FocusLooksAtTheSelectedInstance) {
  Driver driver("teapots:detail=2");
  driver.state.selection.instance = 0;
  const tracer::vec3 before = driver.edited.settings.look->camera.target;
  driver.press('F');
  const tracer::vec3 first = driver.edited.settings.look->camera.target;
  EXPECT_NE(first, before);
  driver.state.selection.instance = 15;
  driver.press('F');
  EXPECT_NE(driver.edited.settings.look->camera.target, first);
}

TEST(Keys, FileKeys) {
  Driver driver;
  driver.press(ui::key_f12);
  EXPECT_TRUE(driver.requests.screenshot);
  driver.press('Q', true);
  EXPECT_TRUE(driver.requests.quit);
  driver.press('E', true);
  EXPECT_EQ(driver.state.browser.purpose, ui::FilePurpose::save_picture);
  EXPECT_TRUE(driver.state.browser.visible);
  driver.press(ui::key_escape);
  driver.press('L', true);
  EXPECT_EQ(driver.state.browser.purpose, ui::FilePurpose::open_session);
}

TEST(Keys, F1ShowsTheListAndEscapeClosesIt) {
  Driver driver;
  driver.press(ui::key_f1);
  EXPECT_TRUE(driver.state.show_keys);
  driver.press(ui::key_escape);
  EXPECT_FALSE(driver.state.show_keys);
  ImGui::GetIO().AddInputCharacter('?');
  driver.frame(2);
  EXPECT_TRUE(driver.state.show_keys);
  driver.click("keys/Close");
  EXPECT_FALSE(driver.state.show_keys);
}

TEST(Keys, AreTextWhileTextIsTyped) {
  Driver driver;
  driver.show("materials");
  driver.click("materials/Filter");
  driver.press('M');
  driver.type("m");
  EXPECT_EQ(driver.edited.view.view, "shaded");
  EXPECT_EQ(driver.state.material_filter, "m");
}

TEST(Keys, NoTwoRowsShareAKey) {
  const auto rows = ui::key_rows();
  for (size_t i = 0; i < rows.size(); ++i) {
    for (size_t j = i + 1; j < rows.size(); ++j) {
      if (rows[i].act == nullptr || rows[j].act == nullptr) continue;
      const bool same = rows[i].key == rows[j].key && rows[i].control == rows[j].control &&
                        rows[i].shift == rows[j].shift;
      EXPECT_FALSE(same) << rows[i].keys << " and " << rows[j].keys;
    }
  }
}

TEST(Keys, NoPlainKeyIsAFlyKey) {
  for (const ui::KeyRow& row : ui::key_rows()) {
    if (row.act == nullptr || row.control) continue;
    EXPECT_EQ(std::string("WASDEQ").find(static_cast<char>(row.key)), std::string::npos)
        << row.keys;
  }
}

}  // namespace
