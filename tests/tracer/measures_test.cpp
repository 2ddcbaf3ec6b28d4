#include "tracer/analyze/measures.h"

#include <gtest/gtest.h>

#include "make_scene.h"

namespace tracer::test {
namespace {

struct Measured {
  Scene scene = scene_of({soup(300, 0.2f), sphere(8)});
  std::shared_ptr<const SceneBvh> bvh = std::make_shared<const SceneBvh>(bvh_of(scene));
};

TEST(Measures, AreThoseOfTheirParts) {
  const Measured of;
  const Measures measures = measure(of.scene, of.bvh, nullptr, {});
  EXPECT_EQ(measures.bvh, of.bvh);
  EXPECT_EQ(measures.blas_epo->value, blas_epo(of.scene, *of.bvh, epo_limits, {}).value);
  EXPECT_EQ(measures.tlas_epo->value, tlas_epo(of.scene, *of.bvh, epo_limits, {}).value);
  EXPECT_EQ(measures.blas_overlap->siblings, blas_overlap(*of.bvh).siblings);
  EXPECT_EQ(measures.tlas_overlap->siblings, overlap(of.bvh->tlas).siblings);
  EXPECT_EQ(measures.instances->mean, instance_overlap(*of.bvh, {}).mean);
  EXPECT_EQ(measures.sah_test_mesh, 0u);
  EXPECT_TRUE(holds(*measures.sah_test));
}

TEST(Measures, ArePublishedPartByPart) {
  const Measured of;
  int published = 0;
  float last = -1.0f;
  const Job job{{}, [&](float fraction, std::string_view what) {
                  EXPECT_GT(fraction, last);
                  EXPECT_FALSE(what.empty());
                  last = fraction;
                }};
  measure(of.scene, of.bvh, nullptr, job, [&](const Measures& measures) {
    ++published;
    EXPECT_EQ(measures.sah_test.has_value(), published == 6);
  });
  EXPECT_EQ(published, 6);
}

TEST(Measures, OfTheSameBlasesAreTakenOver) {
  const Measured of;
  Measures before = measure(of.scene, of.bvh, nullptr, {});
  before.blas_epo->value = -1.0;
  SceneBvh moved = *of.bvh;
  moved.instances[0].to_world[3].x = 5.0f;
  const auto again = measure(of.scene, std::make_shared<const SceneBvh>(moved), &before, {});
  EXPECT_EQ(again.blas_epo->value, -1.0);
  EXPECT_NE(again.bvh, of.bvh);

  moved.options.traversal_cost = 3.0f;
  const auto dearer = measure(of.scene, std::make_shared<const SceneBvh>(moved), &before, {});
  EXPECT_GT(dearer.blas_epo->value, 0.0);
}

TEST(Measures, AStopLeavesTheRestUnknown) {
  const Measured of;
  std::stop_source stop;
  const Measures measures = measure(of.scene, of.bvh, nullptr, {stop.get_token(), nullptr},
                                    [&](const Measures&) { stop.request_stop(); });
  EXPECT_TRUE(measures.blas_overlap);
  EXPECT_FALSE(measures.blas_epo);
  EXPECT_FALSE(measures.sah_test);
}

}  // namespace
}  // namespace tracer::test
