// Expensive nodes, and the boxes around a point.
#include "tracer/analyze/hot_spots.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/analyze/epo.h"
#include "tracer/analyze/point_cost.h"
#include "tracer/analyze/surface_points.h"
#include "tracer/bvh/traverse.h"

namespace tracer::test {
namespace {

// A fine grid below a long thin triangle that runs across it from corner to corner.
Mesh grid_under_a_needle() {
  Mesh mesh = grid(20);
  const auto first = uint32_t(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {{0, 0, 0}, {1, 0.3f, 1}, {1, 0.3f, 0.99f}});
  mesh.triangles.push_back({first, first + 1, first + 2});
  return mesh;
}

struct Looked {
  explicit Looked(Mesh mesh, const BuildOptions& options = {}) {
    scene = scene_of({std::move(mesh)});
    look = look_of(scene);
    look.camera.eye = vec3(0.5f, 2.0f, 0.5f);
    look.camera.target = vec3(0.5f, 0.0f, 0.501f);
    render.width = render.height = 100;
    bvh = std::make_shared<const SceneBvh>(bvh_of(scene, options));
    inspection = std::make_shared<const Inspection>(inspect(bvh, nullptr, {}));
    const World world{scene, *bvh, look, render};
    counted = std::make_shared<const CountedVisits>(
        CountedVisits{bvh, count_visits(world, frame(look.camera, 100, 100), {})});
  }

  HotSpots spots(size_t most = 10) const {
    return hot_spots(scene, inspection, counted, int(RayClass::primary), most, {});
  }

  Scene scene;
  Look look;
  RenderOptions render;
  std::shared_ptr<const SceneBvh> bvh;
  std::shared_ptr<const Inspection> inspection;
  std::shared_ptr<const CountedVisits> counted;
};

TEST(HotSpots, TheTriangleThatLiesInTheWay) {
  const Looked looked(grid_under_a_needle());
  const uint32_t needle = uint32_t(looked.scene.meshes[0].triangles.size()) - 1;
  const HotSpots found = looked.spots();
  const auto at = std::find_if(found.spots.begin(), found.spots.end(), [](const HotSpot& spot) {
    return spot.cause == HotCause::large_triangle;
  });
  ASSERT_NE(at, found.spots.end());
  EXPECT_EQ(at->triangle, needle);
  EXPECT_GT(at->excess, 0.0);
  EXPECT_NE(at->text.find("1.45 long"), std::string::npos) << at->text;
  EXPECT_NE(at->text.find("pre-split"), std::string::npos) << at->text;
  EXPECT_EQ(1, std::count_if(found.spots.begin(), found.spots.end(),
                             [&](const HotSpot& spot) { return spot.triangle == needle; }));
}

TEST(HotSpots, AGridAloneHasNone) {
  const HotSpots found = Looked(grid(20)).spots();
  EXPECT_TRUE(std::none_of(found.spots.begin(), found.spots.end(), [](const HotSpot& spot) {
    return spot.cause == HotCause::large_triangle;
  }));
}

TEST(HotSpots, TrianglesUponEachOtherFillALeaf) {
  Mesh mesh = grid(8);
  for (int i = 0; i < 40; ++i)
    mesh.triangles.push_back(mesh.triangles[60]);
  BuildOptions options;
  options.max_leaf_size = 64;
  const HotSpots found = Looked(mesh, options).spots();
  ASSERT_FALSE(found.spots.empty());
  const auto full = std::find_if(found.spots.begin(), found.spots.end(), [](const HotSpot& spot) {
    return spot.cause == HotCause::full_leaf;
  });
  ASSERT_NE(full, found.spots.end());
  EXPECT_EQ(full->visits > full->predicted, true);
}

TEST(HotSpots, LargestFirstAndNoMoreThanAskedFor) {
  const HotSpots found = Looked(soup(2000, 0.3f)).spots(5);
  EXPECT_GE(found.spots.size(), 5u);
  EXPECT_LE(found.spots.size(), 10u);
  for (size_t i = 1; i < found.spots.size(); ++i)
    EXPECT_LE(found.spots[i].excess, found.spots[i - 1].excess);
  for (const HotSpot& spot : found.spots) {
    EXPECT_FALSE(spot.text.empty());
    EXPECT_LE(spot.excess, 1.0);
  }
}

TEST(HotSpots, NothingForVisitsOfOtherTrees) {
  const Looked looked(grid(8));
  auto other = std::make_shared<Inspection>(*looked.inspection);
  other->bvh = std::make_shared<const SceneBvh>(*looked.bvh);
  EXPECT_TRUE(hot_spots(looked.scene, other, looked.counted, 0, 10, {}).spots.empty());
}

// EPO is the mean of the cost at points spread over the surface.
TEST(PointCost, ItsMeanIsEpo) {
  const Scene scene = scene_of({soup(800, 0.4f)});
  const SceneBvh bvh = bvh_of(scene);
  const Mesh& mesh = scene.meshes[0];
  const AreaTable areas = area_table(mesh);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit;
  double sum = 0.0;
  constexpr int points = 40000;
  for (int i = 0; i < points; ++i) {
    Hit hit;
    hit.instance = 0;
    hit.triangle = choose(areas.sums, unit(random)).index;
    const float root = std::sqrt(unit(random)), v = unit(random);
    hit.u = root * (1.0f - v);
    hit.v = root * v;
    sum += point_cost(scene, bvh, hit).cost;
  }
  const Epo expected = blas_epo(scene, bvh, epo_limits, {});
  EXPECT_NEAR(sum / points, expected.value, 0.03 * expected.value);
}

TEST(PointCost, BoxesByHand) {
  // Two triangles in the planes z = 0 and z = 1 of boxes that do not meet.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  const Scene scene = scene_of({mesh, mesh});  // the second lies in the same place
  BuildOptions options;
  options.max_leaf_size = 1;
  options.traversal_cost = 2.0f;
  options.intersection_cost = 3.0f;
  const SceneBvh bvh = bvh_of(scene, options);
  Hit hit;
  hit.instance = 0;
  hit.triangle = 1;
  hit.u = hit.v = 0.25f;
  const PointCost found = point_cost(scene, bvh, hit);
  // The TLAS's root and two leaves, then root and leaf of each instance.
  EXPECT_EQ(found.boxes, 7u);
  EXPECT_EQ(found.useless, 3u) << "leaf, root and leaf of the other instance";
  EXPECT_NEAR(found.cost, 3.0 + 2.0 + 3.0, 1e-6);
}

}  // namespace
}  // namespace tracer::test
