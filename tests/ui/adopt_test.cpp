// What the workspace takes over from the pipeline.
#include <gtest/gtest.h>

#include "driver.h"

namespace {

using ui::Driver;

TEST(Adopt, ALoadedScenesLookBecomesTheEditedOne) {
  Driver driver;
  ASSERT_TRUE(driver.edited.settings.look.has_value());
  EXPECT_EQ(*driver.edited.settings.look, *driver.snapshot->settings.look);
}

TEST(Adopt, WarningsOfTheSceneAreMessages) {
  Driver driver;
  auto changed = std::make_shared<tracer::Snapshot>(*driver.snapshot);
  auto scene = std::make_shared<tracer::Scene>(*changed->scene);
  scene->warnings = {"2 triangles without area were left out"};
  changed->scene = scene;
  ++changed->scene_generation;
  driver.snapshot = changed;
  driver.frame(2);
  EXPECT_EQ(driver.state.messages.back().text, "2 triangles without area were left out");
  EXPECT_EQ(driver.state.messages.back().severity, ui::Severity::warning);
}

TEST(Adopt, ANewSceneClearsTheSelection) {
  Driver driver;
  driver.state.selection.instance = 1;
  ui::open_scene(driver.edited, driver.state, {"needles", {}, ""});
  driver.trace();
  EXPECT_EQ(driver.state.selection, ui::Selection());
}

TEST(Adopt, ASelectedNodeStaysWhileItsTreeIsRefitted) {
  Driver driver;
  driver.trace();
  driver.frame();
  driver.state.selection.node = ui::NodePlace{0, 1};
  driver.edited.settings.deformer = {"twist", 0.5f, "y", 0.0f};
  driver.edited.settings.update.strategy = "refit";
  driver.trace();
  driver.frame();
  const ui::NodePlace place{0, 1};
  EXPECT_EQ(driver.state.selection.node, place);
  driver.edited.settings.build.builder = "midpoint";
  driver.trace();
  driver.frame();
  EXPECT_FALSE(driver.state.selection.node) << "the nodes of the new tree are others";
}

TEST(Adopt, AMissingFileLeavesTheSceneAndTheEditsAndSaysWhy) {
  Driver driver;
  driver.edited.settings.look->ambient = {0.7f, 0.7f, 0.7f};
  driver.trace();
  driver.frame(2);
  const tracer::Settings before = driver.edited.settings;
  ui::open_scene(driver.edited, driver.state, {"no/such/file.obj", {}, ""});
  driver.frame(2);
  driver.trace();
  driver.frame(2);
  EXPECT_TRUE(driver.edited.settings == before);
  EXPECT_NE(driver.state.banner.find("no/such/file.obj"), std::string::npos);
  EXPECT_EQ(driver.state.messages.back().severity, ui::Severity::error);
}

TEST(Adopt, TheSameMissingFileIsReportedAgainWhenItIsAskedForAgain) {
  Driver driver;
  for (int i = 0; i < 2; ++i) {
    ui::open_scene(driver.edited, driver.state, {"no/such/file.obj", {}, ""});
    driver.trace();
    driver.frame(2);
    EXPECT_FALSE(driver.state.banner.empty());
    driver.state.banner.clear();
    driver.trace();  // with the good scene again
    driver.frame(2);
    EXPECT_TRUE(driver.state.banner.empty());
  }
}

TEST(Adopt, AnotherSceneAfterAMissingFileIsLoaded) {
  Driver driver;
  ui::open_scene(driver.edited, driver.state, {"no/such/file.obj", {}, ""});
  driver.trace();
  driver.frame(2);
  ui::open_scene(driver.edited, driver.state, {"needles", {}, ""});
  driver.frame(2);  // with the snapshot that still tells of the failure
  EXPECT_EQ(driver.edited.settings.source.name, "needles");
  driver.trace();
  EXPECT_EQ(driver.snapshot->settings.source.name, "needles");
  EXPECT_TRUE(driver.edited.settings.look.has_value());
}

TEST(Adopt, ABrokenSkyLeavesTheSceneAsItWas) {
  Driver driver;
  driver.edited.settings.source.sky_file = "no/such/sky.hdr";
  driver.trace();
  driver.frame(2);
  if (driver.snapshot->error.empty()) {
    EXPECT_FALSE(driver.snapshot->scene->warnings.empty());
  } else {
    EXPECT_TRUE(driver.edited.settings.source.sky_file.empty());
  }
  EXPECT_TRUE(driver.edited.settings.look.has_value());
}

TEST(Adopt, MessagesAreBounded) {
  ui::UiState state;
  for (int i = 0; i < 5000; ++i)
    ui::post(state, ui::Severity::info, "message");
  EXPECT_LE(state.messages.size(), 1000u);
}

}  // namespace
