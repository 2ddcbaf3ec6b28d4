#include "tracer/analyze/epo.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "make_scene.h"

namespace tracer::test {
namespace {

constexpr SampleLimits accurate = {.relative_error = 0.002, .max_samples = 1 << 22};

BvhNode inner(vec3 lo, vec3 hi, uint32_t left) {
  return {lo, left, hi, 0};
}
BvhNode leaf(vec3 lo, vec3 hi, uint32_t first, uint32_t count) {
  return {lo, first, hi, count};
}

// Right triangles in the plane y = height, whose legs along x and z begin at `corner`.
Mesh flat_triangles(std::vector<vec3> corners, float leg = 1.0f) {
  Mesh mesh;
  for (const vec3& corner : corners) {
    const auto first = uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(),
                          {corner, corner + vec3(leg, 0, 0), corner + vec3(0, 0, leg)});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

TEST(Epo, DisjointLeavesHaveNone) {
  const Mesh mesh = flat_triangles({{0, 0, 0}, {5, 1, 0}});
  const Bvh tree{{inner({0, 0, 0}, {6, 1, 1}, 1), leaf({0, 0, 0}, {1, 0, 1}, 0, 1),
                  leaf({5, 1, 0}, {6, 1, 1}, 1, 1)},
                 {0, 1},
                 1};
  const Epo result = epo(mesh, tree, 1.2f, 1.0f, accurate, {});
  EXPECT_EQ(result.value, 0.0);
  EXPECT_EQ(result.standard_error, 0.0);
  EXPECT_GT(result.samples, 0u);
}

TEST(Epo, OneLeafHasNone) {
  const Mesh mesh = flat_triangles({{0, 0, 0}, {0, 1, 0}});
  const Bvh tree{{leaf({0, 0, 0}, {1, 1, 1}, 0, 2)}, {0, 1}, 0};
  EXPECT_EQ(epo(mesh, tree, 1.2f, 1.0f, accurate, {}).value, 0.0);
}

// Twice the same triangle: every point is in the other leaf, whose cost is 3.
TEST(Epo, IdenticalTrianglesPayForEachOther) {
  const Mesh mesh = flat_triangles({{0, 0, 0}, {0, 0, 0}});
  const vec3 lo(0.0f);
  const vec3 hi(1, 0, 1);
  const Bvh tree{{inner(lo, hi, 1), leaf(lo, hi, 0, 1), leaf(lo, hi, 1, 1)}, {0, 1}, 1};
  const Epo result = epo(mesh, tree, 1.2f, 3.0f, accurate, {});
  EXPECT_DOUBLE_EQ(result.value, 3.0);
  EXPECT_EQ(result.standard_error, 0.0);
}

// Two copies of a tree stacked into each other: a point of one is wasted on the other's inner node
// and on its leaf in the same place.
TEST(Epo, TwoIdenticalTreesStacked) {
  const Mesh mesh = flat_triangles({{0, 0, 0}, {2, 0, 0}, {0, 0, 0}, {2, 0, 0}});
  const vec3 hi(3, 0, 1);
  const BvhNode near = leaf(vec3(0), {1, 0, 1}, 0, 1);
  const BvhNode far = leaf({2, 0, 0}, hi, 1, 1);
  Bvh tree{
      {inner(vec3(0), hi, 1), inner(vec3(0), hi, 3), inner(vec3(0), hi, 5), near, far, near, far},
      {0, 1, 2, 3},
      2};
  tree.nodes[5].first = 2;
  tree.nodes[6].first = 3;
  const Epo result = epo(mesh, tree, 2.0f, 5.0f, accurate, {});
  EXPECT_NEAR(result.value, 7.0, 1e-9);
  // By node: half of the points are wasted on each inner child, a quarter on each leaf.
  ASSERT_EQ(result.node_shares.size(), 1u);
  const std::vector<float>& shares = result.node_shares[0];
  EXPECT_EQ(shares[0], 0.0f);
  EXPECT_NEAR(shares[1], 1.0f, 0.02f);
  EXPECT_NEAR(shares[2], 1.0f, 0.02f);
  for (size_t i = 3; i < 7; ++i)
    EXPECT_NEAR(shares[i], 1.25f, 0.03f) << i;
}

// Of a right triangle with legs of length 1, the part with x > 1/2 is a quarter.
TEST(Epo, PartOfATriangleByHand) {
  const Mesh mesh = flat_triangles({{0, 0, 0}, {9, 0, 9}});
  const Bvh tree{{inner(vec3(0), {10, 0, 10}, 1), leaf(vec3(0), {1, 0, 1}, 0, 1),
                  leaf(vec3(0.0f, 0.0f, 0.0f), {10, 0, 10}, 1, 1)},
                 {0, 1},
                 1};
  Bvh half = tree;
  half.nodes[2].lo = {0.5f, 0.0f, 0.0f};
  // All of the first triangle is in the second leaf: half of the surface.
  EXPECT_NEAR(epo(mesh, tree, 1.0f, 1.0f, accurate, {}).value, 0.5, 0.005);
  // Only its tip: a quarter of the half.
  EXPECT_NEAR(epo(mesh, half, 1.0f, 1.0f, accurate, {}).value, 0.125, 0.001);
}

TEST(Epo, ATriangleInTwoLeavesHasTwoLinesOfAncestors) {
  // Triangle 0 is in both leaves, triangle 1 in the second only.
  const Mesh mesh = flat_triangles({{0, 0, 0}, {0, 0, 0}});
  const vec3 hi(1, 0, 1);
  const Bvh tree{
      {inner(vec3(0), hi, 1), leaf(vec3(0), hi, 0, 1), leaf(vec3(0), hi, 1, 2)}, {0, 1, 0}, 1};
  // Points of 0 are wasted nowhere; those of 1, the half, on the first leaf.
  EXPECT_NEAR(epo(mesh, tree, 1.0f, 4.0f, accurate, {}).value, 2.0, 0.02);
}

// The paper's way: triangles clipped to boxes.
double clipped_area(const Mesh& mesh, const uvec3& corners, const BvhNode& box) {
  std::vector<glm::dvec3> polygon;
  for (int k = 0; k < 3; ++k)
    polygon.emplace_back(mesh.positions[corners[k]]);
  for (int side = 0; side < 6; ++side) {
    const int axis = side % 3;
    const auto inside_by = [&](const glm::dvec3& p) {
      return side < 3 ? p[axis] - box.lo[axis] : box.hi[axis] - p[axis];
    };
    std::vector<glm::dvec3> rest;
    for (size_t i = 0; i < polygon.size(); ++i) {
      const glm::dvec3 p = polygon[i];
      const glm::dvec3 q = polygon[(i + 1) % polygon.size()];
      const double a = inside_by(p);
      const double b = inside_by(q);
      if (a >= 0.0) rest.push_back(p);
      if (a * b < 0.0) rest.push_back(p + a / (a - b) * (q - p));
    }
    polygon = rest;
  }
  glm::dvec3 sum(0.0);
  for (size_t i = 2; i < polygon.size(); ++i)
    sum += glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return 0.5 * glm::length(sum);
}

bool is_below(const Bvh& tree, uint32_t node, uint32_t triangle) {
  const BvhNode& n = tree.nodes[node];
  if (!is_leaf(n))
    return is_below(tree, n.first, triangle) || is_below(tree, n.first + 1, triangle);
  for (uint32_t k = n.first; k < n.first + n.count; ++k) {
    if (tree.references[k] == triangle) return true;
  }
  return false;
}

double exact_epo(const Mesh& mesh, const Bvh& tree, double ct, double ci) {
  const BvhNode everywhere = inner(vec3(-1e9f), vec3(1e9f), 0);
  double area = 0.0;
  double sum = 0.0;
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    area += clipped_area(mesh, mesh.triangles[t], everywhere);
    for (uint32_t n = 0; n < tree.nodes.size(); ++n) {
      if (is_below(tree, n, t)) continue;
      const BvhNode& node = tree.nodes[n];
      sum += (is_leaf(node) ? node.count * ci : ct) * clipped_area(mesh, mesh.triangles[t], node);
    }
  }
  return sum / area;
}

TEST(Epo, EqualsClippingForEveryBuilder) {
  for (const Mesh& mesh : {soup(300, 0.3f), sphere(10, 1.0f, vec3(0.3f), 0.4f)}) {
    for (const BuilderRow& builder : builders()) {
      BuildOptions options;
      options.builder = builder.id;
      const Scene scene = scene_of({mesh});
      const SceneBvh bvh = bvh_of(scene, options);
      const Bvh& tree = bvh.blases[0]->tree;
      const Epo result = epo(mesh, tree, 1.2f, 1.0f, accurate, {});
      EXPECT_NEAR(result.value, exact_epo(mesh, tree, 1.2f, 1.0f), 5.0 * result.standard_error)
          << builder.id;
      EXPECT_LE(result.standard_error, 0.002 * result.value);
      double sum = 0.0;
      for (const float share : result.node_shares[0])
        sum += share;
      EXPECT_NEAR(sum, result.value, 1e-4 * result.value);
    }
  }
}

TEST(Epo, BlasesTogetherAreWeightedByTriangles) {
  const Scene scene = scene_of({soup(200, 0.3f), sphere(12, 5.0f, vec3(0.0f), 0.3f)});
  const SceneBvh bvh = bvh_of(scene);
  double sum = 0.0;
  double triangles = 0.0;
  for (size_t i = 0; i < 2; ++i) {
    const Mesh& mesh = scene.meshes[i];
    sum += exact_epo(mesh, bvh.blases[i]->tree, 1.2f, 1.0f) * double(mesh.triangles.size());
    triangles += double(mesh.triangles.size());
  }
  const Epo result = blas_epo(scene, bvh, accurate, {});
  EXPECT_NEAR(result.value, sum / triangles, 5.0 * result.standard_error);
  EXPECT_EQ(result.node_shares.size(), 2u);
}

TEST(Epo, SameForAnyNumberOfThreads) {
  const Scene scene = scene_of({soup(2000, 0.2f)});
  const SceneBvh bvh = bvh_of(scene);
  Epo first;
  for (const size_t threads : {1, 2, 5}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const Epo result = blas_epo(scene, bvh, epo_limits, {});
    if (threads == 1) first = result;
    EXPECT_EQ(result.value, first.value);
    EXPECT_EQ(result.samples, first.samples);
    EXPECT_EQ(result.node_shares, first.node_shares);
  }
}

TEST(Epo, AStopEndsIt) {
  std::stop_source stop;
  stop.request_stop();
  const Scene scene = scene_of({soup(100, 0.2f)});
  EXPECT_EQ(blas_epo(scene, bvh_of(scene), epo_limits, stop.get_token()).samples, 0u);
}

// Two squares in one place, one of them stretched to three times the area by its instance.
TEST(TlasEpo, CountsSurfaceInTheWorld) {
  Scene scene = scene_of({grid(1)});
  Instance stretched;
  stretched.transform[0] = vec4(3, 0, 0, 0);
  scene.instances.push_back(stretched);
  BuildOptions options;
  options.max_leaf_size = 1;
  options.intersection_cost = 2.0f;
  const SceneBvh bvh = bvh_of(scene, options);
  ASSERT_EQ(bvh.tlas.nodes.size(), 3u);
  // All of the small one (1 of 4) is in the other's box, and 1 of the 3 the other way round.
  const Epo result = tlas_epo(scene, bvh, accurate, {});
  EXPECT_NEAR(result.value, 2.0 * (1.0 + 1.0) / 4.0, 5.0 * result.standard_error + 1e-4);
}

}  // namespace
}  // namespace tracer::test
