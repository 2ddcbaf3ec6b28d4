// The Builders panel.
#include <gtest/gtest.h>

#include "driver.h"
#include "ui/comparison.h"

namespace {

using tracer::BuildState;
using tracer::ComparedBuild;
using ui::Driver;

const ImVec2 large(2200, 900);  // no column has to be scrolled to

// A build without measuring.
ComparedBuild made(const char* builder, double ms, double cost) {
  ComparedBuild row;
  row.options.builder = builder;
  row.state = BuildState::done;
  row.build_ms = ms;
  row.triangles_per_ray = cost;
  row.sah = 10.0 + ms;
  row.epo = cost;
  row.nodes = 5;
  return row;
}

// As if these rows had been asked for and measured.
void put(Driver& driver, std::vector<ComparedBuild> rows) {
  ui::BuildersState& state = driver.state.builders;
  for (const ComparedBuild& row : rows)
    state.rows.emplace_back().options = row.options;
  state.adopted.reset();
  driver.work.comparison.result =
      std::make_shared<const std::vector<ComparedBuild>>(std::move(rows));
  driver.frame(3);
}

Driver& with_rows(Driver& driver) {
  driver.show("builders");
  put(driver, {made("binned", 5.0, 20.0), made("lbvh", 1.0, 30.0), made("median", 6.0, 25.0)});
  return driver;
}

TEST(BuildersPanel, MeasuresEveryBuilderAtFirst) {
  Driver driver("showcase", large);
  driver.show("builders");
  driver.click("builders/Measure");
  ASSERT_TRUE(driver.requests.compare);
  EXPECT_EQ(driver.requests.compare->size(), tracer::builders().size());
  EXPECT_EQ(driver.state.builders.rows.size(), tracer::builders().size());
}

TEST(BuildersPanel, TicksChooseBuildersAndOptimizers) {
  Driver driver("showcase", large);
  driver.edited.settings.build.bins = 8;
  driver.show("builders");
  driver.click("builders/Choose...");
  for (const tracer::BuilderRow& row : tracer::builders()) {
    if (row.id != "ploc") driver.click("builders/choice/" + std::string(row.id));
  }
  driver.click("builders/choice/rotations");
  driver.press(ui::key_escape);
  driver.click_at({400, 300});
  driver.click("builders/Measure");
  ASSERT_TRUE(driver.requests.compare);
  const auto& wanted = *driver.requests.compare;
  ASSERT_EQ(wanted.size(), 3u);
  EXPECT_EQ(describe(wanted[0]), "ploc");
  EXPECT_EQ(describe(wanted[1]), "ploc + rotations");
  EXPECT_EQ(describe(wanted[2]), "binned, bins 8");  // of the Build panel
}

TEST(BuildersPanel, TicksChoosePreSplitting) {
  Driver driver("showcase", large);
  driver.show("builders");
  driver.click("builders/Choose...");
  driver.click("builders/choice/whole");
  driver.click("builders/choice/presplit");
  driver.click("builders/choice/present");
  driver.press(ui::key_escape);
  driver.click_at({400, 300});
  driver.click("builders/Measure");
  ASSERT_TRUE(driver.requests.compare);
  EXPECT_EQ(driver.requests.compare->size(), tracer::builders().size());
  for (const tracer::BuildOptions& options : *driver.requests.compare)
    EXPECT_TRUE(options.presplit);
}

TEST(BuildersPanel, ResultsAppearRowByRow) {
  Driver driver("showcase", large);
  with_rows(driver);
  const auto& rows = driver.state.builders.rows;
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[1].build_ms, 1.0);
  EXPECT_TRUE(driver.is_there("builders/lbvh/row"));
  EXPECT_FALSE(driver.is_there("builders/lbvh/state"));
}

TEST(BuildersPanel, WhatIsNotMeasuredSaysSo) {
  Driver driver("showcase", large);
  driver.show("builders");
  ComparedBuild failed = made("median", 0, 0);
  failed.state = BuildState::failed;
  failed.error = "there is not enough memory for it";
  put(driver, {made("binned", 5.0, 20.0), failed});
  driver.state.builders.rows.emplace_back().options.builder = "sweep";
  driver.frame(2);
  EXPECT_TRUE(driver.is_there("builders/median/state"));
  EXPECT_TRUE(driver.is_there("builders/sweep/state"));
}

TEST(BuildersPanel, ClickOnARowUsesItsOptionsAndCanBeUndone) {
  Driver driver("showcase", large);
  with_rows(driver);
  driver.click("builders/lbvh/row");
  EXPECT_EQ(driver.edited.settings.build.builder, "lbvh");
  driver.press('Z', true);
  EXPECT_EQ(driver.edited.settings.build.builder, "binned");
}

