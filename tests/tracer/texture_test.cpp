// Texture sampling.
#include "tracer/scene/texture.h"

#include <cmath>

#include <gtest/gtest.h>

namespace {

using tracer::sample;
using tracer::Texture;
using tracer::vec2;
using tracer::vec3;

constexpr uint32_t black = 0xff000000u, white = 0xffffffffu, red = 0xff0000ffu, blue = 0xffff0000u;

// red    blue
// black  white
Texture four() {
  return {"four", 2, 2, std::vector{red, blue, black, white}};
}

void expect_near(const vec3& a, const vec3& b) {
  EXPECT_LT(glm::length(a - b), 1e-5f) << a.x << " " << a.y << " " << a.z;
}

TEST(Texture, LowerLeftIsTheLastRow) {
  expect_near(sample(four(), {0.25f, 0.25f}), {0, 0, 0});
  expect_near(sample(four(), {0.75f, 0.25f}), {1, 1, 1});
  expect_near(sample(four(), {0.25f, 0.75f}), {1, 0, 0});
  expect_near(sample(four(), {0.75f, 0.75f}), {0, 0, 1});
}

TEST(Texture, MixesNeighboursInLinearLight) {
  expect_near(sample(four(), {0.5f, 0.25f}), vec3(0.5f));
  expect_near(sample(four(), {0.5f, 0.5f}), {0.5f, 0.25f, 0.5f});
}

TEST(Texture, RepeatsAcrossItsEdges) {
  expect_near(sample(four(), {0.0f, 0.25f}), vec3(0.5f));
  expect_near(sample(four(), {7.25f, -2.75f}), {0, 0, 0});
  expect_near(sample(four(), {-0.25f, 0.25f}), {1, 1, 1});
}

TEST(Texture, OneTexelIsThatColour) {
  const Texture one = {"one", 1, 1, std::vector{red}};
  for (const float at : {-3.7f, 0.0f, 0.5f, 1.0f})
    expect_near(sample(one, {at, at}), {1, 0, 0});
}

TEST(Texture, OddCoordinatesStayInside) {
  const float nan = std::nanf("");
  for (const float at : {nan, tracer::infinity, -tracer::infinity, 1e30f, -1e-30f, 0.99999999f}) {
    const vec3 color = sample(four(), {at, at});
    EXPECT_TRUE(color.x >= 0.0f && color.x <= 1.0f);
  }
}

TEST(Texture, EmptyIsGrey) {
  expect_near(sample(Texture{}, {0.3f, 0.4f}), vec3(0.5f));
}

TEST(Srgb, KnownValues) {
  EXPECT_EQ(tracer::linear_from_srgb(0), 0.0f);
  EXPECT_EQ(tracer::linear_from_srgb(255), 1.0f);
  EXPECT_NEAR(tracer::linear_from_srgb(128), 0.21586f, 1e-5f);
  EXPECT_NEAR(tracer::linear_from_srgb(10), 10.0f / 255.0f / 12.92f, 1e-7f);
}

TEST(Srgb, BackAndForth) {
  for (int i = 0; i < 256; ++i) {
    EXPECT_NEAR(255.0f * tracer::srgb_from_linear(tracer::linear_from_srgb(uint8_t(i))), float(i),
                1e-2f);
  }
  EXPECT_EQ(tracer::srgb_from_linear(5.0f), 1.0f);
  EXPECT_EQ(tracer::srgb_from_linear(-1.0f), 0.0f);
  EXPECT_EQ(tracer::srgb_from_linear(std::nanf("")), 0.0f);
}

}  // namespace
