// The Benchmark panel.
#include "ui/benchmark.h"

#include <gtest/gtest.h>

#include "driver.h"
#include "tracer/bvh/ray_kernels.h"

namespace {

using tracer::Benchmark;
using tracer::RayTiming;
using ui::Driver;

const ImVec2 large(2200, 900);  // no column has to be scrolled to

RayTiming timing(const char* who, const char* builder, const char* layout, double speed) {
  RayTiming row;
  row.who = who;
  row.builder = builder;
  row.layout = layout;
  row.kernel = "single";
  row.ray_class = "primary";
  row.view = "camera";
  row.rays = 100;
  row.hits = 60;
  row.mrays_per_s = {speed, speed - 0.1, speed + 0.1};
  if (row.who.empty()) row.ratios = {{1, speed / 4.0}};
  return row;
}

// Three rows of ours, of two classes and thread counts, and one of a peer; two builds.
Benchmark some_result() {
  Benchmark result;
  result.rays = {timing("", "binned", "binary", 2.0), timing("", "binned", "wide8", 6.0),
                 timing("", "lbvh", "wide4", 5.0), timing("embree", "binned", "medium", 4.0)};
  result.rays[2].ray_class = "shadow";
  result.rays[2].threads = 2;
  result.builds.resize(2);
  for (tracer::BuildTiming& row : result.builds)
    row.builder = "sweep";
  result.builds[0].layout = "wide8";
  result.builds[1].layout = "binary";
  return result;
}

Driver& with(Driver& driver, Benchmark result) {
  driver.show("benchmark");
  driver.work.benchmark.result = std::make_shared<const Benchmark>(std::move(result));
  driver.frame(3);
  return driver;
}

void close_popup(Driver& driver) {
  driver.press(ui::key_escape);
  driver.click_at({400, 300});
}

TEST(BenchmarkPanel, SaysWhatToDoWhenItIsEmpty) {
  Driver driver("showcase", large);
  driver.show("benchmark");
  EXPECT_TRUE(driver.is_there("benchmark/empty"));
  EXPECT_FALSE(driver.is_there("benchmark/missing peers"));
  driver.work.missing_peers = "Nobody was found.";
  driver.frame(2);
  EXPECT_TRUE(driver.is_there("benchmark/missing peers"));
}

TEST(BenchmarkPanel, RunAsksForEverythingAtFirst) {
  Driver driver("showcase", large);
  driver.edited.settings.build.builder = "ploc";
  driver.edited.settings.build.search_radius = 5;
  driver.show("benchmark");
  driver.click("benchmark/Run");
  ASSERT_TRUE(driver.requests.benchmark);
  const tracer::BenchmarkOptions& options = driver.requests.benchmark->options;
  ASSERT_EQ(options.builds.size(), 1u);
  EXPECT_EQ(options.builds[0].builder, "ploc");
  EXPECT_EQ(options.builds[0].search_radius, 5u);
  EXPECT_EQ(options.layouts.size(), tracer::layouts().size());
  EXPECT_EQ(options.kernels.size(), tracer::ray_kernels().size());
  EXPECT_EQ(options.classes.size(), tracer::ray_set_rows().size());
  EXPECT_EQ(options.threads, tracer::usual_threads());
  EXPECT_EQ(options.turns, 3);
  EXPECT_EQ(options.width, 640);
  EXPECT_FALSE(driver.requests.benchmark->flatten);
  EXPECT_FALSE(options.fast);
}

TEST(BenchmarkPanel, TicksChoose) {
  Driver driver("showcase", large);
  driver.show("benchmark");
  driver.click("benchmark/Choose...");
  driver.click("benchmark/choice/Builders/lbvh");
  driver.click("benchmark/choice/Builders/sweep");
  driver.click("benchmark/choice/Layouts/wide4");
  driver.click("benchmark/choice/Rays/random");
  driver.click("benchmark/choice/All threads");
  driver.click("benchmark/choice/Quick");
  driver.click("benchmark/choice/One mesh");
  driver.click("benchmark/choice/Fast tests");
  close_popup(driver);
  driver.click("benchmark/Run");
  ASSERT_TRUE(driver.requests.benchmark);
  const tracer::BenchmarkOptions& options = driver.requests.benchmark->options;
  ASSERT_EQ(options.builds.size(), 2u);
  EXPECT_EQ(options.builds[0].builder, "sweep");
  EXPECT_EQ(options.builds[1].builder, "lbvh");
  const auto has = [](const std::vector<std::string>& ids, const char* id) {
    return std::find(ids.begin(), ids.end(), id) != ids.end();
  };
  EXPECT_TRUE(options.fast);
  EXPECT_FALSE(has(options.layouts, "wide4"));
  EXPECT_TRUE(has(options.layouts, "wide8"));
  EXPECT_FALSE(has(options.classes, "random"));
  EXPECT_EQ(options.threads, std::vector<int>{1});
  EXPECT_EQ(options.turns, 5);
  EXPECT_EQ(options.width, 1280);
  EXPECT_TRUE(driver.requests.benchmark->flatten);
}

TEST(BenchmarkPanel, WithoutRaysOnlyBuildsAreMeasured) {
  Driver driver("showcase", large);
  for (const tracer::RaySetRow& row : tracer::ray_set_rows())
    driver.state.benchmark.left_out.emplace(row.id);
  driver.show("benchmark");
  driver.click("benchmark/Run");
  ASSERT_TRUE(driver.requests.benchmark);
  EXPECT_FALSE(driver.requests.benchmark->options.rays);
}

TEST(BenchmarkPanel, NothingToMeasureIsSaid) {
  Driver driver("showcase", large);
  driver.state.benchmark.one_thread = driver.state.benchmark.all_threads = false;
  driver.show("benchmark");
  driver.click("benchmark/Run");
  EXPECT_FALSE(driver.requests.benchmark);
  EXPECT_TRUE(driver.is_there("benchmark/nothing chosen"));
}

TEST(BenchmarkPanel, RunningCanBeCancelled) {
  Driver driver("showcase", large);
  driver.show("benchmark");
  driver.work.benchmark.running = true;
  driver.work.benchmark.doing = "binned: primary rays, camera";
  driver.frame(2);
  EXPECT_TRUE(driver.is_there("benchmark/progress"));
  EXPECT_FALSE(driver.is_there("benchmark/Run"));
  driver.click("benchmark/Cancel");
  EXPECT_TRUE(driver.requests.cancel_benchmark);
}

TEST(BenchmarkPanel, ClickOnARowUsesItsBuilderAndLayoutAndCanBeUndone) {
  Driver driver("showcase", large);
  with(driver, some_result());
  EXPECT_FALSE(driver.is_there("benchmark/empty"));
  const tracer::BuildOptions before = driver.edited.settings.build;
  driver.click("benchmark/timing 3/row");
  EXPECT_EQ(driver.edited.settings.build.builder, "lbvh");
  EXPECT_EQ(driver.edited.settings.build.layout, "wide4");
  driver.press('Z', true);
  EXPECT_EQ(driver.edited.settings.build, before);
}

TEST(BenchmarkPanel, ClickOnARowUsesItsKernelForItsClass) {
  Driver driver("showcase", large);
  Benchmark result = some_result();
  result.rays[1].kernel = "packet";
  result.rays[2].kernel = "stream";
  with(driver, std::move(result));
  using Kernels = std::array<std::string, 4>;
  const Kernels before = driver.edited.settings.render.kernels;
  EXPECT_EQ(before, (Kernels{"automatic", "automatic", "automatic", "automatic"}));
  driver.click("benchmark/timing 2/row");
  EXPECT_EQ(driver.edited.settings.build.layout, "wide8");
  EXPECT_EQ(driver.edited.settings.render.kernels,
            (Kernels{"packet", "automatic", "automatic", "automatic"}));
  driver.click("benchmark/timing 3/row");
  EXPECT_EQ(driver.edited.settings.render.kernels,
            (Kernels{"packet", "stream", "automatic", "automatic"}));
  driver.press('Z', true);
  driver.press('Z', true);
  EXPECT_EQ(driver.edited.settings.render.kernels, before);
}

TEST(BenchmarkPanel, ClickOnAFastRowTracesWithFastTests) {
  Driver driver("showcase", large);
  Benchmark result = some_result();
  result.rays[1].kernel = result.rays[2].kernel = "packet";
  result.rays[1].robust = false;
  with(driver, std::move(result));
  driver.click("benchmark/timing 2/row");
  EXPECT_TRUE(driver.edited.settings.render.fast);
  driver.click("benchmark/timing 3/row");
  EXPECT_FALSE(driver.edited.settings.render.fast);
}

TEST(BenchmarkPanel, ClickOnRaysThatThePictureLacksLeavesTheKernels) {
  Driver driver("showcase", large);
  Benchmark result = some_result();
  result.rays[1].kernel = "stream";
  result.rays[1].ray_class = "diffuse";
  with(driver, std::move(result));
  const auto before = driver.edited.settings.render;
  driver.click("benchmark/timing 2/row");
  EXPECT_EQ(driver.edited.settings.build.layout, "wide8");
  EXPECT_EQ(driver.edited.settings.render, before);
}

TEST(BenchmarkPanel, ClickOnAPeerChangesNothing) {
  Driver driver("showcase", large);
  with(driver, some_result());
  const ui::Edited before = driver.edited;
  driver.click("benchmark/timing 4/row");
  EXPECT_EQ(driver.edited, before);
}

TEST(BenchmarkPanel, EveryColumnSorts) {
  Driver driver("showcase", large);
  with(driver, some_result());
  const auto height = [&](int row) {
    return driver.find("benchmark/timing " + std::to_string(row) + "/row").lo.y;
  };
  EXPECT_LT(height(1), height(2));
  driver.click("benchmark/header/Mrays/s");  // the fastest first
  EXPECT_LT(height(2), height(3));
  EXPECT_LT(height(3), height(4));
  EXPECT_LT(height(4), height(1));
  driver.click("benchmark/header/Layout");
  EXPECT_LT(height(1), height(3));
  EXPECT_LT(height(3), height(2));
  for (const char* column :
       {"Builder", "Kernel", "Rays", "Threads", "Speed", "x1", "Hits", "Sum of t", "Differ"})
    driver.click(std::string("benchmark/header/") + column);
}

TEST(BenchmarkPanel, FiltersChooseRows) {
  Driver driver("showcase", large);
  with(driver, some_result());
  driver.choose("benchmark/Class", "shadow");
  driver.frame(2);
  EXPECT_FALSE(driver.is_there("benchmark/timing 1/row"));
  EXPECT_TRUE(driver.is_there("benchmark/timing 3/row"));
  driver.choose("benchmark/Class", "all");
  driver.choose("benchmark/Threads", "one");
  driver.frame(2);
  EXPECT_TRUE(driver.is_there("benchmark/timing 1/row"));
  EXPECT_FALSE(driver.is_there("benchmark/timing 3/row"));
}

TEST(BenchmarkPanel, BuildsHaveATableOfTheirOwn) {
  Driver driver("showcase", large);
  with(driver, some_result());
  driver.choose("benchmark/Show", "builds");
  driver.frame(2);
  EXPECT_TRUE(driver.is_there("benchmark/header/Build ms"));
  driver.click("benchmark/timing 1/row");
  EXPECT_EQ(driver.edited.settings.build.builder, "sweep");
  EXPECT_EQ(driver.edited.settings.build.layout, "wide8");
  for (const char* column :
       {"Builder", "Layout", "Threads", "Build ms", "Mtri/s", "Speed", "Ratio", "SAH", "B/tri"})
    driver.click(std::string("benchmark/header/") + column);
}

TEST(BenchmarkPanel, FaultsAndErrorsAreShown) {
  Driver driver("showcase", large);
  Benchmark result = some_result();
  result.faults = {"embree answers otherwise"};
  with(driver, result);
  EXPECT_TRUE(driver.is_there("benchmark/fault"));
  driver.work.benchmark.error = "there is not enough memory for it";
  driver.frame(2);
  EXPECT_TRUE(driver.is_there("benchmark/error"));
}

TEST(BenchmarkPanel, HoveringARowShowsFigures) {
  Driver driver("showcase", large);
  with(driver, some_result());
  driver.hover("benchmark/timing 2/bar");
  driver.hover("benchmark/timing 4/bar");
  driver.hover("benchmark/header/x1");
  EXPECT_TRUE(driver.is_there("benchmark/timing 4/bar"));
}

}  // namespace
