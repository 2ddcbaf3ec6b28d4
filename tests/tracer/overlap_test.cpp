#include "tracer/analyze/overlap.h"

#include <gtest/gtest.h>

#include "hand_made.h"
#include "make_scene.h"

namespace tracer::test {
namespace {

Bvh pair_of_leaves(const Box& root, const Box& left, const Box& right) {
  return {
      {{root.lo, 1, root.hi, 0}, {left.lo, 0, left.hi, 1}, {right.lo, 1, right.hi, 1}}, {0, 1}, 1};
}

TEST(Overlap, DisjointBoxes) {
  const Overlap result =
      overlap(pair_of_leaves({vec3(0), {4, 1, 1}}, {vec3(0), vec3(1)}, {{3, 0, 0}, {4, 1, 1}}));
  EXPECT_EQ(result.siblings, 0.0);
  EXPECT_DOUBLE_EQ(result.empty_space, 0.5);
}

TEST(Overlap, BoxesThatTouchDoNotOverlap) {
  const Overlap result =
      overlap(pair_of_leaves({vec3(0), {2, 1, 1}}, {vec3(0), vec3(1)}, {{1, 0, 0}, {2, 1, 1}}));
  EXPECT_EQ(result.siblings, 0.0);
  EXPECT_DOUBLE_EQ(result.empty_space, 0.0);
}

TEST(Overlap, ByHand) {
  // In common 1 x 1 x 1 of the root's 3 x 1 x 1: half areas 3 and 7.
  const Overlap result =
      overlap(pair_of_leaves({vec3(0), {3, 1, 1}}, {vec3(0), {2, 1, 1}}, {{1, 0, 0}, {3, 1, 1}}));
  EXPECT_DOUBLE_EQ(result.siblings, 3.0 / 7.0);
  EXPECT_DOUBLE_EQ(result.empty_space, 0.0);
}

TEST(Overlap, FlatBoxesCountByArea) {
  const Overlap result =
      overlap(pair_of_leaves({vec3(0), {4, 0, 1}}, {vec3(0), {2, 0, 1}}, {{1, 0, 0}, {3, 0, 1}}));
  EXPECT_DOUBLE_EQ(result.siblings, 1.0 / 4.0);
  EXPECT_DOUBLE_EQ(result.empty_space, 1.0 / 4.0);
}

TEST(ChildFit, CountsWhatSeveralChildrenFillOnce) {
  const Box node{vec3(0), vec3(4, 1, 1)};
  const std::vector<Box> same(3, node);
  EXPECT_NEAR(child_fit(node, same).empty_space, 0.0, 1e-9);
  EXPECT_NEAR(child_fit(node, same).overlap, 3.0, 1e-6) << "three pairs";
  // 0..2, 1..3, 1..2 of 4: a quarter is left.
  const Box some[] = {
      {vec3(0), vec3(2, 1, 1)}, {vec3(1, 0, 0), vec3(3, 1, 1)}, {vec3(1, 0, 0), vec3(2, 1, 1)}};
  EXPECT_NEAR(child_fit(node, some).empty_space, 0.25, 1e-9);
}

TEST(Overlap, LargeNodesCountMore) {
  // Below a root of half area 7 whose children touch, a node of half area 5 whose children are the
  // same: 5 of 12.
  Bvh tree = pair_of_leaves({vec3(0), {3, 1, 1}}, {vec3(0), {2, 1, 1}}, {{2, 0, 0}, {3, 1, 1}});
  tree.nodes[1] = {vec3(0), 3, {2, 1, 1}, 0};
  tree.nodes.push_back({vec3(0), 0, {2, 1, 1}, 1});
  tree.nodes.push_back({vec3(0), 1, {2, 1, 1}, 1});
  EXPECT_DOUBLE_EQ(overlap(tree).siblings, 5.0 / 12.0);
}

TEST(Overlap, TreesWithoutInnerNodes) {
  EXPECT_EQ(overlap({}).siblings, 0.0);
  EXPECT_EQ(overlap({{{vec3(0), 0, vec3(1), 1}}, {0}, 0}).empty_space, 0.0);
}

Scene instances_at(std::vector<float> places) {
  Scene scene = scene_of({sphere(6)});
  scene.instances.clear();
  for (const float x : places) {
    Instance instance;
    instance.transform[3] = vec4(x, 0, 0, 1);
    scene.instances.push_back(instance);
  }
  return scene;
}

TEST(InstanceOverlap, ApartAndTogether) {
  EXPECT_EQ(instance_overlap(bvh_of(instances_at({0, 5, 10})), {}).mean, 0.0);
  const InstanceOverlap result = instance_overlap(bvh_of(instances_at({0, 5, 5})), {});
  EXPECT_NEAR(result.mean, 2.0 / 3.0, 1e-6);
  EXPECT_NEAR(result.mean_neighbours, 2.0 / 3.0, 1e-6);
  ASSERT_EQ(result.worst.size(), 1u);
  EXPECT_EQ(result.worst[0].a, 1u);
  EXPECT_EQ(result.worst[0].b, 2u);
  EXPECT_NEAR(result.worst[0].overlap, 1.0f, 1e-5f);
}

TEST(InstanceOverlap, EveryPairOfMany) {
  std::vector<float> places;
  for (int i = 0; i < 300; ++i)
    places.push_back(float((i * 37) % 300) * 0.7f);
  const SceneBvh bvh = bvh_of(instances_at(places));
  const std::vector<Box> boxes = instance_boxes(bvh);
  uint64_t pairs = 0;
  for (uint32_t a = 0; a < places.size(); ++a) {
    for (uint32_t b = 0; b < a; ++b) {
      const Box both = intersected(boxes[a], boxes[b]);
      pairs += is_empty(both) ? 0 : 1;
    }
  }
  EXPECT_NEAR(instance_overlap(bvh, {}).mean_neighbours, 2.0 * double(pairs) / 300.0, 1e-9);
}

TEST(WastedEntries, OfPrimaryRays) {
  // Each of 16 rays enters 4 BLASes; those in the left half hit.
  const Film film = hand_made_film(4, 4, [](int x, int) {
    PixelContent pixel = pixel_of(RayClass::primary, {1, 0, 0, 0, 4});
    if (x < 2) pixel.hit = triangle_hit();
    return pixel;
  });
  const WastedEntries wasted = wasted_entries(film);
  EXPECT_EQ(wasted.entries, 64u);
  EXPECT_EQ(wasted.hits, 8u);
  EXPECT_DOUBLE_EQ(share(wasted), 0.875);
  EXPECT_EQ(share(WastedEntries{}), 0.0);
}

}  // namespace
}  // namespace tracer::test
