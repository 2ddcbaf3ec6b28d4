// Timing in turns.
#include "tracer/analyze/take_turns.h"

#include <chrono>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

namespace tracer {
namespace {

TEST(Spread, IsMedianAndQuartiles) {
  EXPECT_EQ(spread_of({4, 1, 3, 2, 5}), (Spread{3, 2, 4}));
  EXPECT_EQ(spread_of({1, 2}), (Spread{1.5, 1.25, 1.75}));
  EXPECT_EQ(spread_of({7}), (Spread{7, 7, 7}));
  EXPECT_EQ(spread_of({}), Spread{});
}

TEST(TakeTurns, GoesAroundAfterAWarmUp) {
  std::string order;
  const std::function<void()> works[] = {[&] { order += 'a'; }, [&] { order += 'b'; }};
  const auto seconds = take_turns(
      works, {.turns = 2}, [&](size_t i) { order += std::to_string(i); },
      [&](int turn) { order += turn == 0 ? '(' : '|'; });
  EXPECT_EQ(order, "(a0b1|ab|ab");
  ASSERT_EQ(seconds.size(), 2u);
  EXPECT_EQ(seconds[0].size(), 2u);
  EXPECT_EQ(seconds[1].size(), 2u);
}

TEST(TakeTurns, AStoppedWorkDoesNotCount) {
  std::stop_source stop;
  int runs = 0;
  const std::function<void()> works[] = {[&] {
    if (++runs == 3) stop.request_stop();
  }};
  const auto seconds = take_turns(works, {.turns = 9, .stop = stop.get_token()}, nullptr, nullptr);
  EXPECT_EQ(runs, 3);
  EXPECT_EQ(seconds[0].size(), 1u) << "neither the warm-up nor the stopped one";
}

TEST(TakeTurns, EnoughIsEnough) {
  const std::function<void()> works[] = {
      [] { std::this_thread::sleep_for(std::chrono::milliseconds(5)); }};
  const auto seconds = take_turns(works, {.turns = 50, .enough_seconds = 0.001}, nullptr, nullptr);
  EXPECT_EQ(seconds[0].size(), 1u);
}

TEST(SecondsOf, OneThreadIsProcessorTimeAndSeveralTheClock) {
  const auto sleep = [] { std::this_thread::sleep_for(std::chrono::milliseconds(60)); };
  EXPECT_LT(seconds_of(1, sleep), 0.03);
  EXPECT_GE(seconds_of(2, sleep), 0.05);
}

TEST(WithThreads, LimitsTheArena) {
  int threads = 0;
  with_threads(1, [&] { threads = tbb::this_task_arena::max_concurrency(); });
  EXPECT_EQ(threads, 1);
  with_threads(2, [&] { threads = tbb::this_task_arena::max_concurrency(); });
  EXPECT_EQ(threads, 2);
}

}  // namespace
}  // namespace tracer
