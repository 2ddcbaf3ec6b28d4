// What spatial splits can gain at best, against what they gain.
#include "tracer/bvh/spatial_bounds.h"

#include <gtest/gtest.h>

#include "make_scene.h"

namespace tracer::test {
namespace {

constexpr uint32_t slab_count = 8;
constexpr uint32_t no_limit = 1u << 20;

// All triangles of a mesh in slabs.
struct Node {
  Mesh mesh;
  std::vector<Reference> references;
  Bounds box;

  explicit Node(Mesh of) : mesh(std::move(of)) {
    for (const Box& triangle : boxes_of(mesh)) {
      references.push_back({load3(triangle.lo), load3(triangle.hi)});
      box.grow(references.back().lo, references.back().hi);
    }
  }
  uint32_t count() const { return static_cast<uint32_t>(references.size()); }
  Slabs slabs() const { return {box, slab_count}; }

  AxisSet axes_below(float cost, uint32_t spare = no_limit) const {
    SpatialBounds bounds;
    bounds.clear(slabs());
    for (const Reference& reference : references)
      bounds.add(slabs(), reference);
    return bounds.axes_below(cost, slabs(), count(), spare);
  }
  // On one axis.
  SpatialSplit best(int axis, uint32_t spare = no_limit) const {
    SpatialHistogram<max_slabs> histogram;
    histogram.clear(slabs());
    for (uint32_t i = 0; i < count(); ++i)
      histogram.add(slabs(), references[i], corners_of(mesh, i), AxisSet(1u << axis));
    return histogram.best(slabs(), count(), spare);
  }
};

TEST(SpatialBounds, NeverRuleOutAPlaneThatCostsLess) {
  for (uint32_t seed = 1; seed < 60; ++seed) {
    const Node node(soup(4 + static_cast<int>(seed) * 5, 0.01f * static_cast<float>(seed), seed));
    for (int axis = 0; axis < 3; ++axis) {
      const SpatialSplit best = node.best(axis);
      ASSERT_EQ(best.axis, axis);
      EXPECT_TRUE(node.axes_below(best.cost * 1.00001f)[axis]) << seed << " " << axis;
    }
  }
}

TEST(SpatialBounds, AreExactWhereNothingIsCut) {
  Mesh mesh = soup(50, 0.05f);
  for (vec3& corner : mesh.positions)
    corner.x += corner.x < 0.5f ? 0.0f : 20.0f;  // cuts some triangles: their ends go apart ...
  for (const uvec3& triangle : mesh.triangles)
    for (int i = 1; i < 3; ++i)
      mesh.positions[triangle[i]].x = mesh.positions[triangle.x].x;  // ... and come together
  const Node node(std::move(mesh));
  const SpatialSplit best = node.best(0);
  EXPECT_EQ(best.left_count + best.right_count, node.count());
  EXPECT_TRUE(node.axes_below(best.cost * 1.00001f)[0]);
  EXPECT_FALSE(node.axes_below(best.cost * 0.99999f)[0]);
}

TEST(SpatialBounds, ReachThePlanesThatAreCut) {
  Mesh mesh;  // a face at each end, and a triangle from one to the other
  mesh.positions = {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {8, 0, 0}, {8, 1, 0}, {8, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {0, 3, 4}};
  const Node node(std::move(mesh));
  const float cost = node.best(0).cost;
  EXPECT_TRUE(node.axes_below(cost * 1.00001f)[0]);
  EXPECT_FALSE(node.axes_below(cost * 0.99999f)[0]);
}

TEST(SpatialBounds, SeeNoPlaneWithoutPlaceForWhatItCuts) {
  const Node node(soup(40, 2.0f));
  EXPECT_EQ(node.axes_below(infinity), all_axes);
  EXPECT_TRUE(node.axes_below(infinity, 0).none());
}

TEST(SpatialBounds, FlatAxesHaveNoPlanes) {
  EXPECT_FALSE(Node(grid(4)).axes_below(infinity)[1]);
}

}  // namespace
}  // namespace tracer::test
