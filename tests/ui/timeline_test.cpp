// The Timeline panel: what it edits, asks for and shows.
#include "tracer/analyze/timeline.h"

#include <gtest/gtest.h>

#include "driver.h"

namespace {

using ui::Driver;

tracer::Timeline curves() {
  tracer::Timeline timeline;
  timeline.options.to = 30;
  timeline.options.step = 10;
  timeline.deformer = {"twist", 0.5f, "y", 0.5f};
  timeline.curves = {{"refit", {}}, {"every", {}}, {"rebuild", {}}};
  for (int i = 0; i < 4; ++i) {
    for (tracer::TimelineCurve& curve : timeline.curves) {
      tracer::TimelineSample sample;
      sample.frame = 10 * i;
      sample.time = float(i) / 3.0f;
      sample.sah = 30.0 + i;
      sample.nodes_per_ray = 9.0;
      sample.refit_ms = 1.0;
      sample.trace_ms = curve.strategy == "refit" ? 3.0 * i : 4.0;
      curve.samples.push_back(sample);
    }
  }
  return timeline;
}

struct Twisted : Driver {
  Twisted() {
    edited.settings.deformer = {"twist", 0.5f, "y", 0.5f};
    trace();
    show("timeline");
    frame(3);
  }
  void bring(const tracer::Timeline& timeline) {
    work.timeline.result = std::make_shared<const tracer::Timeline>(timeline);
    work.timeline_of = std::make_shared<const tracer::Settings>(edited.settings);
    frame(3);
  }
};

TEST(TimelinePanel, TheDeformersOptionsAppearWithIt) {
  Driver driver;
  driver.show("timeline");
  EXPECT_FALSE(driver.is_there("timeline/Amount"));
  EXPECT_FALSE(driver.is_there("timeline/Measure"));
  driver.choose("timeline/Deformer", "twist");
  EXPECT_EQ(driver.edited.settings.deformer.kind, "twist");
  const float before = driver.edited.settings.deformer.amount;
  driver.drag("timeline/Amount", 40.0f);
  EXPECT_GT(driver.edited.settings.deformer.amount, before);
  driver.choose("timeline/Axis", "z");
  EXPECT_EQ(driver.edited.settings.deformer.axis, "z");
  driver.drag("timeline/Swings", 40.0f);
  EXPECT_GT(driver.edited.settings.deformer.speed, 0.25f);
  EXPECT_TRUE(driver.is_there("timeline/Measure"));
}

TEST(TimelinePanel, TheOptionsOfAllStrategiesAreThere) {
  Driver driver;
  driver.show("timeline");
  driver.drag("timeline/N", 40.0f);  // of a curve, though its strategy is not chosen
  EXPECT_GT(driver.edited.settings.update.every, 10u);
  driver.choose("timeline/Strategy", "growth");
  EXPECT_EQ(driver.edited.settings.update.strategy, "growth");
  driver.drag("timeline/F", 40.0f);
  EXPECT_GT(driver.edited.settings.update.growth, 1.5f);
}

TEST(TimelinePanel, TheMotionsSpeedAppearsWithIt) {
  Driver driver;
  driver.show("timeline");
  EXPECT_FALSE(driver.is_there("timeline/Motion speed"));
  driver.choose("timeline/Motion", "spin");
  driver.drag("timeline/Motion speed", 40.0f);
  EXPECT_GT(driver.edited.settings.motion.speed, 0.25f);
}

TEST(TimelinePanel, StepsByOneFrame) {
  Driver driver;
  driver.show("timeline");
  driver.click("timeline/>");
  driver.click("timeline/>");
  EXPECT_FLOAT_EQ(driver.edited.settings.time, 2.0f / 30.0f);
  driver.click("timeline/<");
  EXPECT_FLOAT_EQ(driver.edited.settings.time, 1.0f / 30.0f);
}

TEST(TimelinePanel, PlayingBeginsAgainAtTheEndOfTheRange) {
  Twisted driver;
  EXPECT_FLOAT_EQ(driver.state.timeline.to, 2.0f);  // one swing
  driver.edited.settings.time = 1.99f;
  driver.state.playing = true;
  driver.frame(4);
  EXPECT_LT(driver.edited.settings.time, 1.0f);
  driver.state.timeline.loop = false;
  driver.edited.settings.time = 1.99f;
  driver.frame(4);
  EXPECT_GT(driver.edited.settings.time, 2.0f);
}

TEST(TimelinePanel, AnOwnRangeStaysUntilOneSwingIsAskedFor) {
  Twisted driver;
  driver.drag("timeline/To", 60.0f);
  EXPECT_TRUE(driver.state.timeline.own_range);
  const float to = driver.state.timeline.to;
  EXPECT_GT(to, 2.0f);
  driver.edited.settings.deformer.speed = 1.0f;
  driver.frame(2);
  EXPECT_EQ(driver.state.timeline.to, to);
  driver.click("timeline/One swing");
  driver.frame(2);
  EXPECT_FLOAT_EQ(driver.state.timeline.to, 1.0f);
}

TEST(TimelinePanel, MeasureAsksForTheRange) {
  Twisted driver;
  driver.state.playing = true;
  driver.state.timeline.frames = 11;
  driver.frame();
  driver.click("timeline/Measure");
  ASSERT_TRUE(driver.requests.measure_timeline);
  EXPECT_EQ(driver.requests.measure_timeline->from, 0);
  EXPECT_EQ(driver.requests.measure_timeline->to, 60);
  EXPECT_EQ(driver.requests.measure_timeline->step, 6);
  EXPECT_EQ(driver.requests.measure_timeline->width, 320);
  EXPECT_EQ(driver.requests.measure_timeline->height, 240);
  EXPECT_FALSE(driver.state.playing);
}

TEST(TimelinePanel, WhileMeasuringItCanBeCancelled) {
  Twisted driver;
  driver.work.timeline.running = true;
  driver.frame(2);
  EXPECT_FALSE(driver.is_there("timeline/Measure"));
  driver.click("timeline/Cancel");
  EXPECT_TRUE(driver.requests.cancel_timeline);
}

TEST(TimelinePanel, FourCurvesAndWords) {
  Twisted driver;
  EXPECT_FALSE(driver.is_there("timeline/SAH curve"));
  driver.bring(curves());
  for (const char* label : {"SAH curve", "nodes curve", "update curve", "frame curve", "words"})
    EXPECT_TRUE(driver.is_there(std::string("timeline/") + label)) << label;
}

TEST(TimelinePanel, AClickInACurveGoesToThatMoment) {
  Twisted driver;
  driver.bring(curves());
  const ui::Item item = driver.find("timeline/frame curve");
  driver.drag({0.75f * item.lo.x + 0.25f * item.hi.x, 0.5f * (item.lo.y + item.hi.y)},
              {0.2f * item.lo.x + 0.8f * item.hi.x, 0.5f * (item.lo.y + item.hi.y)});
  EXPECT_GT(driver.edited.settings.time, 0.4f);
  EXPECT_LE(driver.edited.settings.time, 1.0f);
}

TEST(TimelinePanel, CurvesOfASingleFrameAndOfNone) {
  Twisted driver;
  tracer::Timeline one = curves();
  for (tracer::TimelineCurve& curve : one.curves)
    curve.samples.resize(1);
  driver.bring(one);
  EXPECT_TRUE(driver.is_there("timeline/frame curve"));
  for (tracer::TimelineCurve& curve : one.curves)
    curve.samples.clear();
  driver.bring(one);
  EXPECT_FALSE(driver.is_there("timeline/frame curve"));
}

TEST(TimelinePanel, CurvesInANarrowPlace) {
  Twisted driver;
  ui::move_panel(driver.state.layout, "timeline", ui::Region::right);
  driver.bring(curves());
  EXPECT_TRUE(driver.is_there("timeline/SAH curve"));
}

}  // namespace
