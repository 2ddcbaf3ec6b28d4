// The whole workspace drawn without a display: real pixels, looked at in regions because fonts and
// drivers differ.
#include "app/window/screenshot.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tracer/temporary_folder.h"
#include "tracer/error.h"
#include "tracer/scene/load_image.h"

namespace app {
namespace {

using testing::HasSubstr;
using tracer::Texture;

ScreenshotOptions small_workspace() {
  ScreenshotOptions options;
  options.width = 1000;
  options.height = 640;
  options.settings.render.samples = 1;
  return options;
}

// Different colours in a part of the picture, given as fractions of its sides.
size_t colours(const Texture& picture, float left, float top, float right, float bottom) {
  std::set<uint32_t> found;
  for (auto y = uint32_t(top * picture.height); y < uint32_t(bottom * picture.height); ++y) {
    for (auto x = uint32_t(left * picture.width); x < uint32_t(right * picture.width); ++x) {
      found.insert(picture.texels[size_t(y) * picture.width + x]);
    }
  }
  return found.size();
}

std::string refusal(const ScreenshotOptions& options) {
  const TemporaryFolder folder;
  const std::string message =
      message_of([&] { write_workspace_screenshot(options, folder.path / "w.png"); });
  EXPECT_FALSE(std::filesystem::exists(folder.path / "w.png"));
  return message;
}

TEST(Screenshot, ShowsThePanelsAndThePicture) {
  const TemporaryFolder folder;
  write_workspace_screenshot(small_workspace(), folder.path / "w.png");
  const Texture picture = tracer::load_texture(folder.path / "w.png");
  ASSERT_EQ(picture.width, 1000u);
  ASSERT_EQ(picture.height, 640u);
  EXPECT_GT(colours(picture, 0.0f, 0.0f, 1.0f, 0.05f), 10u) << "menu bar";
  EXPECT_GT(colours(picture, 0.0f, 0.1f, 0.2f, 0.9f), 10u) << "left region";
  EXPECT_GT(colours(picture, 0.8f, 0.1f, 1.0f, 0.9f), 10u) << "right region";
  EXPECT_GT(colours(picture, 0.4f, 0.2f, 0.6f, 0.5f), 500u) << "the picture";
  EXPECT_GT(colours(picture, 0.0f, 0.95f, 1.0f, 1.0f), 10u) << "status bar";
}

TEST(Screenshot, ShowsTheChosenView) {
  const TemporaryFolder folder;
  ScreenshotOptions options = small_workspace();
  write_workspace_screenshot(options, folder.path / "shaded.png");
  options.view.view = "counter";
  write_workspace_screenshot(options, folder.path / "nodes.png");
  EXPECT_NE(tracer::load_texture(folder.path / "shaded.png").texels,
            tracer::load_texture(folder.path / "nodes.png").texels);
}

TEST(Screenshot, AScaleOfTwoIsAnotherPicture) {
  const TemporaryFolder folder;
  ScreenshotOptions options = small_workspace();
  options.width = 1280;
  options.height = 800;
  options.scale = 2.0f;
  write_workspace_screenshot(options, folder.path / "w.png");
  EXPECT_GT(colours(tracer::load_texture(folder.path / "w.png"), 0, 0, 1, 1), 500u);
}

TEST(Screenshot, RefusesImpossibleSizes) {
  ScreenshotOptions options = small_workspace();
  options.width = 0;
  EXPECT_THAT(refusal(options), HasSubstr("0x640"));
  options.width = 100000;
  EXPECT_THAT(refusal(options), HasSubstr("100000x640"));
  options = small_workspace();
  options.scale = 9.0f;
  EXPECT_THAT(refusal(options), HasSubstr("scale 9"));
}

TEST(Screenshot, RefusesAnUnknownSceneOrView) {
  ScreenshotOptions options = small_workspace();
  options.settings.source.name = "no-such-scene";
  EXPECT_THAT(refusal(options), HasSubstr("no-such-scene"));
  options = small_workspace();
  options.view.view = "no-such-view";
  EXPECT_THAT(refusal(options), HasSubstr("no-such-view"));
}

TEST(Screenshot, BringsAPanelToTheFront) {
  const TemporaryFolder folder;
  ScreenshotOptions options = small_workspace();
  write_workspace_screenshot(options, folder.path / "view.png");
  options.panels = {"build"};
  write_workspace_screenshot(options, folder.path / "build.png");
  EXPECT_NE(tracer::load_texture(folder.path / "view.png").texels,
            tracer::load_texture(folder.path / "build.png").texels);
  options.panels = {"no-such-panel"};
  EXPECT_THAT(refusal(options), HasSubstr("no-such-panel"));
}

TEST(Screenshot, FollowsTheRaysOfAPixel) {
  const TemporaryFolder folder;
  ScreenshotOptions options = small_workspace();
  options.panels = {"ray"};
  write_workspace_screenshot(options, folder.path / "none.png");
  options.pixel = tracer::ivec2(100, 100);
  write_workspace_screenshot(options, folder.path / "rays.png");
  const Texture none = tracer::load_texture(folder.path / "none.png");
  const Texture rays = tracer::load_texture(folder.path / "rays.png");
  EXPECT_GT(colours(rays, 0.2f, 0.7f, 0.8f, 0.95f), 2 * colours(none, 0.2f, 0.7f, 0.8f, 0.95f));
  options.pixel = tracer::ivec2(5000, 5000);
  EXPECT_THAT(refusal(options), HasSubstr("pixel 5000,5000 is outside the picture"));
}

TEST(Screenshot, SaysWhereItCannotWrite) {
  const TemporaryFolder folder;
  const auto file = folder.path / "missing/w.png";
  EXPECT_THAT(message_of([&] { write_workspace_screenshot(small_workspace(), file); }),
              HasSubstr("missing"));
}

}  // namespace
}  // namespace app
