#include <algorithm>

#include <gtest/gtest.h>

#include "tracer/render/colorize.h"
#include "tracer/render/text.h"
#include "tracer/render/value_scale.h"

namespace tracer {
namespace {

constexpr uint32_t background = 0xff336699u;

Picture picture(int width, int height, ValueRange range, bool counts) {
  Picture result;
  result.image = {width, height, std::vector<uint32_t>(size_t(width) * height, background)};
  result.has_range = true;
  result.range = range;
  result.counts = counts;
  result.title = "Nodes visited, all rays";
  result.unit = "nodes per pixel";
  return result;
}

size_t changed(const Picture& after) {
  return after.image.pixels.size() -
         size_t(std::count(after.image.pixels.begin(), after.image.pixels.end(), background));
}

// How many different colours a bar shows that lies anywhere in the picture.
bool shows(const Picture& after, uint32_t color) {
  return std::count(after.image.pixels.begin(), after.image.pixels.end(), color) > 4;
}

TEST(Legend, CoversASmallPartInTheLowerLeft) {
  Picture shown = picture(1280, 720, {0, 300}, true);
  draw_legend(shown, {});
  EXPECT_GT(changed(shown), 10000u);
  EXPECT_LT(changed(shown), size_t(1280 * 720 / 20));
  for (int y = 0; y < 720; ++y) {
    for (int x = 0; x < 1280; ++x) {
      if (x < 640 && y > 480) continue;
      ASSERT_EQ(shown.image.pixels[size_t(y) * 1280 + x], background) << x << " " << y;
    }
  }
}

TEST(Legend, ShowsBothEndsOfTheColourMap) {
  Picture shown = picture(640, 360, {0, 300}, true);
  ViewOptions options;
  options.colormap = "viridis";
  draw_legend(shown, options);
  EXPECT_TRUE(shows(shown, opaque(0x440154)));
  EXPECT_TRUE(shows(shown, opaque(0xfde725)));
}

TEST(Legend, FewWholeNumbersAreFields) {
  Picture shown = picture(640, 360, {0, 2}, true);
  ViewOptions options;
  options.colormap = "viridis";
  draw_legend(shown, options);
  EXPECT_TRUE(shows(shown, opaque(0x21908c)));  // the middle field, all of it
  EXPECT_FALSE(shows(shown, opaque(0x3b528b)));
}

TEST(Legend, LogarithmIsMarked) {
  Picture linear = picture(640, 360, {0, 300}, true);
  Picture logarithmic = linear;
  ViewOptions options;
  draw_legend(linear, options);
  options.logarithmic = true;
  draw_legend(logarithmic, options);
  EXPECT_NE(linear.image.pixels, logarithmic.image.pixels);
}

TEST(Legend, LargerValuesThanTheBarShowsAreMarked) {
  Picture exact = picture(640, 360, {0, 300}, true);
  exact.histogram.range = {0, 300};
  Picture cut = picture(640, 360, {0, 300}, true);
  cut.histogram.range = {0, 301};
  draw_legend(exact, {});
  draw_legend(cut, {});
  EXPECT_NE(exact.image.pixels, cut.image.pixels);
}

TEST(Legend, NothingWithoutValuesAndNothingWhereItDoesNotFit) {
  Picture radiance = picture(640, 360, {0, 1}, false);
  radiance.has_range = false;
  draw_legend(radiance, {});
  EXPECT_EQ(changed(radiance), 0u);
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(100, 80), std::pair(320, 180)}) {
    Picture small = picture(width, height, {0, 300}, true);
    draw_legend(small, {});
    EXPECT_EQ(changed(small), 0u) << width;
  }
}

TEST(Legend, SurvivesOddRanges) {
  const float big = 3e38f;
  for (const ValueRange range : {ValueRange{0, 0}, ValueRange{5, 5}, ValueRange{10, 0},
                                 ValueRange{-1, 1}, ValueRange{-big, big}, ValueRange{0, 1e-30f},
                                 ValueRange{-5, -2}, ValueRange{1e7f, 1e7f + 1}}) {
    for (const bool counts : {false, true}) {
      for (const bool logarithmic : {false, true}) {
        Picture shown = picture(640, 360, range, counts);
        ViewOptions options;
        options.logarithmic = logarithmic;
        draw_legend(shown, options);
        EXPECT_GT(changed(shown), 0u) << range.lo << " " << range.hi;
      }
    }
  }
}

TEST(ValueScale, ValueIsTheInverseOfPosition) {
  for (const bool counts : {false, true}) {
    for (const bool logarithmic : {false, true}) {
      const ValueScale scale({2, 500}, logarithmic, counts);
      EXPECT_FLOAT_EQ(scale.position(2), 0.0f);
      EXPECT_FLOAT_EQ(scale.position(500), 1.0f);
      for (const float value : {3.0f, 40.0f, 499.0f}) {
        EXPECT_NEAR(scale.value(scale.position(value)), value, 1e-3f * value);
      }
    }
  }
}

TEST(Text, DrawsEveryPrintableLetter) {
  for (char letter = '!'; letter <= '~'; ++letter) {
    Image image{24, 24, std::vector<uint32_t>(24 * 24, opaque(0))};
    draw_text(image, 4, 4, std::string(1, letter), 1.5f, 0xffffff);
    EXPECT_TRUE(std::count(image.pixels.begin(), image.pixels.end(), opaque(0)) < 24 * 24 - 1)
        << letter;
  }
}

TEST(Text, StaysInsideTheImage) {
  Image image{8, 8, std::vector<uint32_t>(64, opaque(0))};
  draw_text(image, -20, -5, "clipped on all sides", 2.0f, 0xffffff);
  draw_text(image, 5, 6, "\xc3\xa4 clipped", 9.0f, 0xffffff);
  EXPECT_EQ(text_width("", 1.0f), 0.0f);
  EXPECT_GT(text_width("ii", 1.0f), text_width("i", 1.0f));
}

}  // namespace
}  // namespace tracer
