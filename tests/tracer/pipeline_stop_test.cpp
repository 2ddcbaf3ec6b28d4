// A pipeline that is stopped: what was finished is kept, what was not stays owed.
#include <gtest/gtest.h>

#include "tracer/pipeline.h"

namespace tracer {
namespace {

Settings small_picture(const char* scene) {
  Settings settings;
  settings.source = parse_scene_source(scene);
  settings.render.width = 40;
  settings.render.height = 30;
  settings.render.samples = 2;
  return settings;
}

constexpr const char* large_scene = "terrain:triangles=200000";

void run(Pipeline& pipeline, const Settings& settings) {
  pipeline.run(settings, {}, {});
}

// Runs until the stage begins.
void run_until(Pipeline& pipeline, const Settings& settings, Stage stage) {
  std::stop_source stop;
  pipeline.run(settings, stop.get_token(), [&](const std::shared_ptr<const Snapshot>& snapshot) {
    if (snapshot->stage == stage) stop.request_stop();
  });
  ASSERT_TRUE(pipeline.snapshot()->stopped);
  ASSERT_EQ(pipeline.snapshot()->stage, stage);
}

int runs(const Pipeline& pipeline, Stage stage) {
  return pipeline.snapshot()->stage_runs[static_cast<size_t>(stage)];
}

TEST(StoppedPipeline, ABuildGoesOnWithTheSceneThatWasLoaded) {
  Pipeline pipeline;
  run_until(pipeline, small_picture(large_scene), Stage::build);
  EXPECT_FALSE(pipeline.snapshot()->scene);
  run(pipeline, small_picture(large_scene));
  EXPECT_EQ(pipeline.snapshot()->stage, Stage::none);
  EXPECT_EQ(pipeline.snapshot()->samples, 2);
  EXPECT_EQ(runs(pipeline, Stage::load), 1);
  EXPECT_EQ(runs(pipeline, Stage::build), 2);
}

TEST(StoppedPipeline, AnotherSceneCanFollowTheFirstOnesStoppedBuild) {
  Pipeline pipeline;
  run_until(pipeline, small_picture(large_scene), Stage::build);
  run(pipeline, small_picture("teapots"));
  EXPECT_EQ(pipeline.snapshot()->stage, Stage::none);
  EXPECT_EQ(pipeline.snapshot()->scene_generation, 1u);
  EXPECT_EQ(pipeline.snapshot()->settings.source.name, "teapots");
}

TEST(StoppedPipeline, GoingBackFromAStoppedBuildRunsNothing) {
  Pipeline pipeline;
  run(pipeline, small_picture("teapots"));
  const Settings shown = pipeline.snapshot()->settings;
  Settings other = small_picture(large_scene);
  run_until(pipeline, other, Stage::build);
  EXPECT_EQ(pipeline.snapshot()->settings.source.name, "teapots");
  run(pipeline, shown);
  EXPECT_EQ(pipeline.snapshot()->stage, Stage::none);
  EXPECT_FALSE(pipeline.snapshot()->stopped);
  EXPECT_EQ(pipeline.snapshot()->scene_generation, 1u);
  EXPECT_EQ(runs(pipeline, Stage::build), 2);
}

TEST(StoppedPipeline, ABuildThatIsStoppedDoesNotHideARenderThatIsOwed) {
  Pipeline pipeline;
  run(pipeline, small_picture("teapots"));
  Settings brighter = pipeline.snapshot()->settings;
  brighter.look->ambient = vec3(3.0f);
  brighter.render.samples = max_samples;
  run_until(pipeline, brighter, Stage::refine);
  brighter.render.samples = 3;
  Settings rebuilt = brighter;
  rebuilt.build.max_leaf_size = 1;
  run_until(pipeline, rebuilt, Stage::build);
  run(pipeline, brighter);
  EXPECT_EQ(pipeline.snapshot()->stage, Stage::none);
  EXPECT_EQ(pipeline.snapshot()->samples, 3);
}

}  // namespace
}  // namespace tracer
