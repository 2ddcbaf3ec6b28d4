// Work beside the session: one at a time, the newest wins, and times are measured in silence.
#include "app/window/background_run.h"

#include <atomic>
#include <filesystem>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/window/wait.h"
#include "tracer/error.h"

namespace app {
namespace {

using namespace std::chrono_literals;
using Publish = BackgroundRun<int>::Publish;
using tracer::Job;

void wake_nobody() {}

struct Fixture {
  Session session{wake_nobody};
  Turns turns{session};
  BackgroundRun<int> run{turns, wake_nobody};

  bool ends() {
    return becomes_true([&] { return !run.state().running; });
  }
};

// Until it is stopped.
int wait_for_stop(const Job& job) {
  while (!job.stopped())
    std::this_thread::sleep_for(1ms);
  return -1;
}

tracer::Settings endless_picture() {
  tracer::Settings settings;
  settings.render.width = 64;
  settings.render.height = 64;
  settings.render.samples = tracer::max_samples;
  return settings;
}

TEST(BackgroundRun, HasNothingAtFirst) {
  Fixture fixture;
  EXPECT_FALSE(fixture.run.state().running);
  EXPECT_FALSE(fixture.run.state().result);
}

TEST(BackgroundRun, GivesTheResult) {
  Fixture fixture;
  fixture.run.start(TurnKind::computes, [](const Job&, const Publish&) { return 7; });
  ASSERT_TRUE(fixture.ends());
  ASSERT_TRUE(fixture.run.state().result);
  EXPECT_EQ(*fixture.run.state().result, 7);
  EXPECT_FALSE(fixture.run.state().stopped);
}

TEST(BackgroundRun, TellsProgressAndPartsBeforeTheEnd) {
  Fixture fixture;
  fixture.run.start(TurnKind::computes, [](const Job& job, const Publish& publish) {
    job.progress(0.5f, "halfway");
    publish(3);
    wait_for_stop(job);
    return 4;
  });
  ASSERT_TRUE(becomes_true([&] { return fixture.run.state().result != nullptr; }));
  EXPECT_EQ(*fixture.run.state().result, 3);
  EXPECT_EQ(fixture.run.state().fraction, 0.5f);
  EXPECT_EQ(fixture.run.state().doing, "halfway");
  EXPECT_TRUE(fixture.run.state().running);
  fixture.run.cancel();
  ASSERT_TRUE(fixture.ends());
  EXPECT_TRUE(fixture.run.state().stopped);
  EXPECT_EQ(*fixture.run.state().result, 4);
}

TEST(BackgroundRun, TheNewestWinsAndTheOldResultIsDropped) {
  Fixture fixture;
  std::atomic<int> began = 0;
  for (int i = 0; i < 20; ++i) {
    fixture.run.start(TurnKind::computes, [i, &began](const Job& job, const Publish&) {
      ++began;
      return i < 19 ? wait_for_stop(job) : i;
    });
    EXPECT_TRUE(fixture.run.state().running);
    EXPECT_FALSE(fixture.run.state().result);
  }
  ASSERT_TRUE(fixture.ends());
  EXPECT_EQ(*fixture.run.state().result, 19);
  EXPECT_FALSE(fixture.run.state().stopped);
  EXPECT_LE(began, 20);
}

TEST(BackgroundRun, AnErrorIsASentenceAndTheNextRunForgetsIt) {
  Fixture fixture;
  fixture.run.start(TurnKind::computes,
                    [](const Job&, const Publish&) -> int { throw tracer::Error("no such tree"); });
  ASSERT_TRUE(fixture.ends());
  EXPECT_EQ(fixture.run.state().error, "no such tree");
  fixture.run.start(TurnKind::computes, [](const Job&, const Publish&) { return 1; });
  ASSERT_TRUE(fixture.ends());
  EXPECT_EQ(fixture.run.state().error, "");
}

TEST(BackgroundRun, ForgetDropsTheResultAndWhatIsStillPublished) {
  Fixture fixture;
  std::atomic<bool> began = false;
  fixture.run.start(TurnKind::computes, [&](const Job& job, const Publish&) {
    began = true;
    return wait_for_stop(job);
  });
  ASSERT_TRUE(becomes_true([&] { return began.load(); }));
  fixture.run.forget();
  EXPECT_FALSE(fixture.run.state().running);
  std::this_thread::sleep_for(20ms);
  EXPECT_FALSE(fixture.run.state().result);
}

TEST(BackgroundRun, WakesWithTheResult) {
  Session session(wake_nobody);
  Turns turns(session);
  std::atomic<int> woken = 0;
  BackgroundRun<int> run(turns, [&] { ++woken; });
  run.start(TurnKind::computes, [](const Job&, const Publish&) { return 1; });
  EXPECT_TRUE(becomes_true([&] { return woken >= 2; }));
}

TEST(BackgroundRun, RunsAtLowPriority) {
  const int before = getpriority(PRIO_PROCESS, 0);
  Fixture fixture;
  fixture.run.start(TurnKind::computes,
                    [](const Job&, const Publish&) { return getpriority(PRIO_PROCESS, 0); });
  ASSERT_TRUE(fixture.ends());
  EXPECT_GT(*fixture.run.state().result, before);
}

TEST(BackgroundRun, CanBeDestroyedAtAnyMoment) {
  for (const auto delay : {0ms, 1ms, 5ms}) {
    for (const TurnKind kind : {TurnKind::computes, TurnKind::measures_time}) {
      Fixture fixture;
      fixture.session.submit(endless_picture());
      fixture.run.start(kind, [](const Job& job, const Publish&) { return wait_for_stop(job); });
      std::this_thread::sleep_for(delay);
    }
  }
}

TEST(Turns, TheSessionRestsWhileTimeIsMeasuredAndGoesOnAfterwards) {
  Fixture fixture;
  fixture.session.submit(endless_picture());
  ASSERT_TRUE(becomes_true([&] { return fixture.session.snapshot()->samples > 1; }));
  std::atomic<int> samples = 0;
  std::atomic<bool> moved = false;
  fixture.run.start(TurnKind::measures_time, [&](const Job&, const Publish&) {
    samples = fixture.session.snapshot()->samples;
    std::this_thread::sleep_for(30ms);
    moved = fixture.session.snapshot()->samples != samples;
    return 1;
  });
  ASSERT_TRUE(fixture.ends());
  EXPECT_FALSE(moved);
  EXPECT_TRUE(becomes_true([&] { return fixture.session.snapshot()->samples > samples; }));
  EXPECT_EQ(fixture.session.snapshot()->render_generation, 1u);
}

TEST(Turns, SettingsSubmittedDuringAPauseAreTracedAfterwards) {
  Fixture fixture;
  fixture.session.pause();
  tracer::Settings settings = endless_picture();
  settings.render.samples = 1;
  fixture.session.submit(settings);
  std::this_thread::sleep_for(20ms);
  EXPECT_FALSE(fixture.session.snapshot()->scene);
  EXPECT_TRUE(fixture.session.busy());
  fixture.session.resume();
  ASSERT_TRUE(becomes_true([&] { return !fixture.session.busy(); }));
  EXPECT_EQ(fixture.session.snapshot()->samples, 1);
}

TEST(Turns, ACancelDuringAPauseForgetsThePausedJob) {
  Fixture fixture;
  fixture.session.submit(endless_picture());
  ASSERT_TRUE(becomes_true([&] { return fixture.session.snapshot()->samples > 1; }));
  fixture.session.pause();
  ASSERT_TRUE(fixture.session.wait_until_quiet({}));
  fixture.session.cancel();
  fixture.session.resume();
  EXPECT_FALSE(fixture.session.busy());
}

TEST(Turns, WhoMeasuresIsAlone) {
  Fixture fixture;
  BackgroundRun<int> other(fixture.turns, wake_nobody);
  std::atomic<bool> measuring = false, met = false;
  other.start(TurnKind::measures_time, [&](const Job&, const Publish&) {
    measuring = true;
    std::this_thread::sleep_for(30ms);
    measuring = false;
    return 1;
  });
  ASSERT_TRUE(becomes_true([&] { return measuring || !other.state().running; }));
  EXPECT_TRUE(fixture.turns.measuring());
  fixture.run.start(TurnKind::computes, [&](const Job&, const Publish&) {
    met = measuring.load();
    return 2;
  });
  ASSERT_TRUE(fixture.ends());
  EXPECT_FALSE(met);
  EXPECT_FALSE(fixture.turns.measuring());
}

TEST(Turns, WaitingCanBeStopped) {
  Fixture fixture;
  BackgroundRun<int> other(fixture.turns, wake_nobody);
  std::atomic<bool> began = false;
  other.start(TurnKind::computes, [&](const Job& job, const Publish&) {
    began = true;
    return wait_for_stop(job);
  });
  ASSERT_TRUE(becomes_true([&] { return began.load(); }));
  fixture.run.start(TurnKind::measures_time, [](const Job&, const Publish&) { return 1; });
  ASSERT_TRUE(becomes_true([&] { return fixture.turns.measuring(); }));
  fixture.run.cancel();
  ASSERT_TRUE(fixture.ends());
  EXPECT_TRUE(becomes_true([&] { return !fixture.turns.measuring(); }));
  EXPECT_FALSE(fixture.run.state().result);
  fixture.session.submit(endless_picture());  // it is not paused
  EXPECT_TRUE(becomes_true([&] { return fixture.session.snapshot()->samples > 0; }));
}

}  // namespace
}  // namespace app
