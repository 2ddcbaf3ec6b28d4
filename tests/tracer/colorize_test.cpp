#include "tracer/render/colorize.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/tracer/hand_made.h"
#include "tracer/error.h"

namespace tracer {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Snapshot with_film(int width, int height, const Content& content, int stride = 1) {
  Snapshot snapshot = hand_made_snapshot();
  snapshot.film = hand_made_film(width, height, content, stride);
  return snapshot;
}

// A picture whose pixel x, y has visited nodes(x, y) nodes.
Snapshot with_nodes(int width, int height, const std::function<uint32_t(int, int)>& nodes,
                    int stride = 1) {
  return with_film(
      width, height,
      [&](int x, int y) {
        return pixel_of(RayClass::primary, {1, nodes(x, y), 0, 0, 0});
      },
      stride);
}

ViewOptions heat_map() {
  ViewOptions options;
  options.view = "counter";
  options.colormap = "grey";
  return options;
}

int grey(const Picture& picture, int x, int y) {
  return int(picture.image.pixels[size_t(y) * picture.image.width + x] & 0xff);
}

TEST(Colorize, FitsTheRangeToSmallestAndLargest) {
  const Picture picture =
      colorize(with_nodes(100, 70, [](int x, int) { return uint32_t(10 + x); }), heat_map());
  EXPECT_TRUE(picture.has_range);
  EXPECT_EQ(picture.range, (ValueRange{10, 109}));
  EXPECT_EQ(grey(picture, 0, 0), 0);
  EXPECT_EQ(grey(picture, 99, 69), 255);
  EXPECT_NEAR(grey(picture, 33, 5), 85, 1);
}

TEST(Colorize, AnInfiniteDistanceIsNoValue) {
  const auto distances = [](int x, int) {
    return pixel_of(Hit{x == 0 ? infinity : float(x), 0.2f, 0.2f, 0, 0});
  };
  ViewOptions options;
  options.view = "depth";
  const Picture picture = colorize(with_film(4, 1, distances), options);
  EXPECT_EQ(picture.range, (ValueRange{1, 3}));
  EXPECT_EQ(picture.histogram.values, 3u);
}

TEST(Colorize, FitLeavesAFewExtremePixelsOut) {
  const auto nodes = [](int x, int y) { return x == 7 && y == 0 ? 5000u : uint32_t(x); };
  const Picture picture = colorize(with_nodes(101, 101, nodes), heat_map());
  EXPECT_EQ(picture.range, (ValueRange{0, 100}));
  EXPECT_EQ(picture.histogram.range, (ValueRange{0, 5000}));
}

TEST(Colorize, FitKeepsAllOfAShortRangeOfCounts) {
  const auto nodes = [](int x, int y) { return x == 0 && y == 0 ? 8u : uint32_t(x % 2); };
  EXPECT_EQ(colorize(with_nodes(100, 100, nodes), heat_map()).range, (ValueRange{0, 8}));
}

TEST(Colorize, GivenRangeIsKeptAndClamps) {
  ViewOptions options = heat_map();
  options.range = ValueRange{20, 30};
  const Picture picture =
      colorize(with_nodes(50, 1, [](int x, int) { return uint32_t(x); }), options);
  EXPECT_EQ(picture.range, (ValueRange{20, 30}));
  EXPECT_EQ(picture.histogram.range, (ValueRange{0, 49}));
  EXPECT_EQ(grey(picture, 5, 0), 0);
  EXPECT_EQ(grey(picture, 40, 0), 255);
  EXPECT_NEAR(grey(picture, 25, 0), 128, 1);
}

TEST(Colorize, LogarithmOfCountsIsOfOneMore) {
  ViewOptions options = heat_map();
  options.logarithmic = true;
  const Picture picture = colorize(
      with_nodes(3, 1, [](int x, int) { return x == 0   ? 0u
                                               : x == 1 ? 15u
                                                        : 255u; }), options);
  EXPECT_EQ(grey(picture, 0, 0), 0);
  EXPECT_NEAR(grey(picture, 1, 0), 128, 1);  // log2(16) is half of log2(256)
  EXPECT_EQ(grey(picture, 2, 0), 255);
}

TEST(Colorize, LogarithmOfDepthsIsPlain) {
  ViewOptions options = heat_map();
  options.view = "depth";
  options.logarithmic = true;
  const Picture picture = colorize(with_film(3, 1,
                                             [](int x, int) {
                                               Hit hit = triangle_hit();
                                               hit.t = x == 0 ? 0.01f : x == 1 ? 0.1f : 1.0f;
                                               return pixel_of(hit);
                                             }),
                                   options);
  EXPECT_NEAR(grey(picture, 1, 0), 128, 1);
}

TEST(Colorize, OneValueForAllPixels) {
  const Picture picture = colorize(with_nodes(9, 9, [](int, int) { return 7u; }), heat_map());
  EXPECT_EQ(picture.range, (ValueRange{7, 7}));
  EXPECT_EQ(grey(picture, 4, 4), 0);
  EXPECT_THAT(picture.histogram.bars, ElementsAre(81u));
}

TEST(Colorize, NoValueIsACheckerboard) {
  ViewOptions options = heat_map();
  options.ray_class = "shadow";
  const Picture picture = colorize(with_nodes(16, 16, [](int, int) { return 1u; }), options);
  EXPECT_EQ(picture.histogram.values, 0u);
  EXPECT_NE(grey(picture, 0, 0), grey(picture, 8, 0));
  EXPECT_NE(grey(picture, 0, 0), grey(picture, 0, 8));
  EXPECT_EQ(grey(picture, 0, 0), grey(picture, 8, 8));
  options.view = "normal";  // nothing was hit
  EXPECT_NE(grey(colorize(with_nodes(16, 16, [](int, int) { return 1u; }), options), 0, 0),
            grey(colorize(with_nodes(16, 16, [](int, int) { return 1u; }), options), 8, 0));
}

TEST(Colorize, NotTracedIsFlat) {
  Snapshot snapshot = hand_made_snapshot();
  snapshot.film = empty_film(100, 100);
  for (const char* view : {"shaded", "normal", "counter"}) {
    ViewOptions options = heat_map();
    options.view = view;
    const Picture picture = colorize(snapshot, options);
    EXPECT_THAT(picture.image.pixels, testing::Each(picture.image.pixels[0])) << view;
  }
}

TEST(Colorize, EmptySnapshotGivesAnEmptyPicture) {
  EXPECT_EQ(colorize(Snapshot{}, heat_map()).image.width, 0);
  EXPECT_TRUE(std::isnan(value_at(Snapshot{}, heat_map(), 0, 0)));
}

TEST(Colorize, CoarseBlocksAreFilled) {
  const Picture picture =
      colorize(with_nodes(
                   70, 70, [](int x, int y) { return uint32_t(x + 100 * y); }, 8),
               heat_map());
  EXPECT_EQ(grey(picture, 63, 0), grey(picture, 56, 7));
  EXPECT_EQ(grey(picture, 69, 69), 255);
  EXPECT_EQ(picture.histogram.values, 4900u);
}

TEST(Colorize, HistogramGivesEveryBarAsManyNumbers) {
  // 0..99: two whole numbers a bar.
  const Picture picture =
      colorize(with_nodes(100, 1, [](int x, int) { return uint32_t(x); }), heat_map());
  EXPECT_EQ(picture.histogram.bars.size(), 50u);
  EXPECT_THAT(picture.histogram.bars, testing::Each(2u));
  EXPECT_DOUBLE_EQ(picture.histogram.mean, 49.5);
}

TEST(Colorize, HistogramLeavesOutWhatIsNotShown) {
  ViewOptions options = heat_map();
  options.range = ValueRange{0, 3};
  const Picture picture =
      colorize(with_nodes(10, 1, [](int x, int) { return uint32_t(x); }), options);
  EXPECT_THAT(picture.histogram.bars, ElementsAre(1u, 1u, 1u, 1u));
  EXPECT_EQ(picture.histogram.values, 10u);
}

TEST(Colorize, TitleSaysCounterAndRays) {
  ViewOptions options = heat_map();
  const Snapshot snapshot = with_nodes(1, 1, [](int, int) { return 1u; });
  EXPECT_EQ(colorize(snapshot, options).title, "Nodes visited, all rays");
  options.counter = "triangles";
  options.ray_class = "shadow";
  EXPECT_EQ(colorize(snapshot, options).title, "Triangle tests, shadow rays");
  EXPECT_EQ(colorize(snapshot, options).unit, "tests per pixel");
}

TEST(Colorize, UnknownIdsNameTheKnownOnes) {
  const Snapshot snapshot = hand_made_snapshot();
  const auto message = [&](auto change) {
    ViewOptions options;
    change(options);
    try {
      colorize(snapshot, options);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(message([](ViewOptions& o) { o.view = "x"; }), HasSubstr("wireframe"));
  EXPECT_THAT(message([](ViewOptions& o) { o.counter = "x"; }), HasSubstr("leaves"));
  EXPECT_THAT(message([](ViewOptions& o) { o.colormap = "x"; }), HasSubstr("turbo"));
  EXPECT_THAT(message([](ViewOptions& o) { o.tone_map = "x"; }), HasSubstr("reinhard"));
  EXPECT_THAT(message([](ViewOptions& o) { o.ray_class = "x"; }), HasSubstr("all, primary"));
}

TEST(Colorize, ShadedShowsRadiance) {
  ViewOptions options;
  options.tone_map = "none";
  const Picture picture = colorize(
      with_film(3, 1,
                [](int x, int) {
                  PixelContent pixel;
                  pixel.radiance = x == 0 ? vec3(1, 0, 0) : x == 1 ? vec3(NAN) : vec3(infinity);
                  return pixel;
                }),
      options);
  EXPECT_THAT(picture.image.pixels, ElementsAre(0xff0000ffu, 0xff0000ffu, 0xff00ff00u));
  EXPECT_FALSE(picture.has_range);
}

TEST(Colorize, SameBytesForOneThread) {
  const Snapshot snapshot =
      with_nodes(300, 200, [](int x, int y) { return uint32_t(x * y % 977); });
  const Picture many = colorize(snapshot, heat_map());
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Picture single = colorize(snapshot, heat_map());
  EXPECT_EQ(many.image.pixels, single.image.pixels);
  EXPECT_EQ(many.histogram.bars, single.histogram.bars);
  EXPECT_EQ(many.histogram.mean, single.histogram.mean);
}

TEST(ValueAt, IsWhatThePixelShows) {
  const Snapshot snapshot = with_nodes(100, 70, [](int x, int y) { return uint32_t(x + y); });
  EXPECT_EQ(value_at(snapshot, heat_map(), 99, 69), 168.0f);
  EXPECT_TRUE(std::isnan(value_at(snapshot, heat_map(), 100, 0)));
  EXPECT_TRUE(std::isnan(value_at(snapshot, ViewOptions{}, 0, 0)));
}

}  // namespace
}  // namespace tracer
