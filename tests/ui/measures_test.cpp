// Measures in the Build panel.
#include "ui/measures.h"

#include <gtest/gtest.h>

#include "driver.h"

namespace {

using ui::Driver;

ui::Frame frame_of(Driver& driver) {
  return {*driver.snapshot, nullptr,         {},         16.0f, {}, driver.edited,
          driver.state,     driver.requests, driver.work};
}

void measure(Driver& driver) {
  driver.work.measures.result = std::make_shared<const tracer::Measures>(
      tracer::measure(*driver.snapshot->scene, driver.snapshot->bvh, nullptr, {}));
}

TEST(Measures, AreShownOfTheTreeTheyWereTakenFrom) {
  Driver driver;
  EXPECT_EQ(blas_measures(frame_of(driver)), nullptr);
  measure(driver);
  EXPECT_NE(blas_measures(frame_of(driver)), nullptr);
  EXPECT_NE(tlas_measures(frame_of(driver)), nullptr);
}

TEST(Measures, OfAnOldTreeAreNotShownUnderANewOne) {
  Driver driver;
  measure(driver);
  driver.edited.settings.build.builder = "median";
  driver.trace();
  EXPECT_EQ(blas_measures(frame_of(driver)), nullptr);
  EXPECT_EQ(tlas_measures(frame_of(driver)), nullptr);
}

TEST(Measures, OfTheMeshesOutliveAMoveOfTheInstances) {
  Driver driver("teapots:detail=2");
  measure(driver);
  driver.edited.settings.time = 1.0f;
  driver.trace();
  EXPECT_NE(blas_measures(frame_of(driver)), nullptr);
  EXPECT_EQ(tlas_measures(frame_of(driver)), nullptr);
}

TEST(Measures, AClickOnAPairSelectsTheInstance) {
  Driver driver("teapots:detail=2");
  tracer::Measures measures;
  measures.bvh = driver.snapshot->bvh;
  const tracer::InstancePair pair{1, 2, 0.5f};
  measures.instances.emplace().worst = {pair};
  driver.work.measures.result = std::make_shared<const tracer::Measures>(measures);
  driver.show("build");
  driver.click("build/TLAS/pair 1/" + std::to_string(pair.b) + "/Select");
  EXPECT_EQ(driver.state.selection.instance, pair.b);
  driver.click("build/TLAS/pair 1/" + std::to_string(pair.a) + "/Select");
  EXPECT_EQ(driver.state.selection.instance, pair.a);
}

}  // namespace
