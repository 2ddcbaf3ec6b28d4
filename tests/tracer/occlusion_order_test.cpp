// The order in which shadow rays visit the children of wide nodes.
#include "tracer/bvh/occlusion_order.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tracer/bvh/trace.h"
#include "wide_layouts.h"

namespace tracer::test {
namespace {

// A closed ball beside loose triangles: the slots of every node are in the order of priority.
TEST(OcclusionOrder, RanksByAreaOrByTheChanceToBlockForTheCost) {
  Mesh mesh = soup(2000, 0.05f);
  const auto shell = uint32_t(mesh.positions.size());
  const Mesh ball = sphere(16, 0.5f);
  for (const vec3& position : ball.positions)
    mesh.positions.push_back(position + vec3(4.0f, 0.0f, 0.0f));
  for (const uvec3& triangle : ball.triangles)
    mesh.triangles.push_back(triangle + shell);
  mesh.materials.resize(mesh.triangles.size());
  const Scene scene = scene_of({mesh});
  for (const OcclusionOrderRow& order : occlusion_orders()) {
    SCOPED_TRACE(order.id);
    BuildOptions options;
    options.layout = "wide8";
    options.occlusion_order = order.id;
    const SceneBvh bvh = bvh_of(scene, options);
    expect_the_binary_hits(bvh);
    const Blas& blas = *bvh.blases[0];
    const std::vector<float> priorities = occlusion_priorities(blas.tree, blas.triangles, options);
    if (order.id == "tree") {
      EXPECT_TRUE(priorities.empty());
      continue;
    }
    ASSERT_EQ(priorities.size(), blas.tree.nodes.size());
    const auto wide_slots = slots(blas.wide);
    ASSERT_GT(wide_slots.size(), size_t{100});
    for (size_t i = 1; i < wide_slots.size(); ++i) {
      if (wide_slots[i].parent != wide_slots[i - 1].parent) continue;
      EXPECT_GE(priorities[wide_slots[i].node], priorities[wide_slots[i - 1].node]) << i;
    }
  }
}

// Of a ray that nothing blocks all children that it meets are visited.
TEST(OcclusionOrder, VisitsTheLastSlotFirst) {
  BuildOptions options;
  options.layout = "wide8";
  const SceneBvh bvh = bvh_of(scene_of({soup(300, 0.05f)}), options);
  std::vector<uint32_t> under_root;
  for (const WideSlot& slot : slots(bvh.blases[0]->wide))
    if (slot.parent == 0) under_root.push_back(slot.node);
  size_t pairs = 0;
  for (const Ray& ray : rays_through(bounds(bvh), 500)) {
    LogProbe log;
    if (is_hit(trace<true>(bvh, ray, log))) continue;
    size_t last = under_root.size();
    for (const Step& step : log.steps) {
      if (step.instance == none || step.depth != 1 || step.result != StepResult::entered) continue;
      if (step.kind != StepKind::node && step.kind != StepKind::leaf) continue;
      const auto found = std::find(under_root.begin(), under_root.end(), step.id);
      ASSERT_NE(found, under_root.end());
      const auto slot = size_t(found - under_root.begin());
      pairs += last < under_root.size() ? 1 : 0;
      EXPECT_LT(slot, last);
      last = slot;
    }
  }
  EXPECT_GT(pairs, size_t{50});
}

// By hand: a random line through a unit cube meets a square from edge to edge of area sqrt(2)
// sqrt(2) / 3 times on average.
TEST(OcclusionOrder, ChanceToBlockIsThatOfRandomLines) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 1}, {1, 1, 1}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.materials.resize(2);
  BuildOptions options;
  options.max_leaf_size = 2;
  options.occlusion_order = "cost";
  options.builder = "lbvh";
  const auto blas = build_blas(mesh, options, nullptr, {});
  const auto area = float(std::sqrt(2.0));  // of both triangles
  const std::vector<float> priorities = occlusion_priorities(blas->tree, blas->triangles, options);
  ASSERT_EQ(blas->tree.nodes[0].count, 2u);
  EXPECT_NEAR(priorities[0], (1.0f - std::exp(-area / 3.0f)) / 2.0f, 1e-6f);
}

}  // namespace
}  // namespace tracer::test
