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

}  // namespace
}  // namespace app
