// The sky by direction.
#include "tracer/scene/sky.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tracer/bvh/ray_kernels.h"
#include "tracer/math/arc_tangent-inl.h"

namespace {

using tracer::SkyImage;
using tracer::SkySettings;
using tracer::vec3;

// The red value is the column, the green one the row.
SkyImage numbered(uint32_t width, uint32_t height) {
  std::vector<vec3> texels;
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x)
      texels.emplace_back(float(x), float(y), 0.0f);
  }
  return {"numbered", width, height, texels};
}

vec3 radiance(const SkyImage& image, const SkySettings& settings, const vec3& direction) {
  vec3 result(-1.0f);
  sky_radiance(image, settings, {&direction, 1}, {&result, 1});
  return result;
}

vec3 look(const vec3& direction, const SkySettings& settings = {}) {
  return radiance(numbered(8, 4), settings, direction);
}

std::vector<vec3> some_directions(int count) {
  std::vector<vec3> directions;
  directions.reserve(size_t(count));
  for (int i = 0; i < count; ++i)
    directions.emplace_back(std::sin(float(i)), std::cos(1.7f * float(i)),
                            std::sin(2.9f * float(i)));
  return directions;
}

float fast_atan2(float y, float x) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<float, 1> d;
  return hn::GetLane(tracer::HWY_NAMESPACE::fast_atan2(d, hn::Set(d, y), hn::Set(d, x)));
}

TEST(Sky, UpIsTheFirstRowAndDownTheLast) {
  EXPECT_EQ(look({0, 1, 0}).y, 0.0f);
  EXPECT_EQ(look({0, -1, 0}).y, 3.0f);
  EXPECT_NEAR(look({1, 0, 0}).y, 1.5f, 1e-4f);
}

TEST(Sky, AxesAreWhereTheHeaderSays) {
  EXPECT_NEAR(look({1, 0, 0}).x, 3.5f, 1e-4f);
  EXPECT_NEAR(look({0, 0, 1}).x, 5.5f, 1e-4f);
  EXPECT_NEAR(look({0, 0, -1}).x, 1.5f, 1e-4f);
}

TEST(Sky, WrapsBehind) {
  // Half way between column 7 and column 0.
  EXPECT_NEAR(look({-1, 0, 0}).x, 3.5f, 1e-4f);
}

TEST(Sky, LengthDoesNotMatter) {
  const vec3 direction(0.3f, -0.2f, 0.7f);
  for (const float length : {1e-30f, 1e-3f, 1e6f, 1e30f}) {
    EXPECT_LT(glm::length(look(direction * length) - look(direction)), 1e-3f);
  }
}

TEST(Sky, TurnsAboutTheUpAxis) {
  SkySettings settings;
  settings.rotation_degrees = 90.0f;
  // What was at +x is now at -z, as a right-handed turn about +y takes it.
  EXPECT_NEAR(look({0, 0, -1}, settings).x, look({1, 0, 0}).x, 1e-4f);
  EXPECT_NEAR(look({1, 0, 0}, settings).x, look({0, 0, 1}).x, 1e-4f);
}

TEST(Sky, ManyDirectionsAreLookedUpAsOneIs) {
  std::vector<vec3> directions = some_directions(23);  // no multiple of eight
  directions[6] = vec3(0.0f);
  std::vector<vec3> found(directions.size(), vec3(-1.0f));
  sky_radiance(numbered(8, 4), {}, directions, found);
  for (size_t i = 0; i < directions.size(); ++i)
    EXPECT_EQ(found[i], look(directions[i])) << i;
}

TEST(Sky, IsTheSameWithEveryInstructionSet) {
  const std::vector<vec3> directions = some_directions(1000);
  std::vector<vec3> first(directions.size()), found(directions.size());
  SkySettings settings;
  settings.rotation_degrees = 33.0f;
  sky_radiance(numbered(64, 32), settings, directions, first);
  for (const tracer::IsaRow& isa : tracer::isas()) {
    tracer::prefer_isa(isa.id);
    sky_radiance(numbered(64, 32), settings, directions, found);
    EXPECT_EQ(found, first) << isa.id;
  }
  tracer::prefer_isa("");
}

TEST(Sky, IntensityScales) {
  SkySettings settings;
  settings.intensity = 2.5f;
  EXPECT_NEAR(look({1, 0, 0}, settings).x, 2.5f * 3.5f, 1e-3f);
}

TEST(Sky, WithoutImageItIsFlat) {
  SkySettings settings;
  settings.intensity = 2.0f;
  settings.flat_color = {0.1f, 0.2f, 0.3f};
  EXPECT_EQ(radiance({}, settings, {0, 1, 0}), 2.0f * settings.flat_color);
}

TEST(Sky, OffIsBlack) {
  SkySettings settings;
  settings.on = false;
  EXPECT_EQ(radiance({}, settings, {0, 1, 0}), vec3(0.0f));
  EXPECT_EQ(look({0, 1, 0}, settings), vec3(0.0f));
}

TEST(ArcTangent, IsThatOfTheStandardLibrary) {
  for (int i = 0; i < 100'000; ++i) {
    const double angle = (i - 50'000) * 1e-4;
    const float x = float(std::cos(angle)), y = float(std::sin(angle));
    ASSERT_NEAR(fast_atan2(y, x), std::atan2(y, x), 4e-7) << angle;
    ASSERT_NEAR(fast_atan2(1e30f * y, 1e30f * x), std::atan2(y, x), 4e-7) << angle;
  }
  for (const float y : {0.0f, -0.0f, 1.0f, -1.0f, 1e-30f}) {
    for (const float x : {0.0f, 1.0f, -1.0f, 1e30f})
      EXPECT_NEAR(fast_atan2(y, x), std::atan2(y, x), 4e-7) << y << " " << x;
  }
}

TEST(Sky, OddDirectionsStayInside) {
  const float nan = std::nanf("");
  EXPECT_EQ(look({0, 0, 0}), vec3(0.0f));
  EXPECT_EQ(look({nan, 0, 0}), vec3(0.0f));
  EXPECT_EQ(look({tracer::infinity, 0, 0}), vec3(0.0f));
  EXPECT_EQ(radiance({"one", 1, 1, std::vector{vec3(3.0f)}}, {}, {-1, 0, -1e-9f}), vec3(3.0f));
}

}  // namespace
