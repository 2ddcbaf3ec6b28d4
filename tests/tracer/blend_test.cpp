#include "tracer/analyze/blend.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace tracer {
namespace {

std::vector<BlendSample> builds(double alpha, double scale) {
  std::vector<BlendSample> samples;
  for (const auto& [sah, epo] : {std::pair(70.0, 9.0), {65.0, 5.0}, {72.0, 1.0}, {90.0, 20.0}}) {
    samples.push_back({sah, epo, scale * ((1.0 - alpha) * sah + alpha * epo)});
  }
  return samples;
}

TEST(Blend, FindsWhatCostsWereMadeOf) {
  for (const double alpha : {0.0, 0.25, 0.71, 1.0}) {
    const auto blend = fit_blend(builds(alpha, 1.7));
    ASSERT_TRUE(blend);
    EXPECT_NEAR(blend->alpha, alpha, 1e-9);
    EXPECT_NEAR(blend->scale, 1.7, 1e-9);
    EXPECT_NEAR(blend->mean_error, 0.0, 1e-9);
    EXPECT_NEAR(blend->correlation, 1.0, 1e-9);
  }
}

TEST(Blend, NeedsThreeBuildsThatDiffer) {
  std::vector<BlendSample> samples = builds(0.5, 1.0);
  EXPECT_FALSE(fit_blend({}));
  EXPECT_FALSE(fit_blend(std::span(samples).first(2)));
  EXPECT_TRUE(fit_blend(std::span(samples).first(3)));
  samples[1] = samples[2] = samples[3] = samples[0];
  EXPECT_FALSE(fit_blend(samples));
}

TEST(Blend, AlphaStaysBetweenZeroAndOne) {
  // Costs that rise with SAH and fall with EPO, and the other way round.
  const std::vector<BlendSample> sah = {{10, 5, 10}, {20, 30, 15}, {30, 5, 30}};
  EXPECT_EQ(fit_blend(sah)->alpha, 0.0);
  const std::vector<BlendSample> epo = {{10, 5, 5}, {50, 10, 9}, {20, 20, 21}};
  EXPECT_EQ(fit_blend(epo)->alpha, 1.0);
}

// A search through all alphas finds none with a larger correlation.
TEST(Blend, NoOtherAlphaCorrelatesBetter) {
  const std::vector<BlendSample> samples = {
      {74.3, 10.9, 105.0}, {71.4, 8.8, 79.6}, {65.2, 5.6, 58.6}, {72.0, 1.2, 57.8}};
  const auto blend = fit_blend(samples);
  ASSERT_TRUE(blend);
  for (int i = 0; i <= 1000; ++i) {
    const double alpha = 0.001 * i;
    double xy = 0.0, xx = 0.0, yy = 0.0;
    for (const BlendSample& sample : samples) {
      const double x = (1.0 - alpha) * sample.sah + alpha * sample.epo;
      xy += x * sample.measured;
      xx += x * x;
      yy += sample.measured * sample.measured;
    }
    EXPECT_LE(xy / std::sqrt(xx * yy), blend->correlation + 1e-12);
  }
  EXPECT_GT(blend->alpha, 0.5);
  EXPECT_LT(blend->mean_error, 0.12);
}

TEST(Blend, WhereBothSayTheSameItIsSah) {
  const std::vector<BlendSample> samples = {{10, 5, 20}, {20, 10, 40}, {30, 15, 61}};
  EXPECT_EQ(fit_blend(samples)->alpha, 0.0);
}

TEST(Blend, WithoutEndPointsItIsSah) {
  const std::vector<BlendSample> samples = {{10, 0, 20}, {20, 0, 41}, {30, 0, 60}};
  EXPECT_EQ(fit_blend(samples)->alpha, 0.0);
}

TEST(Blend, BuildsWithoutACostAreLeftOut) {
  std::vector<BlendSample> samples = builds(0.5, 2.0);
  samples.push_back({50.0, 3.0, 0.0});
  samples.push_back({NAN, 3.0, 1.0});
  EXPECT_NEAR(fit_blend(samples)->alpha, 0.5, 1e-9);
}

}  // namespace
}  // namespace tracer
