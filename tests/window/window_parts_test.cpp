// The small parts of the window that need no display.
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "app/window/frame_times.h"
#include "app/window/gl_picture.h"
#include "app/window/keys.h"
#include "app/window/save.h"
#include "tests/tracer/temporary_folder.h"
#include "ui/workspace.h"

namespace app {
namespace {

TEST(Keys, LettersGoByTheirName) {
  EXPECT_EQ(key_code(GLFW_KEY_Z, "z"), 'Z');
  EXPECT_EQ(key_code(GLFW_KEY_Y, "z"), 'Z');  // a German keyboard
}

TEST(Keys, OtherScriptsAndDigitsGoByTheirPlace) {
  EXPECT_EQ(key_code(GLFW_KEY_W, "\xd1\x86"), 'W');  // a Russian keyboard
  EXPECT_EQ(key_code(GLFW_KEY_1, "&"), '1');         // a French keyboard
}

TEST(Keys, NamedKeys) {
  EXPECT_EQ(key_code(GLFW_KEY_ESCAPE, nullptr), ui::key_escape);
  EXPECT_EQ(key_code(GLFW_KEY_F12, nullptr), ui::key_f12);
  EXPECT_EQ(key_code(GLFW_KEY_SPACE, nullptr), ui::key_space);
  EXPECT_EQ(key_code(GLFW_KEY_DELETE, nullptr), ui::key_delete);
  EXPECT_EQ(key_code(GLFW_KEY_LEFT, nullptr), ui::key_left);
  EXPECT_EQ(key_code(GLFW_KEY_RIGHT, nullptr), ui::key_right);
  EXPECT_EQ(key_code(GLFW_KEY_HOME, nullptr), ui::key_home);
  EXPECT_EQ(key_code(GLFW_KEY_END, nullptr), ui::key_end);
  EXPECT_EQ(key_code(GLFW_KEY_LEFT_SHIFT, nullptr), ui::key_other);
  EXPECT_EQ(key_code(GLFW_KEY_UNKNOWN, nullptr), ui::key_other);
}

TEST(Shrunk, KeepsEveryNthPixel) {
  const tracer::Image image{5, 3, {0, 1, 2, 3, 4, 10, 11, 12, 13, 14, 20, 21, 22, 23, 24}};
  const tracer::Image half = shrunk(image, 3);
  EXPECT_EQ(half.width, 3);
  EXPECT_EQ(half.height, 2);
  EXPECT_EQ(half.pixels, (std::vector<uint32_t>{0, 2, 4, 20, 22, 24}));
}

TEST(Shrunk, LeavesWhatFits) {
  const tracer::Image image{2, 2, {1, 2, 3, 4}};
  EXPECT_EQ(shrunk(image, 2).pixels, image.pixels);
}

TEST(FrameTimes, GiveMeanNearestRankAndMaximum) {
  FrameTimes times;
  for (int i = 1; i <= 100; ++i)
    times.tracing.push_back(float(i));
  EXPECT_EQ(to_text(times),
            "frames while tracing: 100, mean 50.5 ms, p95 95.0 ms, max 100.0 ms\n"
            "frames while idle: none\n"
            "pictures coloured: none\n");
}

TEST(FrameTimes, OneFrameIsItsOwnPercentile) {
  FrameTimes times;
  times.idle.push_back(3.0f);
  EXPECT_EQ(to_text(times),
            "frames while tracing: none\n"
            "frames while idle: 1, mean 3.0 ms, p95 3.0 ms, max 3.0 ms\n"
            "pictures coloured: none\n");
}

TEST(SavePicture, SaysThatThereIsNoneYet) {
  const TemporaryFolder folder;
  const std::string message = message_of([&] {
    save_picture(std::make_shared<tracer::Snapshot>(), {}, {}, folder.path / "picture.png");
  });
  EXPECT_NE(message.find("no picture"), std::string::npos) << message;
}

TEST(ScreenshotName, IsNew) {
  const auto file = new_screenshot_name();
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_EQ(file.extension(), ".png");
}

}  // namespace
}  // namespace app
