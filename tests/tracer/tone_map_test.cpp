#include "tracer/render/tone_map.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tracer/choice.h"

namespace tracer {
namespace {

const ToneMapRow& tone_map(std::string_view id) {
  return *find_row(tone_maps(), id);
}

uint32_t shown(std::string_view id, float exposure, vec3 linear) {
  return DisplayCurve(tone_map(id), exposure)(linear);
}

TEST(ToneMap, BlackStaysBlack) {
  for (const ToneMapRow& row : tone_maps()) {
    EXPECT_EQ(DisplayCurve(row, 0.0f)(vec3(0.0f)), 0xff000000u) << row.id;
    EXPECT_EQ(DisplayCurve(row, 0.0f)(vec3(-1.0f)), 0xff000000u) << row.id;
  }
}

TEST(ToneMap, NoneIsTheSrgbCurve) {
  EXPECT_EQ(shown("none", 0.0f, vec3(1.0f)), 0xffffffffu);
  EXPECT_EQ(shown("none", 0.0f, vec3(50.0f)), 0xffffffffu);
  // Mid grey: 0.2140 linear is 0.5 sRGB.
  EXPECT_NEAR(int(shown("none", 0.0f, vec3(0.2140f)) & 0xff), 128, 1);
}

TEST(ToneMap, NoneIsWithinOneStepOfTheExactCurve) {
  const DisplayCurve curve(tone_map("none"), 0.0f);
  for (int i = 0; i <= 10000; ++i) {
    const float linear = float(i) / 10000.0f;
    const float exact =
        linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
    EXPECT_NEAR(float(curve(vec3(linear)) & 0xff), 255.0f * exact, 1.0f) << linear;
  }
}

TEST(ToneMap, OneStopDoublesTheLight) {
  EXPECT_EQ(shown("none", 1.0f, vec3(0.2f)), shown("none", 0.0f, vec3(0.4f)));
  EXPECT_EQ(shown("aces", -2.0f, vec3(1.0f)), shown("aces", 0.0f, vec3(0.25f)));
}

TEST(ToneMap, ReinhardHalvesOne) {
  EXPECT_FLOAT_EQ(tone_map("reinhard").map(vec3(1.0f)).x, 0.5f);
}

TEST(ToneMap, AcesHasThePublishedValue) {
  EXPECT_NEAR(tone_map("aces").map(vec3(1.0f)).x, (2.51f + 0.03f) / (2.43f + 0.59f + 0.14f), 1e-6f);
  EXPECT_LE(tone_map("aces").map(vec3(1e4f)).x, 1.0f);
}

TEST(ToneMap, ChannelsKeepTheirPlaces) {
  EXPECT_EQ(shown("none", 0.0f, vec3(1.0f, 0.0f, 0.0f)), 0xff0000ffu);
  EXPECT_EQ(shown("none", 0.0f, vec3(0.0f, 0.0f, 1.0f)), 0xffff0000u);
}

TEST(ToneMap, NanIsRedAndInfinityGreen) {
  EXPECT_EQ(shown("aces", 0.0f, vec3(0.5f, NAN, 0.5f)), 0xff0000ffu);
  EXPECT_EQ(shown("aces", 0.0f, vec3(0.5f, infinity, 0.5f)), 0xff00ff00u);
  EXPECT_EQ(shown("aces", 0.0f, vec3(infinity, NAN, 0.5f)), 0xff0000ffu);
}

}  // namespace
}  // namespace tracer
