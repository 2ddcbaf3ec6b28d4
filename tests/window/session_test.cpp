// The session thread: newest settings win, stopped work stays owed, the window is never kept.
#include "app/window/session.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <mutex>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/window/wait.h"

namespace app {
namespace {

using namespace std::chrono_literals;
using tracer::Settings;
using tracer::Snapshot;
using tracer::Stage;

Settings small_picture(const char* scene = "teapots") {
  Settings settings;
  settings.source = tracer::parse_scene_source(scene);
  settings.render.width = 96;
  settings.render.height = 64;
  settings.render.samples = 2;
  return settings;
}

// Goes on until it is stopped.
Settings endless_picture() {
  Settings settings = small_picture();
  settings.render.samples = tracer::max_samples;
  return settings;
}

int runs(const Snapshot& snapshot, Stage stage) {
  return snapshot.stage_runs[static_cast<size_t>(stage)];
}

bool is_idle_after(Session& session) {
  return becomes_true([&] { return !session.busy(); });
}

bool reaches(Session& session, Stage stage) {
  return becomes_true([&] { return session.busy() && session.snapshot()->stage == stage; });
}

void wake_nobody() {}

TEST(Session, HasAnEmptySnapshotBeforeTheFirstJob) {
  const Session session(wake_nobody);
  EXPECT_FALSE(session.busy());
  ASSERT_TRUE(session.snapshot());
  EXPECT_FALSE(session.snapshot()->scene);
}

TEST(Session, CompletesThePicture) {
  Session session(wake_nobody);
  session.submit(small_picture());
  EXPECT_TRUE(session.busy());
  ASSERT_TRUE(is_idle_after(session));
  const auto snapshot = session.snapshot();
  EXPECT_EQ(snapshot->stage, Stage::none);
  EXPECT_EQ(snapshot->samples, 2);
  EXPECT_EQ(snapshot->film.width, 96);
  EXPECT_EQ(snapshot->error, "");
}

TEST(Session, TheNewestSettingsWin) {
  Session session(wake_nobody);
  Settings settings = small_picture();
  for (int width = 10; width <= 60; ++width) {
    settings.render.width = width;
    session.submit(settings);
  }
  ASSERT_TRUE(is_idle_after(session));
  EXPECT_EQ(session.snapshot()->film.width, 60);
  EXPECT_EQ(session.snapshot()->stage, Stage::none);
  EXPECT_LT(runs(*session.snapshot(), Stage::render), 51);
  EXPECT_EQ(session.snapshot()->scene_generation, 1u);
}

TEST(Session, AnEditOfTheLookBuildsNothing) {
  Session session(wake_nobody);
  session.submit(small_picture());
  ASSERT_TRUE(is_idle_after(session));
  Settings edited = session.snapshot()->settings;
  edited.look->ambient = tracer::vec3(0.5f);
  session.submit(edited);
  ASSERT_TRUE(is_idle_after(session));
  const auto snapshot = session.snapshot();
  EXPECT_EQ(snapshot->settings.look->ambient, tracer::vec3(0.5f));
  EXPECT_EQ(runs(*snapshot, Stage::load), 1);
  EXPECT_EQ(runs(*snapshot, Stage::build), 1);
  EXPECT_EQ(snapshot->render_generation, 2u);
}

TEST(Session, MoreSamplesGoOnWithTheFilm) {
  Session session(wake_nobody);
  session.submit(small_picture());
  ASSERT_TRUE(is_idle_after(session));
  Settings more = session.snapshot()->settings;
  more.render.samples = 5;
  session.submit(more);
  ASSERT_TRUE(is_idle_after(session));
  EXPECT_EQ(session.snapshot()->samples, 5);
  EXPECT_EQ(session.snapshot()->render_generation, 1u);
}

TEST(Session, AnEditStopsAnEndlessRefinement) {
  Session session(wake_nobody);
  session.submit(endless_picture());
  ASSERT_TRUE(reaches(session, Stage::refine));
  session.submit(small_picture("showcase"));
  ASSERT_TRUE(is_idle_after(session));
  EXPECT_EQ(session.snapshot()->settings.source.name, "showcase");
  EXPECT_EQ(session.snapshot()->stage, Stage::none);
}

TEST(Session, ALookEditedDuringABuildDoesNotThrowTheBuildAway) {
  Session session(wake_nobody);
  Settings settings = small_picture("terrain:triangles=400000");
  session.submit(settings);
  ASSERT_TRUE(reaches(session, Stage::build));
  settings.render.ray_depth = 1;
  session.submit(settings);
  ASSERT_TRUE(is_idle_after(session));
  EXPECT_EQ(runs(*session.snapshot(), Stage::load), 1);
  EXPECT_EQ(runs(*session.snapshot(), Stage::build), 1);
  EXPECT_EQ(session.snapshot()->settings.render.ray_depth, 1);
}

// Each moment takes longer to build than the next one takes to come.
TEST(Session, WhileTheTimeRunsBuiltMomentsAreShown) {
  Session session(wake_nobody);
  Settings settings = small_picture("terrain:triangles=200000");
  settings.deformer = {"wave", 0.1f, "x", 0.5f};
  settings.update.strategy = "rebuild";
  session.submit(settings);
  ASSERT_TRUE(is_idle_after(session));
  const uint64_t before = session.snapshot()->render_generation;
  for (int i = 0; i < 10'000 && session.snapshot()->render_generation < before + 2; ++i) {
    settings.time += 0.01f;
    session.submit(settings);
    std::this_thread::sleep_for(2ms);
  }
  EXPECT_GE(session.snapshot()->render_generation, before + 2);
  settings.build.builder = "lbvh";
  session.submit(settings);
  ASSERT_TRUE(is_idle_after(session));
  EXPECT_EQ(session.snapshot()->settings.time, settings.time);
}

TEST(Session, ANewSceneStopsABuild) {
  Session session(wake_nobody);
  session.submit(small_picture("terrain:triangles=3000000"));
  ASSERT_TRUE(reaches(session, Stage::build));
  session.submit(small_picture());
  ASSERT_TRUE(is_idle_after(session));
  EXPECT_EQ(session.snapshot()->settings.source.name, "teapots");
  EXPECT_EQ(session.snapshot()->scene_generation, 1u);  // the terrain never became the scene
}

TEST(Session, WhatWasCancelledStaysOwed) {
  Session session(wake_nobody);
  session.submit(endless_picture());
  ASSERT_TRUE(reaches(session, Stage::refine));
  session.cancel();
  ASSERT_TRUE(is_idle_after(session));
  const auto stopped = session.snapshot();
  EXPECT_TRUE(stopped->stopped);
  EXPECT_EQ(stopped->stage, Stage::refine);
  Settings more = stopped->settings;
  session.submit(more);
  ASSERT_TRUE(becomes_true([&] { return session.snapshot()->samples > stopped->samples; }));
  EXPECT_EQ(session.snapshot()->render_generation, stopped->render_generation);
}

TEST(Session, CancelForgetsWhatWaits) {
  Session session(wake_nobody);
  session.submit(endless_picture());
  ASSERT_TRUE(reaches(session, Stage::refine));
  session.submit(small_picture("showcase"));
  session.cancel();
  ASSERT_TRUE(is_idle_after(session));
  // Either the cancel came first, or the showcase's job had begun and was stopped.
  EXPECT_TRUE(session.snapshot()->stopped);
}

TEST(Session, CancellingTakesLittleTime) {
  Session session(wake_nobody);
  Settings large = endless_picture();
  large.render.width = 1280;
  large.render.height = 720;
  session.submit(large);
  ASSERT_TRUE(reaches(session, Stage::refine));
  const auto began = std::chrono::steady_clock::now();
  session.cancel();
  EXPECT_LT(std::chrono::steady_clock::now() - began, 50ms);  // the caller is not kept
  ASSERT_TRUE(is_idle_after(session));
  EXPECT_LT(std::chrono::steady_clock::now() - began, 2s);
}

TEST(Session, AnUnknownSceneIsAnErrorAndKeepsTheLastOne) {
  Session session(wake_nobody);
  session.submit(small_picture());
  ASSERT_TRUE(is_idle_after(session));
  session.submit(small_picture("no-such-scene"));
  ASSERT_TRUE(is_idle_after(session));
  EXPECT_NE(session.snapshot()->error, "");
  EXPECT_EQ(session.snapshot()->settings.source.name, "teapots");
  ASSERT_TRUE(session.snapshot()->scene);
}

TEST(Session, WakesForEverySnapshotAndTheyNeverGoBack) {
  std::mutex mutex;
  std::vector<std::shared_ptr<const Snapshot>> seen;
  Session* session_seen = nullptr;
  Session session([&] {
    const std::lock_guard lock(mutex);
    if (session_seen != nullptr) seen.push_back(session_seen->snapshot());
  });
  {
    const std::lock_guard lock(mutex);
    session_seen = &session;
  }
  for (int depth = 0; depth < 5; ++depth) {
    Settings settings = small_picture();
    settings.render.ray_depth = depth;
    session.submit(settings);
    std::this_thread::sleep_for(5ms);
  }
  ASSERT_TRUE(is_idle_after(session));
  const std::lock_guard lock(mutex);
  ASSERT_FALSE(seen.empty());
  for (size_t i = 1; i < seen.size(); ++i) {
    EXPECT_GE(seen[i]->scene_generation, seen[i - 1]->scene_generation);
    EXPECT_GE(seen[i]->render_generation, seen[i - 1]->render_generation);
  }
}

TEST(Session, CanBeDestroyedAtAnyMoment) {
  for (const auto delay : {0ms, 1ms, 3ms, 10ms, 30ms, 100ms}) {
    Session session(wake_nobody);
    session.submit(small_picture("terrain:triangles=1000000"));
    std::this_thread::sleep_for(delay);
  }
}

TEST(Session, LowersItsOwnThreadsAndNotTheCaller) {
  const int before = getpriority(PRIO_PROCESS, 0);
  Session session(wake_nobody);
  session.submit(endless_picture());
  ASSERT_TRUE(reaches(session, Stage::refine));
  EXPECT_EQ(getpriority(PRIO_PROCESS, 0), before);
  int lowered = 0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    const int thread = std::stoi(task.path().filename().string());
    if (getpriority(PRIO_PROCESS, id_t(thread)) > before) ++lowered;
  }
  EXPECT_GE(lowered, 1);
}

}  // namespace
}  // namespace app
