// Chores: done in order, failures reported, nothing lost at the end.
#include "app/window/chores.h"

#include <atomic>

#include <gtest/gtest.h>

#include "tests/window/wait.h"
#include "tracer/error.h"

namespace app {
namespace {

TEST(Chores, AreDoneInTheirOrder) {
  std::atomic<int> woken = 0;
  Chores chores([&] { ++woken; });
  chores.add([] { return std::string("first"); });
  chores.add([]() -> std::string { throw tracer::Error("disk full"); });
  chores.add([] { return std::string("third"); });
  ASSERT_TRUE(becomes_true([&] { return woken == 3; }));
  const auto results = chores.take_results();
  ASSERT_EQ(results.size(), 3u);
  EXPECT_EQ(results[0].message, "first");
  EXPECT_FALSE(results[0].failed);
  EXPECT_EQ(results[1].message, "disk full");
  EXPECT_TRUE(results[1].failed);
  EXPECT_EQ(results[2].message, "third");
  EXPECT_TRUE(chores.take_results().empty());
}

TEST(Chores, AreFinishedBeforeTheEnd) {
  int done = 0;
  {
    Chores chores([] {});
    for (int i = 0; i < 20; ++i) {
      chores.add([&done] {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        ++done;
        return std::string();
      });
    }
  }
  EXPECT_EQ(done, 20);
}

}  // namespace
}  // namespace app