TEST(BuildersPanel, ClickOnAPointUsesItsOptions) {
  Driver driver("showcase", large);
  with_rows(driver);
  driver.click("builders/plot/point 3");
  EXPECT_EQ(driver.edited.settings.build.builder, "median");
}

TEST(BuildersPanel, HoverLinksTableAndPlot) {
  Driver driver("showcase", large);
  with_rows(driver);
  driver.hover("builders/plot/point 2");
  EXPECT_EQ(driver.state.builders.hovered, 1);
  driver.hover("builders/median/row");
  EXPECT_EQ(driver.state.builders.hovered, 2);
  driver.hover("builders/Measure");
  EXPECT_EQ(driver.state.builders.hovered, -1);
}

TEST(BuildersPanel, EveryColumnSorts) {
  Driver driver("showcase", large);
  with_rows(driver);
  driver.click("builders/header/Build ms");
  EXPECT_LT(driver.find("builders/lbvh/row").lo.y, driver.find("builders/binned/row").lo.y);
  driver.click("builders/header/Build ms");
  EXPECT_GT(driver.find("builders/lbvh/row").lo.y, driver.find("builders/binned/row").lo.y);
  driver.click("builders/header/Build options");
  EXPECT_LT(driver.find("builders/binned/row").lo.y, driver.find("builders/lbvh/row").lo.y);
  for (const tracer::ComparisonColumn& column : tracer::comparison_columns()) {
    const std::string unit = column.unit.empty() ? "" : " " + std::string(column.unit);
    driver.click("builders/header/" + std::string(column.label) + unit);
  }
  driver.click("builders/header/Predicted");
}

TEST(BuildersPanel, RowsAreRemovedAndCleared) {
  Driver driver("showcase", large);
  with_rows(driver);
  driver.click("builders/lbvh/Remove");
  EXPECT_EQ(driver.state.builders.rows.size(), 2u);
  driver.frame(3);
  EXPECT_EQ(driver.state.builders.rows.size(), 2u);  // the result does not bring it back
  driver.click("builders/Clear");
  EXPECT_TRUE(driver.state.builders.rows.empty());
}

TEST(BuildersPanel, MeasureAgainAsksForAllRows) {
  Driver driver("showcase", large);
  with_rows(driver);
  driver.click("builders/Measure again");
  ASSERT_TRUE(driver.requests.compare);
  EXPECT_EQ(driver.requests.compare->size(), 3u);
  EXPECT_EQ(driver.state.builders.rows[0].state, BuildState::waiting);
}

TEST(BuildersPanel, AnotherSceneClearsTheRows) {
  Driver driver("showcase", large);
  with_rows(driver);
  driver.edited.settings.source = tracer::parse_scene_source("needles:triangles=500");
  driver.edited.settings.look.reset();
  driver.trace();
  driver.frame(2);
  EXPECT_TRUE(driver.state.builders.rows.empty());
}

TEST(BuildersPanel, RunningCanBeCancelled) {
  Driver driver("showcase", large);
  driver.show("builders");
  driver.work.comparison.running = true;
  driver.work.comparison.doing = "binned: building";
  driver.frame(2);
  EXPECT_TRUE(driver.is_there("builders/progress"));
  EXPECT_FALSE(driver.is_there("builders/Measure"));
  driver.click("builders/Cancel");
  EXPECT_TRUE(driver.requests.cancel_comparison);
}

TEST(BuildersPanel, PredictionNeedsThreeBuilds) {
  Driver driver("showcase", large);
  driver.show("builders");
  put(driver, {made("binned", 5.0, 20.0), made("lbvh", 1.0, 30.0)});
  driver.choose("builders/Plot", "prediction");
  ASSERT_EQ(driver.state.builders.plot, "prediction");
  driver.frame(2);
  EXPECT_FALSE(driver.is_there("builders/plot"));
  put(driver, {made("median", 6.0, 25.0)});
  EXPECT_TRUE(driver.is_there("builders/plot"));
  EXPECT_TRUE(comparable_rows(driver.state.builders).blend);
}

TEST(BuildersPanel, RowsOfAnotherViewAreNotCompared) {
  Driver driver("showcase", large);
  with_rows(driver);
  ComparedBuild other = made("sweep", 9.0, 9.0);
  other.view.width = 77;
  put(driver, {other});
  const ui::ComparableRows comparable = comparable_rows(driver.state.builders);
  ASSERT_EQ(comparable.rows.size(), 1u);
  EXPECT_EQ(comparable.builds[0].options.builder, "sweep");
}

TEST(BuildersPanel, ARestingPictureIsSaidInTheStatusBar) {
  Driver driver;
  driver.work.measuring_time = true;
  driver.frame(2);
  EXPECT_TRUE(driver.is_there("status/paused"));
}

}  // namespace
