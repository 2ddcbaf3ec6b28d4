// Curves of the update strategies, and the frame from which rebuilding pays.
#include "tracer/analyze/timeline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "make_scene.h"
#include "tracer/analyze/break_even.h"
#include "tracer/error.h"

namespace tracer::test {
namespace {

using testing::HasSubstr;

std::shared_ptr<const Scene> scene() {
  Scene made = scene_of({sphere(16)});
  made.camera = default_camera(bounds(made));
  return std::make_shared<const Scene>(made);
}

Settings twisted() {
  Settings settings;
  settings.deformer = {"twist", 2.0f, "y", 0.5f};
  settings.update.frames_per_second = 10.0f;
  settings.update.every = 4;
  settings.render.ray_depth = 1;
  return settings;
}

TimelineOptions few(int64_t to, int64_t step = 1) {
  TimelineOptions options;
  options.to = to;
  options.step = step;
  options.width = 24;
  options.height = 16;
  return options;
}

TEST(Timeline, EachStrategyHasASampleForEachFrame) {
  int published = 0;
  const Timeline timeline =
      measure_timeline(scene(), twisted(), few(6, 2), {}, [&](const Timeline& so_far) {
        ++published;
        for (const TimelineCurve& curve : so_far.curves)
          EXPECT_EQ(curve.samples.size(), size_t(published));
      });
  EXPECT_EQ(published, 4);
  ASSERT_EQ(timeline.curves.size(), 3u);
  for (const TimelineCurve& curve : timeline.curves) {
    for (size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(curve.samples[i].frame, int64_t(2 * i));
      EXPECT_FLOAT_EQ(curve.samples[i].time, 0.2f * float(i));
      EXPECT_GT(curve.samples[i].nodes_per_ray, 0.0);
      EXPECT_GT(curve.samples[i].trace_ms, 0.0);
    }
  }
}

TEST(Timeline, StrategiesDoWhatTheySay) {
  const Timeline timeline = measure_timeline(scene(), twisted(), few(5), {});
  const auto& refit = timeline.curves[0].samples;
  const auto& every = timeline.curves[1].samples;
  const auto& rebuild = timeline.curves[2].samples;
  for (size_t i = 0; i < refit.size(); ++i) {
    EXPECT_EQ(refit[i].build_ms, 0.0) << i;
    EXPECT_EQ(rebuild[i].refit_ms, 0.0) << i;
    EXPECT_GT(rebuild[i].build_ms, 0.0) << i;
    EXPECT_EQ(rebuild[i].growth, 1.0) << i;
  }
  EXPECT_GT(refit[5].sah, rebuild[5].sah);
  EXPECT_GT(refit[5].growth, 1.0);
  EXPECT_GT(every[4].build_ms, 0.0);
  EXPECT_EQ(every[4].sah, rebuild[4].sah);
  EXPECT_EQ(every[5].build_ms, 0.0);
  EXPECT_GT(every[5].refit_ms, 0.0);
}

TEST(Timeline, AStepPaysOnlyForItsOwnFrames) {
  const Timeline timeline = measure_timeline(scene(), twisted(), few(6, 3), {});
  EXPECT_EQ(timeline.curves[1].samples[2].frame, 6);
  EXPECT_EQ(timeline.curves[1].samples[2].build_ms, 0.0);  // frame 4 was built in frame 4
}

TEST(Timeline, FiguresOfTreesAreTheSameForAnyNumberOfThreads) {
  Timeline first;
  for (const size_t threads : {1, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const Timeline timeline = measure_timeline(scene(), twisted(), few(2), {});
    if (threads == 1) first = timeline;
    for (size_t c = 0; c < 3; ++c) {
      for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(timeline.curves[c].samples[i].sah, first.curves[c].samples[i].sah);
        EXPECT_EQ(timeline.curves[c].samples[i].nodes_per_ray,
                  first.curves[c].samples[i].nodes_per_ray);
      }
    }
  }
}

TEST(Timeline, AStopKeepsWhatWasMeasured) {
  std::stop_source stop;
  const Timeline timeline = measure_timeline(scene(), twisted(), few(100), {stop.get_token(), {}},
                                             [&](const Timeline& so_far) {
                                               if (so_far.curves[0].samples.size() == 2)
                                                 stop.request_stop();
                                             });
  for (const TimelineCurve& curve : timeline.curves)
    EXPECT_EQ(curve.samples.size(), 2u);
}

TEST(Timeline, BadOptionsAreRefused) {
  Settings still = twisted();
  still.deformer.amount = 0.0f;
  EXPECT_THROW(measure_timeline(scene(), still, few(2), {}), Error);
  EXPECT_THROW(measure_timeline(scene(), twisted(), few(-1), {}), Error);
  EXPECT_THROW(measure_timeline(scene(), twisted(), few(100'000), {}), Error);
  TimelineOptions unknown = few(2);
  unknown.strategies = {"magic"};
  EXPECT_THROW(measure_timeline(scene(), twisted(), unknown, {}), Error);
}

TEST(Timeline, OneSwingInAtMostSixtyFrames) {
  Settings settings = twisted();
  EXPECT_EQ(one_swing(settings.deformer, settings.update).to, 20);
  settings.deformer.speed = 0.01f;
  const TimelineOptions slow = one_swing(settings.deformer, settings.update);
  EXPECT_EQ(slow.step, 17);
  EXPECT_LE(slow.to / slow.step, 60);
  settings.deformer.speed = 0.0f;
  EXPECT_EQ(one_swing(settings.deformer, settings.update).to, 20);
}

// Frame times by hand: trace only.
Timeline by_hand(const std::vector<double>& refit, const std::vector<double>& rebuild) {
  Timeline timeline;
  timeline.curves = {{"refit", {}}, {"rebuild", {}}};
  for (size_t i = 0; i < refit.size(); ++i) {
    for (int c = 0; c < 2; ++c) {
      TimelineSample sample;
      sample.frame = int64_t(10 * i);
      sample.trace_ms = c == 0 ? refit[i] : rebuild[i];
      timeline.curves[size_t(c)].samples.push_back(sample);
    }
  }
  return timeline;
}

TEST(BreakEven, OfASingleFrameAndOfAllTogether) {
  const BreakEven even = break_even(by_hand({1, 1, 4, 6, 9, 9}, {3, 3, 3, 3, 3, 3}));
  EXPECT_EQ(even.single, 2u);
  EXPECT_EQ(even.total, 4u);
}

TEST(BreakEven, OneShortFrameAloneIsNone) {
  const BreakEven even = break_even(by_hand({1, 4, 1, 1}, {3, 3, 3, 3}));
  EXPECT_FALSE(even.single);
  EXPECT_FALSE(even.total);
}

TEST(BreakEven, InWords) {
  EXPECT_THAT(break_even_text(by_hand({1, 1, 4, 6, 9, 9}, {3, 3, 3, 3, 3, 3})),
              testing::AllOf(HasSubstr("from frame 20"), HasSubstr("pay from frame 40")));
  EXPECT_THAT(break_even_text(by_hand({1, 1}, {3, 3})),
              testing::AllOf(HasSubstr("No single frame"), HasSubstr("do not pay up to frame 10")));
  EXPECT_THAT(break_even_text({}), HasSubstr("once refit and rebuild have both been measured"));
}

}  // namespace
}  // namespace tracer::test
