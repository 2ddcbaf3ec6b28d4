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

// A fine grid below a long thin triangle that runs across it from its corner on, to the opposite
// one if `reach` is 1.
Mesh grid_under_a_needle(float reach = 1.0f) {
  Mesh mesh = grid(20);
  const auto first = uint32_t(mesh.positions.size());
  mesh.positions.insert(
      mesh.positions.end(),
      {{0, 0, 0}, {reach, 0.3f * reach, reach}, {reach, 0.3f * reach, 0.99f * reach}});
  mesh.triangles.push_back({first, first + 1, first + 2});
  return mesh;
}

struct Looked {
  explicit Looked(Mesh mesh, const BuildOptions& options = {})
      : Looked(std::vector<Mesh>{std::move(mesh)}, options) {}
  explicit Looked(std::vector<Mesh> meshes, const BuildOptions& options = {}) {
    scene = scene_of(std::move(meshes));
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

TEST(HotSpots, TheMostExpensiveOfManyNodesWithTheirShareOfTheCost) {
  const Looked looked(soup(60000, 0.03f));
  const HotSpots found = looked.spots(1000);
  ASSERT_GE(found.spots.size(), 1000u);
  const TreeTable& table = *looked.inspection->blases[0];
  const TreeTable& tlas = *looked.inspection->tlas;
  const auto cost_of = [](const TreeTable& of, uint32_t node) {
    return is_leaf(of.nodes[node]) ? of.nodes[node].references * double(of.intersection_cost)
                                   : double(of.traversal_cost);
  };
  const int primary = int(RayClass::primary);
  const std::vector<uint32_t> visits = tree_visits(*looked.counted->visits, 0, primary);
  const std::vector<uint32_t> tlas_visits = tree_visits(*looked.counted->visits, none, primary);
  double cost = 0.0;
  for (uint32_t node = 0; node < table.nodes.size(); ++node)
    cost += visits[node] * cost_of(table, node);
  for (uint32_t node = 0; node < tlas.nodes.size(); ++node)
    cost += tlas_visits[node] * cost_of(tlas, node);
  EXPECT_NEAR(found.cost, cost, 1e-6 * cost);
  size_t expensive = 0;
  for (uint32_t node = 0; node < table.nodes.size(); ++node) {
    if (is_leaf(table.nodes[node])) continue;
    const double excess =
        (visits[node] - visits[0] * area_share(table, node)) * cost_of(table, node) / cost;
    if (excess <= found.spots[999].excess) continue;
    ++expensive;
    const auto at = std::find_if(found.spots.begin(), found.spots.end(),
                                 [&](const HotSpot& spot) { return spot.node == node; });
    ASSERT_NE(at, found.spots.end()) << node;
    EXPECT_NEAR(at->excess, excess, 1e-6);
  }
  EXPECT_GT(expensive, 100u);
  const auto entered =
      std::count_if(visits.begin(), visits.end(), [](uint32_t n) { return n > 0; });
  EXPECT_GT(entered, 10000) << "more than are looked at";
}

TEST(HotSpots, ChildrenThatOverlap) {
  const HotSpots found = Looked(soup(500, 0.6f)).spots();
  const auto at = std::find_if(found.spots.begin(), found.spots.end(),
                               [](const HotSpot& spot) { return spot.cause == HotCause::overlap; });
  ASSERT_NE(at, found.spots.end());
  EXPECT_NE(at->text.find("in common"), std::string::npos) << at->text;
  for (const HotSpot& spot : Looked(grid(20)).spots().spots)
    EXPECT_NE(spot.cause, HotCause::overlap) << spot.text;
}

TEST(HotSpots, ABoxWithTwoCornersInUse) {
  // Looked at is the box around the two near ones; the far one makes the root larger.
  Mesh mesh = sphere(4, 0.05f, vec3(0.2f, 0.0f, 0.2f));
  for (const Mesh& other :
       {sphere(4, 0.05f, vec3(0.8f, 0.5f, 0.8f)), sphere(4, 0.05f, vec3(40.0f, 0.0f, 0.0f))}) {
    const auto first = uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    for (const uvec3& corners : other.triangles)
      mesh.triangles.push_back(corners + first);
  }
  mesh.materials.assign(mesh.triangles.size(), 0);
  mesh.normals.clear();
  mesh.uvs.clear();
  const HotSpots found = Looked(mesh).spots();
  EXPECT_TRUE(std::any_of(found.spots.begin(), found.spots.end(),
                          [](const HotSpot& spot) { return spot.cause == HotCause::empty_space; }));
}

TEST(HotSpots, AnInstanceThatIsLookedAt) {
  BuildOptions options;
  options.max_leaf_size = 1;
  Mesh small = grid(8);
  for (vec3& position : small.positions)
    position = 0.3f * position + vec3(0.35f, 0.1f, 0.35f);
  const Looked looked({grid(8), small}, options);
  const HotSpots found = looked.spots();
  const auto at = std::find_if(found.spots.begin(), found.spots.end(), [](const HotSpot& spot) {
    return spot.mesh == none && spot.cause == HotCause::instances && spot.triangle == 1;
  });
  EXPECT_NE(at, found.spots.end());
}

TEST(HotSpots, CountsTheLeavesInTheWayOfATriangle) {
  const Looked looked(grid_under_a_needle(0.4f));
  const HotSpots found = looked.spots();
  const auto at = std::find_if(found.spots.begin(), found.spots.end(), [](const HotSpot& spot) {
    return spot.cause == HotCause::large_triangle;
  });
  ASSERT_NE(at, found.spots.end());
  const TreeTable& table = *looked.inspection->blases[0];
  const Box& box = table.nodes[at->node].box;
  size_t all = 0, met = 0;
  for (const TableNode& row : table.nodes) {
    if (!is_leaf(row)) continue;
    ++all;
    if (!is_empty(intersected(row.box, box))) ++met;
  }
  EXPECT_LT(met, all);
  EXPECT_NE(at->text.find("in the way of " + std::to_string(met) + " leaves"), std::string::npos)
      << at->text << ", " << met << " expected";
}

TEST(HotSpots, PiecesOfOneTriangleAreOneSpot) {
  BuildOptions options;
  options.presplit = true;
  const Looked looked(grid_under_a_needle(), options);
  const HotSpots found = looked.spots(1000);
  const TreeTable& table = *looked.inspection->blases[0];
  for (const HotSpot& spot : found.spots) {
    if (spot.cause != HotCause::large_triangle) continue;
    const double own = (spot.visits - spot.predicted) * double(table.intersection_cost) *
                       table.nodes[spot.node].references / found.cost;
    EXPECT_GT(spot.excess, 1.5 * own) << spot.text;
    return;
  }
  ADD_FAILURE() << "no piece was found";
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

TEST(PointCost, OtherInstancesHaveTheirOwnSpace) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  Mesh right = mesh;  // where the point is as this instance sees it, and not as its own does
  right.positions = {{0.6f, 0, 0}, {1, 0, 0}, {0.6f, 1, 0}};
  Scene scene = scene_of({mesh, right});
  scene.instances[0].transform[3].x = 10.0f;
  scene.instances[1].transform[3].x = 9.5f;
  Hit hit;
  hit.instance = 0;
  hit.triangle = 0;
  hit.u = hit.v = 0.25f;
  // All three trees are one leaf.
  EXPECT_EQ(point_cost(scene, bvh_of(scene), hit).boxes, 3u);
}

}  // namespace
}  // namespace tracer::test
