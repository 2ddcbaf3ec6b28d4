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

bool logging_ends(Fixture& fixture) {
  return becomes_true([&] { return !fixture.work.rays.state().running; });
}

ui::Requests for_pixel(int x, int y) {
  ui::Requests requests;
  requests.log_rays = ui::RayRequest{{x, y}, nullptr};
  return requests;
}

TEST(KeepLogged, ThePixelsRaysOnceForEachFilm) {
  Fixture fixture;
  tracer::Snapshot snapshot = fixture.trace();
  keep_logged(fixture.work, {}, snapshot);
  EXPECT_FALSE(fixture.work.rays.state().running);
  keep_logged(fixture.work, for_pixel(30, 20), snapshot);
  ASSERT_TRUE(logging_ends(fixture));
  const auto first = work_of(fixture.work).rays.result;
  ASSERT_TRUE(first && first->log);
  EXPECT_EQ(first->log->bvh, snapshot.bvh);
  EXPECT_EQ(first->log->rays[0].cast.hit, *tracer::pixel(snapshot.film, 30, 20).hit);
  keep_logged(fixture.work, for_pixel(30, 20), snapshot);
  EXPECT_FALSE(fixture.work.rays.state().running);
  ++snapshot.render_generation;
  keep_logged(fixture.work, for_pixel(30, 20), snapshot);
  EXPECT_TRUE(work_of(fixture.work).rays.result) << "the older one stays until then";
  ASSERT_TRUE(logging_ends(fixture));
  EXPECT_NE(work_of(fixture.work).rays.result, first);
}

TEST(KeepLogged, TheSameRaysInAnotherTree) {
  Fixture fixture;
  keep_logged(fixture.work, for_pixel(30, 20), fixture.trace());
  ASSERT_TRUE(logging_ends(fixture));
  const auto before = work_of(fixture.work).rays.result->log;
  fixture.settings.build.builder = "median";
  const tracer::Snapshot& second = fixture.trace();
  ui::Requests again;
  again.log_rays = ui::RayRequest{before->pixel, before};
  keep_logged(fixture.work, again, second);
  ASSERT_TRUE(logging_ends(fixture));
  const auto now = work_of(fixture.work).rays.result;
  EXPECT_EQ(now->of.again, before);
  EXPECT_EQ(now->log->bvh, second.bvh);
  EXPECT_EQ(now->log->rays[0].cast.hit, before->rays[0].cast.hit);
}

TEST(KeepLogged, NothingOutsideThePictureAndNoTreeThatIsGone) {
  Fixture fixture;
  tracer::Snapshot snapshot = fixture.trace();
  for (const auto& [x, y] : {std::pair(64, 0), std::pair(0, 48), std::pair(-1, 0)}) {
    keep_logged(fixture.work, for_pixel(x, y), snapshot);
    EXPECT_FALSE(fixture.work.rays.state().running);
  }
  keep_logged(fixture.work, for_pixel(30, 20), snapshot);
  ASSERT_TRUE(logging_ends(fixture));
  keep_logged(fixture.work, {}, snapshot);
  EXPECT_TRUE(work_of(fixture.work).rays.result) << "it may be wanted again";
  snapshot.bvh = std::make_shared<const tracer::SceneBvh>(*snapshot.bvh);
  keep_logged(fixture.work, {}, snapshot);
  EXPECT_FALSE(work_of(fixture.work).rays.result);
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

ui::Requests small_benchmark(bool flatten) {
  ui::Requests requests;
  requests.benchmark.emplace().flatten = flatten;
  tracer::BenchmarkOptions& options = requests.benchmark->options;
  options.layouts = {"wide8"};
  options.classes = {"primary"};
  options.width = options.height = 16;
  options.turns = 1;
  return requests;
}

TEST(Benchmark, OfTheSceneAsItIsSeen) {
  Fixture fixture;
  const tracer::Snapshot& snapshot = fixture.trace();
  std::vector<uint64_t> hits;
  for (const bool flatten : {false, true}) {
    carry_out(fixture.work, small_benchmark(flatten), snapshot);
    ASSERT_TRUE(becomes_true([&] { return !fixture.work.benchmark.state().running; }));
    const auto result = work_of(fixture.work).benchmark.result;
    ASSERT_TRUE(result && result->complete) << fixture.work.benchmark.state().error;
    EXPECT_EQ(result->rays[0].rays, 256u);
    EXPECT_TRUE(result->faults.empty());
    hits.push_back(result->rays[0].hits);
  }
  EXPECT_GT(hits[0], 0u);
  EXPECT_NEAR(double(hits[0]), double(hits[1]), 2.0);
}

TEST(Benchmark, IsCancelledAndGivesWayToAnotherScene) {
  Fixture fixture;
  const tracer::Snapshot snapshot = fixture.trace();
  ui::Requests many = small_benchmark(false);
  many.benchmark->options.turns = tracer::max_turns;
  carry_out(fixture.work, many, snapshot);
  ui::Requests cancel;
  cancel.cancel_benchmark = true;
  carry_out(fixture.work, cancel, snapshot);
  ASSERT_TRUE(becomes_true([&] { return !fixture.work.benchmark.state().running; }));
  EXPECT_TRUE(fixture.work.benchmark.state().stopped);

  tracer::Snapshot another = snapshot;
  another.scene = std::make_shared<const tracer::Scene>(*snapshot.scene);
  drop_stale(fixture.work, another, fixture.settings);
  EXPECT_FALSE(fixture.work.benchmark.state().result);
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

// Once a frame, as the window does, until it is there.
template <class Done>
bool inspected(Fixture& fixture, const ui::Requests& requests, const tracer::Snapshot& snapshot,
               const Done& done) {
  return becomes_true([&] {
    keep_inspected(fixture.work, requests, snapshot);
    return done(work_of(fixture.work));
  });
}

TEST(KeepInspected, LooksAtTheNodeThatIsAskedFor) {
  Fixture fixture;
  const tracer::Snapshot& snapshot = fixture.trace();
  ui::Requests requests;
  requests.inspect = true;
  requests.node_splits = ui::NodePlace{0, 0};
  requests.node_pixels = tracer::Watched{0, 0, tracer::none};
  ASSERT_TRUE(inspected(fixture, requests, snapshot, [](const ui::Work& work) {
    return work.splits.result && work.node_pixels.result && !work.splits.running;
  })) << "the splits wait for the table";
  EXPECT_EQ(work_of(fixture.work).splits.result->bvh, snapshot.bvh);
  EXPECT_EQ(work_of(fixture.work).node_pixels.result->film, snapshot.render_generation);
  requests.node_splits = ui::NodePlace{tracer::none, 0};
  requests.node_pixels->node = 1;
  ASSERT_TRUE(inspected(fixture, requests, snapshot, [](const ui::Work& work) {
    return work.splits.result->mesh == tracer::none &&
           work.node_pixels.result->pixels.node.node == 1;
  }));
}

TEST(KeepInspected, DoesNothingThatNobodyAsksFor) {
  Fixture fixture;
  keep_inspected(fixture.work, {}, fixture.trace());
  const ui::Work work = work_of(fixture.work);
  EXPECT_FALSE(work.inspection.running || work.visits.running || work.node_pixels.running ||
               work.splits.running);
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
