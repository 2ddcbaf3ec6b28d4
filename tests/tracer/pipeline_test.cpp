// What an edit makes stale, what runs then, and what is kept when something fails.
#include "tracer/pipeline.h"

#include <fstream>
#include <mutex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "temporary_folder.h"
#include "tracer/memory.h"
#include "tracer/render/colorize.h"
#include "tracer/render/trace_film.h"

namespace tracer::test {
namespace {

struct Edit {
  const char* name;
  void (*apply)(Settings&);
  Stage expected;
};

Settings with_look() {
  Settings settings;
  settings.look = Look{};
  settings.look->materials.resize(1);
  settings.look->lights.resize(1);
  return settings;
}

class FirstStale : public testing::TestWithParam<Edit> {};

TEST_P(FirstStale, Table) {
  const Settings was = with_look();
  Settings now = was;
  GetParam().apply(now);
  EXPECT_EQ(first_stale(was, now), GetParam().expected);
}

constexpr Edit edits[] = {
    {"nothing", [](Settings&) {}, Stage::none},
    {"file", [](Settings& s) { s.source.name = "other.obj"; }, Stage::load},
    {"parameter",
     [](Settings& s) {
       s.source.parameters = {{"triangles", 7}};
     },
     Stage::load},
    {"sky_file", [](Settings& s) { s.source.sky_file = "sky.hdr"; }, Stage::load},
    {"revision", [](Settings& s) { ++s.source.revision; }, Stage::load},
    {"builder", [](Settings& s) { s.build.builder = "other"; }, Stage::build},
    {"bins", [](Settings& s) { s.build.bins = 8; }, Stage::build},
    {"traversal_cost", [](Settings& s) { s.build.traversal_cost = 2; }, Stage::build},
    {"layout", [](Settings& s) { s.build.layout = "wide8"; }, Stage::build},
    {"rebraid", [](Settings& s) { s.build.rebraid = true; }, Stage::top_level},
    {"time", [](Settings& s) { s.time = 1; }, Stage::top_level},
    {"motion", [](Settings& s) { s.motion.kind = "spin"; }, Stage::top_level},
    {"deformer", [](Settings& s) { s.deformer.kind = "twist"; }, Stage::refit},
    {"deformer_rebuilt",
     [](Settings& s) {
       s.deformer.kind = "twist";
       s.update.strategy = "rebuild";
     },
     Stage::build},
    {"no_amount",
     [](Settings& s) {
       s.deformer.kind = "twist";
       s.deformer.amount = 0;
     },
     Stage::none},
    {"update_of_nothing", [](Settings& s) { s.update.strategy = "rebuild"; }, Stage::none},
    {"material", [](Settings& s) { s.look->materials[0].reflectivity = 1; }, Stage::render},
    {"light", [](Settings& s) { s.look->lights[0].position.x = 1; }, Stage::render},
    {"new_light", [](Settings& s) { s.look->lights.push_back({}); }, Stage::render},
    {"ambient", [](Settings& s) { s.look->ambient.x = 1; }, Stage::render},
    {"sky", [](Settings& s) { s.look->sky.rotation_degrees = 90; }, Stage::render},
    {"camera", [](Settings& s) { s.look->camera.eye.x = 9; }, Stage::render},
    {"depth", [](Settings& s) { s.render.ray_depth = 1; }, Stage::render},
    {"shadows", [](Settings& s) { s.render.shadows = false; }, Stage::render},
    {"kernel", [](Settings& s) { s.render.kernels[1] = "packet"; }, Stage::render},
    {"fast", [](Settings& s) { s.render.fast = true; }, Stage::render},
    {"size", [](Settings& s) { s.render.width = 99; }, Stage::render},
    {"fewer_samples", [](Settings& s) { s.render.samples = 1; }, Stage::render},
    {"more_samples", [](Settings& s) { s.render.samples = 99; }, Stage::refine},
    {"file_and_light",
     [](Settings& s) {
       s.look->lights.clear();
       s.source.name = "other.obj";
     },
     Stage::load},
};
INSTANTIATE_TEST_SUITE_P(Edits, FirstStale, testing::ValuesIn(edits),
                         [](const auto& info) { return std::string(info.param.name); });

Settings twisted() {
  Settings settings = with_look();
  settings.deformer.kind = "twist";
  return settings;
}

TEST(FirstStaleOfADeformedScene, FollowsTheStrategy) {
  const Settings was = twisted();
  Settings now = was;
  now.time = 1.0f;
  EXPECT_EQ(first_stale(was, now), Stage::refit);
  for (const char* strategy : {"every", "growth"}) {
    now.update.strategy = strategy;
    EXPECT_EQ(first_stale(was, now), Stage::refit) << strategy;
  }
  now.update.strategy = "rebuild";
  EXPECT_EQ(first_stale(was, now), Stage::build);
  now.build.bins = 8;
  now.update.strategy = "refit";
  EXPECT_EQ(first_stale(was, now), Stage::build);
}

TEST(FirstStaleOfADeformedScene, AHeldShapeOnlyMovesItsInstances) {
  Settings was = twisted();
  was.deformer.speed = 0.0f;
  Settings now = was;
  now.time = 1.0f;
  EXPECT_EQ(first_stale(was, now), Stage::top_level);
  now.deformer.amount = 1.0f;
  EXPECT_EQ(first_stale(was, now), Stage::refit);
}

TEST(FirstStaleOfADeformedScene, BackToRestIsARefit) {
  const Settings was = twisted();
  Settings now = was;
  now.deformer.kind = "none";
  EXPECT_EQ(first_stale(was, now), Stage::refit);
}

class PipelineTest : public testing::Test {
 protected:
  PipelineTest() {
    settings.source = parse_scene_source("teapots:detail=2");
    settings.render = {.width = 100, .height = 70, .ray_depth = 3, .samples = 3};
  }

