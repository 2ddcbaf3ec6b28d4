// Which trees a moment has, by update strategy.
#include "tracer/animation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/analyze/quality.h"
#include "tracer/error.h"

namespace tracer::test {
namespace {

Animation animation(const char* strategy, Deformer deformer = {"twist", 2.0f, "y", 0.25f}) {
  Animation made;
  made.rest = std::make_shared<const Scene>(scene_of({sphere(16), soup(300, 0.2f)}));
  made.deformer = std::move(deformer);
  made.update = {strategy, 4, 1.2f, 10.0f};
  return made;
}

PosedTrees at(const Animation& animation, float time) {
  AnimationCache cache;
  return pose_trees(animation, time, cache, {});
}

double sah(const PosedTrees& trees) {
  SceneBvh bvh;
  bvh.blases = trees.blases;
  return blas_statistics(bvh).sah;
}

TEST(Animation, FramesAndTimes) {
  EXPECT_EQ(frame_at(0.0f, 30.0f), 0);
  for (const float rate : {1.0f, 24.0f, 30.0f, 59.94f, 240.0f}) {
    for (const int64_t frame : {1, 2, 29, 30, 1000, 12345})
      EXPECT_EQ(frame_at(time_of(frame, rate), rate), frame) << rate;
  }
}

TEST(Animation, WithoutADeformerEveryStrategyHasTheTreesAtRest) {
  for (const UpdateRow& row : updates()) {
    const Animation still = animation(row.id.data(), {});
    const PosedTrees trees = at(still, 3.0f);
    EXPECT_EQ(trees.scene, still.rest) << row.id;
    EXPECT_FALSE(trees.facts.refitted) << row.id;
    EXPECT_EQ(trees.facts.deform_ms, 0.0) << row.id;
  }
}

TEST(Animation, RefitKeepsTheTreesAtRest) {
  const PosedTrees trees = at(animation("refit"), 1.0f);
  EXPECT_TRUE(trees.facts.refitted);
  EXPECT_EQ(trees.facts.built_time, -1.0f);
  EXPECT_GT(trees.facts.refit_ms, 0.0);
}

TEST(Animation, RebuildIsABuildOverTheShape) {
  const PosedTrees trees = at(animation("rebuild"), 1.0f);
  EXPECT_FALSE(trees.facts.refitted);
  EXPECT_EQ(trees.facts.built_time, 1.0f);
  EXPECT_EQ(sah(trees), blas_statistics(bvh_of(*trees.scene)).sah);
  EXPECT_LT(sah(trees), sah(at(animation("refit"), 1.0f)));
}

TEST(Animation, EveryFourthFrameIsBuilt) {
  const Animation periodic = animation("every");
  AnimationCache cache;
  for (int64_t frame = 0; frame < 12; ++frame) {
    const PosedTrees trees = pose_trees(periodic, time_of(frame, 10.0f), cache, {});
    EXPECT_EQ(trees.facts.refitted, frame % 4 != 0) << frame;
    EXPECT_FLOAT_EQ(trees.facts.built_time, time_of(frame / 4 * 4, 10.0f)) << frame;
  }
}

TEST(Animation, GrowthRebuildsWhenTheSahHasGrown) {
  const Animation growing = animation("growth");
  AnimationCache cache;
  double built = sah(at(growing, 0.0f));
  int builds = 0;
  float built_time = -1.0f;
  for (int64_t frame = 0; frame <= 10; ++frame) {
    const PosedTrees trees = pose_trees(growing, time_of(frame, 10.0f), cache, {});
    if (trees.facts.built_time != built_time) {
      built_time = trees.facts.built_time;
      built = sah(trees);
      ++builds;
      EXPECT_FALSE(trees.facts.refitted);
    }
    EXPECT_LE(sah(trees), 1.2 * built + 1e-9) << frame;
  }
  EXPECT_GT(builds, 1);
  EXPECT_LT(builds, 11);
}

TEST(Animation, TheCacheChangesNothing) {
  for (const UpdateRow& row : updates()) {
    for (const char* kind : {"twist", "wave", "explode"}) {
      const Animation moving = animation(row.id.data(), {kind, 1.0f, "y", 0.7f});
      AnimationCache cache;
      for (const float time : {0.0f, 0.33f, 2.5f, 0.9f, 1.0f, 1.0f, 1.45f}) {
        const PosedTrees warm = pose_trees(moving, time, cache, {});
        const PosedTrees cold = at(moving, time);
        EXPECT_EQ(warm.facts.built_time, cold.facts.built_time) << row.id << kind << time;
        EXPECT_EQ(warm.facts.refitted, cold.facts.refitted) << row.id << kind << time;
        EXPECT_EQ(sah(warm), sah(cold)) << row.id << kind << time;
      }
    }
  }
}

TEST(Animation, OtherOptionsForgetTheTreesBuiltOnTheWay) {
  AnimationCache cache;
  pose_trees(animation("every"), 1.0f, cache, {});
  Animation other = animation("every", {"bend", 1.0f, "x", 0.25f});
  other.update.every = 3;
  EXPECT_EQ(sah(pose_trees(other, 1.0f, cache, {})), sah(at(other, 1.0f)));
}

TEST(Animation, AHeldShapeIsBuiltOnce) {
  const Animation held = animation("every", {"twist", 1.0f, "y", 0.0f});
  const PosedTrees trees = at(held, 7.0f);
  EXPECT_FALSE(trees.facts.refitted);
  EXPECT_EQ(trees.facts.built_time, 0.0f);
}

TEST(Animation, SplitReferencesAreTold) {
  const Animation moving = animation("refit");
  AnimationCache cache;
  pose_trees(moving, 0.0f, cache, {});
  auto split = std::make_shared<Blas>(*cache.rest[0]);
  split->tree.references.push_back(0);
  cache.rest[0] = split;
  EXPECT_THAT(pose_trees(moving, 1.0f, cache, {}).facts.warning,
              testing::HasSubstr("1 of 2 trees have split references"));
  EXPECT_EQ(at(moving, 1.0f).facts.warning, "");
}

TEST(Animation, AStoppedJobHasNoTrees) {
  std::stop_source stop;
  stop.request_stop();
  for (const UpdateRow& row : updates()) {
    AnimationCache cache;
    const PosedTrees trees =
        pose_trees(animation(row.id.data()), 1.0f, cache, {stop.get_token(), {}});
    EXPECT_TRUE(trees.blases.empty()) << row.id;
    EXPECT_TRUE(cache.rest.empty()) << row.id;
  }
}

TEST(Animation, BadOptionsAreRefused) {
  Animation bad = animation("magic");
  EXPECT_THROW(at(bad, 0.0f), Error);
  bad = animation("every");
  bad.update.every = 0;
  EXPECT_THROW(at(bad, 0.0f), Error);
}

}  // namespace
}  // namespace tracer::test
