// What the window does beside the session, and when.
#include "app/window/background_work.h"

#include <gtest/gtest.h>

#include "tests/window/wait.h"

namespace app {
namespace {

using namespace std::chrono_literals;

void wake_nobody() {}

struct Fixture {
  Session session{wake_nobody};
  BackgroundWork work{session, wake_nobody};
  tracer::Pipeline pipeline;
  tracer::Settings settings;

  Fixture() {
    settings.source.name = "showcase";
    settings.render = {.width = 64, .height = 48, .ray_depth = 1, .samples = 1};
  }
  const tracer::Snapshot& trace() {
    pipeline.run(settings, {}, {});
    return *pipeline.snapshot();
  }
  bool measures_end() {
    return becomes_true([&] { return !work.measures.state().running; });
  }
};

TEST(KeepMeasured, ABvhAfterItsFirstPicture) {
  Fixture fixture;
  tracer::Snapshot snapshot = fixture.trace();
  snapshot.stage = tracer::Stage::render;
  keep_measured(fixture.work, snapshot);
  EXPECT_FALSE(fixture.work.measures.state().running);
  snapshot.stage = tracer::Stage::refine;
  keep_measured(fixture.work, snapshot);
  EXPECT_TRUE(work_of(fixture.work).measures.running);
  ASSERT_TRUE(fixture.measures_end());
  const auto result = work_of(fixture.work).measures.result;
  EXPECT_EQ(result->bvh, snapshot.bvh);
  EXPECT_TRUE(result->blas_epo && result->tlas_epo && result->sah_test);
}

TEST(KeepMeasured, OnceOnly) {
  Fixture fixture;
  const tracer::Snapshot& snapshot = fixture.trace();
  keep_measured(fixture.work, snapshot);
  ASSERT_TRUE(fixture.measures_end());
  keep_measured(fixture.work, snapshot);
  EXPECT_FALSE(fixture.work.measures.state().running);
}

TEST(KeepMeasured, AnotherTreeReplacesTheMeasures) {
  Fixture fixture;
  keep_measured(fixture.work, fixture.trace());
  fixture.settings.build.builder = "median";
  const auto& second = fixture.trace();
  keep_measured(fixture.work, second);
  EXPECT_FALSE(work_of(fixture.work).measures.result);
  ASSERT_TRUE(fixture.measures_end());
  EXPECT_EQ(work_of(fixture.work).measures.result->bvh, second.bvh);
}

TEST(KeepMeasured, ATreeThatIsGoneIsNotMeasuredAnyMore) {
  Fixture fixture;
  tracer::Snapshot snapshot = fixture.trace();
  keep_measured(fixture.work, snapshot);
  snapshot.bvh = std::make_shared<const tracer::SceneBvh>(*snapshot.bvh);
  snapshot.samples = 0;
  keep_measured(fixture.work, snapshot);
  ASSERT_TRUE(fixture.measures_end());
  EXPECT_TRUE(fixture.work.measures.state().stopped);
}

ui::Requests two_builds() {
  ui::Requests requests;
  requests.compare.emplace(2)[1].builder = "median";
  return requests;
}

TEST(Comparison, OfTheSceneAsItIsSeen) {
  Fixture fixture;
  const tracer::Snapshot& snapshot = fixture.trace();
  carry_out(fixture.work, two_builds(), snapshot);
  EXPECT_TRUE(work_of(fixture.work).comparison.running);
  ASSERT_TRUE(becomes_true([&] { return !fixture.work.comparison.state().running; }));
  const auto rows = work_of(fixture.work).comparison.result;
  ASSERT_EQ(rows->size(), 2u);
  for (const tracer::ComparedBuild& row : *rows) {
    EXPECT_EQ(row.state, tracer::BuildState::done);
    EXPECT_EQ(row.view.camera, snapshot.settings.look->camera);
    EXPECT_EQ(row.view.width, 64);
  }
  const auto primary = (*snapshot.ray_statistics)[0];
  EXPECT_EQ(rows->at(0).nodes_per_ray, primary.nodes.mean);  // the snapshot's own builder
}

TEST(Comparison, IsCancelledAndGivesWayToAnotherScene) {
  Fixture fixture;
  const tracer::Snapshot snapshot = fixture.trace();
  ui::Requests many = two_builds();
  many.compare->resize(500);
  carry_out(fixture.work, many, snapshot);
  tracer::Settings other = fixture.settings;
  other.source.name = "needles";
  drop_stale(fixture.work, snapshot, other);
  ASSERT_TRUE(becomes_true([&] { return !fixture.work.comparison.state().running; }));
  EXPECT_TRUE(fixture.work.comparison.state().stopped);

  carry_out(fixture.work, two_builds(), snapshot);
  tracer::Snapshot another = snapshot;
  another.scene = std::make_shared<const tracer::Scene>(*snapshot.scene);
  drop_stale(fixture.work, another, fixture.settings);
  EXPECT_FALSE(fixture.work.comparison.state().running);
  EXPECT_FALSE(fixture.work.comparison.state().result);
}

TEST(Checks, AreOfThePresentTree) {
  Fixture fixture;
  const tracer::Snapshot& snapshot = fixture.trace();
  ui::Requests requests;
  requests.check_trees = true;
  carry_out(fixture.work, requests, snapshot);
  ASSERT_TRUE(becomes_true([&] { return !fixture.work.checks.state().running; }));
  const auto checked = work_of(fixture.work).checks.result;
  EXPECT_EQ(checked->bvh, snapshot.bvh);
  EXPECT_TRUE(checked->validation.findings.empty());
  EXPECT_GT(checked->validation.rays_checked, 0u);
}

TEST(StartTimeline, MeasuresThePresentSettings) {
  Fixture fixture;
  fixture.settings.deformer = {"twist", 0.5f, "y", 0.5f};
  const tracer::Snapshot& snapshot = fixture.trace();
  tracer::TimelineOptions options;
  options.to = 2;
  options.width = 32;
  options.height = 24;
  start_timeline(fixture.work, snapshot, fixture.settings, options);
  EXPECT_TRUE(work_of(fixture.work).timeline.running);
  ASSERT_TRUE(becomes_true([&] { return !fixture.work.timeline.state().running; }));
  const ui::Work work = work_of(fixture.work);
  EXPECT_EQ(work.timeline.error, "");
  ASSERT_TRUE(work.timeline.result);
  EXPECT_EQ(work.timeline.result->curves[2].samples.size(), 3u);
  EXPECT_EQ(work.timeline_of->deformer, fixture.settings.deformer);
}

TEST(StartTimeline, CancelKeepsWhatWasMeasured) {
  Fixture fixture;
  fixture.settings.deformer = {"twist", 0.5f, "y", 0.5f};
  const tracer::Snapshot& snapshot = fixture.trace();
  tracer::TimelineOptions options;
  options.to = 1999;
  start_timeline(fixture.work, snapshot, fixture.settings, options);
  ASSERT_TRUE(becomes_true([&] { return fixture.work.timeline.state().result != nullptr; }));
  fixture.work.timeline.cancel();
  ASSERT_TRUE(becomes_true([&] { return !fixture.work.timeline.state().running; }));
  const auto state = work_of(fixture.work).timeline;
  EXPECT_TRUE(state.stopped);
  EXPECT_FALSE(state.result->curves[0].samples.empty());
}

TEST(KeepInspected, LaysOutTheIcicleThatAPanelAsksFor) {
  Fixture fixture;
  const tracer::Snapshot& snapshot = fixture.trace();
  ui::Requests requests;
  requests.inspect = requests.count_visits = true;
  requests.icicle = tracer::IcicleOptions{};
  const auto icicle = [&] {
    EXPECT_TRUE(becomes_true([&] {
      keep_inspected(fixture.work, requests, snapshot);
      const ui::Work work = work_of(fixture.work);
      return work.icicle.result && !work.icicle.running && !work.visits.running &&
             work.icicle.result->options == *requests.icicle;
    }));
    return work_of(fixture.work).icicle.result;
  };
  const auto first = icicle();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->inspection->bvh, snapshot.bvh);
  EXPECT_FALSE(first->levels.empty());
  keep_inspected(fixture.work, requests, snapshot);
  EXPECT_FALSE(work_of(fixture.work).icicle.running) << "once only";
  requests.icicle->width = "visits";
  const auto second = icicle();
  EXPECT_NE(second, first);
  EXPECT_TRUE(second && second->has_width);
}

}  // namespace
}  // namespace app