  const Snapshot& run() {
    pipeline.run(settings, {}, [&](std::shared_ptr<const Snapshot> published) {
      const std::lock_guard lock(mutex);
      snapshots.push_back(std::move(published));
    });
    return *pipeline.snapshot();
  }
  int runs(Stage stage) const {
    return pipeline.snapshot()->stage_runs[static_cast<size_t>(stage)];
  }

  Pipeline pipeline;
  Settings settings;
  std::mutex mutex;
  std::vector<std::shared_ptr<const Snapshot>> snapshots;
};

TEST_F(PipelineTest, RunsEveryStageOnce) {
  const Snapshot& snapshot = run();
  EXPECT_EQ(snapshot.error, "");
  EXPECT_THAT(snapshot.stage_runs, testing::ElementsAre(1, 1, 0, 0, 1, 1));
  EXPECT_EQ(snapshot.stage, Stage::none);
  EXPECT_EQ(snapshot.samples, 3);
  for (const auto& tile : snapshot.film.tiles) {
    ASSERT_TRUE(tile);
    EXPECT_EQ(tile->facts->stride, 1);
    EXPECT_EQ(tile->samples, 3);
  }
  EXPECT_GT(snapshot.rates[0].rays, 0u);
  ASSERT_TRUE(snapshot.ray_statistics);
  EXPECT_EQ((*snapshot.ray_statistics)[0].count, 7000u);
  EXPECT_GT(snapshot.first_picture_ms, 0.0);
}

TEST_F(PipelineTest, NoEditRunsNothing) {
  run();
  const auto before = pipeline.snapshot()->stage_runs;
  run();
  EXPECT_EQ(pipeline.snapshot()->stage_runs, before);
}

TEST_F(PipelineTest, EditsOfTheLookBuildNothing) {
  settings = run().settings;
  const auto bvh = pipeline.snapshot()->bvh;
  for (const auto& edit : edits) {
    if (edit.expected != Stage::render) continue;
    edit.apply(settings);
    run();
  }
  EXPECT_EQ(runs(Stage::load), 1);
  EXPECT_EQ(runs(Stage::build), 1);
  EXPECT_EQ(runs(Stage::top_level), 0);
  EXPECT_GT(runs(Stage::render), 5);
  EXPECT_EQ(pipeline.snapshot()->bvh, bvh);
}

TEST_F(PipelineTest, MovingInstancesKeepsEveryBlas) {
  settings = run().settings;
  const auto before = pipeline.snapshot();
  settings.time = 0.7f;
  run();
  EXPECT_EQ(runs(Stage::build), 1);
  EXPECT_EQ(runs(Stage::top_level), 1);
  const auto after = pipeline.snapshot();
  EXPECT_EQ(before->bvh->blases, after->bvh->blases);
  EXPECT_NE(before->bvh->instances[0].to_world, after->bvh->instances[0].to_world);
}

TEST_F(PipelineTest, ADeformedFrameRefitsAndComesBackToRest) {
  settings = run().settings;
  const auto rest = pipeline.snapshot();
  settings.deformer = {"twist", 1.0f, "y", 0.25f};
  settings.time = 1.0f;
  run();
  const auto bent = pipeline.snapshot();
  EXPECT_EQ(runs(Stage::build), 1);
  EXPECT_EQ(runs(Stage::refit), 1);
  EXPECT_TRUE(bent->update.refitted);
  EXPECT_EQ(bent->update.built_time, -1.0f);
  EXPECT_NE(bent->scene, rest->scene);
  EXPECT_NE(bent->bvh->blases, rest->bvh->blases);
  EXPECT_GT(bent->growth.max, 1.0);
  EXPECT_GT(bent->blas_statistics->sah, rest->blas_statistics->sah);
  EXPECT_EQ(bent->scene_generation, rest->scene_generation);
  settings.deformer.kind = "none";
  run();
  EXPECT_EQ(pipeline.snapshot()->scene, rest->scene);
  EXPECT_EQ(pipeline.snapshot()->bvh->blases, rest->bvh->blases);
  EXPECT_EQ(pipeline.snapshot()->growth.max, 1.0);
}

TEST_F(PipelineTest, TheWayToAMomentDoesNotMatter) {
  settings.deformer = {"bend", 0.5f, "x", 0.5f};
  settings.render.samples = 1;
  for (const UpdateRow& row : updates()) {
    settings.update = {std::string(row.id), 4, 1.1f, 10.0f};
    settings.look.reset();
    settings.time = 1.7f;
    Pipeline straight;
    straight.run(settings, {}, {});
    Pipeline winding;
    for (const float time : {0.0f, 3.1f, 0.9f, 1.6f, 1.7f}) {
      settings.time = time;
      settings.look = straight.snapshot()->settings.look;
      winding.run(settings, {}, {});
    }
    const Snapshot& a = *straight.snapshot();
    const Snapshot& b = *winding.snapshot();
    EXPECT_EQ(a.blas_statistics->sah, b.blas_statistics->sah) << row.id;
    EXPECT_EQ(a.update.built_time, b.update.built_time) << row.id;
    ViewOptions view;
    view.view = "counter";
    EXPECT_EQ(colorize(a, view).image.pixels, colorize(b, view).image.pixels) << row.id;
  }
}

TEST_F(PipelineTest, RebuildingBuildsOverTheShape) {
  settings.deformer = {"twist", 1.0f, "y", 0.0f};
  settings.update.strategy = "rebuild";
  const double rebuilt = run().blas_statistics->sah;
  EXPECT_FALSE(pipeline.snapshot()->update.refitted);
  settings.look = pipeline.snapshot()->settings.look;
  settings.update.strategy = "refit";
  EXPECT_GT(run().blas_statistics->sah, rebuilt);
  EXPECT_EQ(runs(Stage::build), 1);
  EXPECT_EQ(runs(Stage::refit), 1);
}

TEST_F(PipelineTest, OtherBuildOptionsBuildTheDeformedSceneAnew) {
  settings.deformer = {"twist", 1.0f, "y", 0.0f};
  settings = run().settings;
  settings.build.builder = "lbvh";
  run();
  Pipeline other;
  other.run(settings, {}, {});
  EXPECT_EQ(pipeline.snapshot()->blas_statistics->sah, other.snapshot()->blas_statistics->sah);
}

TEST_F(PipelineTest, NumbersOutsideTheirLimitsAreMended) {
  settings.deformer = {"twist", std::numeric_limits<float>::quiet_NaN(), "w", -1.0f};
  settings.update = {"magic", 0, 0.0f, 0.0f};
  settings.motion = {"magic", -1.0f};
  EXPECT_EQ(run().error, "");
  settings.look = pipeline.snapshot()->settings.look;
  settings.deformer.amount = 1e9f;
  EXPECT_EQ(run().error, "");
  EXPECT_EQ(pipeline.snapshot()->settings.deformer.amount, max_amount);
}

TEST_F(PipelineTest, MoreSamplesGoOn) {
  settings = run().settings;
  settings.render.samples = 5;
  run();
  EXPECT_EQ(runs(Stage::render), 1);
  EXPECT_EQ(pipeline.snapshot()->samples, 5);
}

TEST_F(PipelineTest, TheCoarsePictureComesFirst) {
  settings.render = {.width = 640, .height = 360, .ray_depth = 3, .samples = 2};
  run();
  std::vector<int> complete;
  for (const auto& snapshot : snapshots) {
    int stride = 0;
    for (const auto& tile : snapshot->film.tiles) {
      stride = std::max(stride, tile ? tile->facts->stride : 99);
    }
    if (!snapshot->film.tiles.empty()) complete.push_back(stride);
  }
  ASSERT_FALSE(complete.empty());
  EXPECT_EQ(complete.front(), 8);
  EXPECT_EQ(complete.back(), 1);
  EXPECT_TRUE(std::is_sorted(complete.rbegin(), complete.rend()));
}

TEST_F(PipelineTest, PassZeroIsTheSameThroughAllStrides) {
  const Snapshot& snapshot = run();
  Whitted whitted;
  const World world{*snapshot.scene, *snapshot.bvh, *snapshot.settings.look,
                    snapshot.settings.render};
  const CameraFrame view = frame(snapshot.settings.look->camera, 100, 70);
  for (const ivec2 at : {ivec2(0, 0), ivec2(63, 5), ivec2(64, 69), ivec2(99, 69), ivec2(50, 33)}) {
    const vec2 point[] = {vec2(at) + 0.5f};
    whitted.trace(world, view, point, true);
    const PixelFacts facts = pixel(snapshot.film, at.x, at.y);
    ASSERT_TRUE(facts.hit);
    EXPECT_EQ(*facts.hit, whitted.hits()[0]);
    EXPECT_EQ(*facts.counters, whitted.counters()[0]);
  }
}

TEST_F(PipelineTest, SameBytesForAnyNumberOfThreads) {
  std::vector<uint32_t> first;
  for (const size_t threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Pipeline other;
    other.run(settings, {}, {});
    const Picture picture = colorize(*other.snapshot(), {});
    if (threads == 1) first = picture.image.pixels;
    EXPECT_EQ(picture.image.pixels, first) << threads << " threads";
  }
}

TEST_F(PipelineTest, AFailedLoadKeepsTheSceneAndGoesOn) {
  settings = run().settings;
  const auto scene = pipeline.snapshot()->scene;
  settings.source.name = "missing.obj";
  EXPECT_THAT(run().error, testing::HasSubstr("missing.obj"));
  EXPECT_EQ(pipeline.snapshot()->scene, scene);
  EXPECT_EQ(pipeline.snapshot()->settings.source, parse_scene_source("teapots:detail=2"));

  const int loads = runs(Stage::load);
  settings.look->ambient = vec3(1.0f);
  run();
  EXPECT_EQ(runs(Stage::load), loads) << "what failed is not tried again";
  EXPECT_EQ(runs(Stage::render), 2);
  EXPECT_THAT(pipeline.snapshot()->error, testing::HasSubstr("missing.obj"));

  settings.source = parse_scene_source("showcase");
  settings.look.reset();
  EXPECT_EQ(run().error, "");
  EXPECT_NE(pipeline.snapshot()->scene, scene);
}

TEST_F(PipelineTest, NothingToShowIsRetriedOnlyWhenAsked) {
  const TemporaryFolder folder;
  const std::string file = (folder.path / "late.obj").string();
  settings.source = parse_scene_source(file);
  EXPECT_THAT(run().error, testing::HasSubstr("late.obj"));
  EXPECT_FALSE(pipeline.snapshot()->scene);
  run();
  EXPECT_EQ(runs(Stage::load), 1);
  std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  ++settings.source.revision;
  EXPECT_EQ(run().error, "");
  ASSERT_TRUE(pipeline.snapshot()->scene);
  EXPECT_EQ(pipeline.snapshot()->scene->meshes[0].triangles.size(), 1u);
}

TEST_F(PipelineTest, ABadBuilderKeepsTheTree) {
  settings = run().settings;
  const auto bvh = pipeline.snapshot()->bvh;
  settings.build.builder = "magic";
  EXPECT_THAT(run().error, testing::HasSubstr("magic"));
  EXPECT_EQ(pipeline.snapshot()->bvh, bvh);
  settings.build.builder = "binned";
  settings.build.bins = 8;
  EXPECT_EQ(run().error, "");
  EXPECT_NE(pipeline.snapshot()->bvh, bvh);
}

TEST_F(PipelineTest, APictureThatDoesNotFitIntoMemory) {
  settings = run().settings;
  settings.render.width = settings.render.height = 16384;
  const Snapshot& snapshot = run();
  if (film_bytes(16384, 16384) > memory_available() / 2) {
    EXPECT_THAT(snapshot.error, testing::HasSubstr("16384 x 16384"));
    EXPECT_EQ(snapshot.film.width, 100);
  }
}

TEST_F(PipelineTest, AStopWhileDraggingStillShowsACoarsePicture) {
  run();
  settings.look = pipeline.snapshot()->settings.look;
  settings.look->camera.eye.x += 1.0f;
  std::stop_source stop;
  stop.request_stop();
  // Asked to stop as soon as the render stage has begun.
  std::stop_source later;
  pipeline.run(settings, later.get_token(), [&](const std::shared_ptr<const Snapshot>& published) {
    if (published->stage == Stage::render) later.request_stop();
  });
  EXPECT_EQ(pipeline.snapshot()->settings.look->camera, settings.look->camera);
  EXPECT_TRUE(pipeline.snapshot()->film.tiles[0]);
}

}  // namespace
}  // namespace tracer::test
