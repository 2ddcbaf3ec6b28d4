// Undo and redo.
#include "ui/history.h"

#include <gtest/gtest.h>

#include "driver.h"

namespace {

using tracer::Settings;

Settings with_depth(int depth) {
  Settings settings;
  settings.look.emplace();
  settings.render.ray_depth = depth;
  return settings;
}

Settings with_eye(float x) {
  Settings settings = with_depth(1);
  settings.look->camera.eye.x = x;
  return settings;
}

TEST(History, StepsBackAndForth) {
  ui::History history;
  for (int depth = 1; depth <= 3; ++depth)
    ui::record(history, with_depth(depth), 10.0 * depth);
  EXPECT_EQ(ui::undo(history)->render.ray_depth, 2);
  EXPECT_EQ(ui::undo(history)->render.ray_depth, 1);
  EXPECT_EQ(ui::undo(history), nullptr);
  EXPECT_EQ(ui::redo(history)->render.ray_depth, 2);
  EXPECT_EQ(ui::redo(history)->render.ray_depth, 3);
  EXPECT_EQ(ui::redo(history), nullptr);
}

TEST(History, AnEditAfterUndoForgetsWhatWasUndone) {
  ui::History history;
  for (int depth = 1; depth <= 3; ++depth)
    ui::record(history, with_depth(depth), 10.0 * depth);
  ui::undo(history);
  ui::record(history, with_depth(7), 40.0);
  EXPECT_FALSE(ui::can_redo(history));
  EXPECT_EQ(ui::undo(history)->render.ray_depth, 2);
}

TEST(History, EqualSettingsAreNoEdit) {
  ui::History history;
  ui::record(history, with_depth(1), 0.0);
  ui::record(history, with_depth(1), 5.0);
  EXPECT_FALSE(ui::can_undo(history));
}

TEST(History, MovesOfTheCameraInQuickSuccessionAreOne) {
  ui::History history;
  ui::record(history, with_eye(0.0f), 0.0);
  for (int i = 1; i <= 5; ++i)
    ui::record(history, with_eye(static_cast<float>(i)), 10.0 + 0.2 * i);
  EXPECT_EQ(history.states.size(), 2u);
  EXPECT_EQ(ui::undo(history)->look->camera.eye.x, 0.0f);
}

TEST(History, ALaterMoveOfTheCameraIsAnother) {
  ui::History history;
  ui::record(history, with_eye(0.0f), 0.0);
  ui::record(history, with_eye(1.0f), 10.0);
  ui::record(history, with_eye(2.0f), 12.0);
  EXPECT_EQ(history.states.size(), 3u);
}

TEST(History, TheListIsBounded) {
  ui::History history;
  for (size_t i = 0; i < ui::max_states + 50; ++i) {
    ui::record(history, with_depth(static_cast<int>(i)), static_cast<double>(i));
  }
  EXPECT_EQ(history.states.size(), ui::max_states);
  EXPECT_EQ(history.states[history.now].render.ray_depth, static_cast<int>(ui::max_states) + 49);
}

TEST(History, ADragIsOneEditAndKeysUndoIt) {
  ui::Driver driver;
  driver.show("render");
  const int before = driver.edited.settings.render.ray_depth;
  driver.drag("render/Ray depth", 60.0f);
  const int after = driver.edited.settings.render.ray_depth;
  ASSERT_NE(before, after);
  driver.press('Z', true);
  EXPECT_EQ(driver.edited.settings.render.ray_depth, before);
  driver.press('Z', true, true);
  EXPECT_EQ(driver.edited.settings.render.ray_depth, after);
}

TEST(History, TheMenuUndoes) {
  ui::Driver driver;
  driver.show("render");
  driver.click("render/Shadows");
  ASSERT_FALSE(driver.edited.settings.render.shadows);
  driver.menu({"Edit", "Undo"});
  EXPECT_TRUE(driver.edited.settings.render.shadows);
  driver.menu({"Edit", "Redo"});
  EXPECT_FALSE(driver.edited.settings.render.shadows);
}

TEST(History, PlayingIsNoEdit) {
  ui::Driver driver;
  driver.press(ui::key_space);
  driver.frame(20);
  EXPECT_GT(driver.edited.settings.time, 0.1f);
  EXPECT_FALSE(ui::can_undo(driver.state.history));
}

TEST(History, TheSizeThatFollowsThePanelIsNoEditAndStays) {
  ui::Driver driver;
  driver.state.picture_size = ui::PictureSize::panel;
  driver.frame(30);
  const int width = driver.edited.settings.render.width;
  EXPECT_GT(width, 160);
  EXPECT_FALSE(ui::can_undo(driver.state.history));
  driver.show("render");
  driver.click("render/Shadows");
  driver.press('Z', true);
  EXPECT_TRUE(driver.edited.settings.render.shadows);
  EXPECT_EQ(driver.edited.settings.render.width, width);
}

TEST(History, OpeningASceneIsUndoneToTheOldOneWithItsEdits) {
  ui::Driver driver;
  driver.edited.settings.look->ambient = {0.5f, 0.5f, 0.5f};
  driver.frame(3);
  ui::open_scene(driver.edited, driver.state, {"needles", {}, ""});
  driver.frame(3);
  driver.trace();
  driver.frame(3);
  ASSERT_TRUE(driver.edited.settings.look.has_value());
  driver.press('Z', true);
  EXPECT_EQ(driver.edited.settings.source.name, "showcase");
  ASSERT_TRUE(driver.edited.settings.look.has_value());
  EXPECT_EQ(driver.edited.settings.look->ambient, tracer::vec3(0.5f));
  driver.press('Z', true, true);
  EXPECT_EQ(driver.edited.settings.source.name, "needles");
  EXPECT_TRUE(driver.edited.settings.look.has_value());
}

}  // namespace
