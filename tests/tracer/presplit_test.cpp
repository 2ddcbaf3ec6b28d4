// Pre-splitting: which triangles become several references.
#include "tracer/bvh/presplit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/pipeline.h"

namespace tracer::test {
namespace {

constexpr uint32_t wall = 0, needle = 1;

// A large triangle in the plane of two axes, and a thin one along the diagonal.
Mesh wall_and_needle() {
  Mesh mesh = soup(2, 1.0f);
  mesh.positions = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 0}, {9, 9, 9}, {9, 9, 8.9f}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  return mesh;
}

std::array<size_t, 2> pieces(float budget, float most_filled) {
  const Mesh mesh = wall_and_needle();
  const std::vector<Box> boxes = boxes_of(mesh);
  const SplitBoxes split = presplit(mesh, boxes, budget, most_filled, {});
  std::array<size_t, 2> count{};
  for (size_t i = 0; i < split.boxes.size(); ++i) {
    const Box& part = split.boxes[i];
    EXPECT_EQ(united(part, boxes[split.primitives[i]]), boxes[split.primitives[i]]);
    ++count[split.primitives[i]];
  }
  return count;
}

TEST(Presplit, SplitsAllLargeTrianglesThatFillLessThanTheirBox) {
  const auto count = pieces(10.0f, 1.0f);
  EXPECT_GT(count[wall], 2u);
  EXPECT_GT(count[needle], 2u);
  EXPECT_LE(count[wall] + count[needle], 22u);
}

TEST(Presplit, LeavesFlatOnesToABuilderThatSplitsSpace) {
  const auto count = pieces(10.0f, 0.1f);
  EXPECT_EQ(count[wall], 1u);
  EXPECT_GT(count[needle], 10u);
}

TEST(Presplit, NothingIsSplitWithoutABudget) {
  EXPECT_THAT(pieces(0.0f, 1.0f), testing::ElementsAre(1u, 1u));
}

// Both as they are used: walls are no business of a pre-split before SBVH.
TEST(Presplit, BuildsKnowWhatComesLater) {
  const Mesh mesh = wall_and_needle();
  const std::vector<Box> boxes = boxes_of(mesh);
  BuildOptions options;
  options.presplit = true;
  options.split_budget = 4.0f;
  options.collapse = false;
  const auto walls = [&](const char* builder) {
    options.builder = builder;
    const Bvh bvh = build({boxes, &mesh}, options, nullptr, {});
    return std::count(bvh.references.begin(), bvh.references.end(), wall);
  };
  EXPECT_GT(walls("binned"), 1);
  options.min_overlap = 1.0f;  // no spatial splits: what there is comes from before
  EXPECT_EQ(walls("sbvh"), 1);
}

double nodes_per_primary_ray(const BuildOptions& build, double& references) {
  Settings settings;
  settings.source.name = "needles";
  settings.build = build;
  settings.render = {.width = 160, .height = 90, .ray_depth = 0, .samples = 1, .shadows = false};
  Pipeline pipeline;
  pipeline.run(settings, {}, [](const auto&) {});
  const auto snapshot = pipeline.snapshot();
  references = double(snapshot->bvh->blases[0]->tree.references.size());
  return (*snapshot->ray_statistics)[size_t(RayClass::primary)].nodes.mean;
}

// Long thin triangles that cross everywhere are what splitting is for.
TEST(Presplit, NeedlesCostAThirdLessWithSpatialSplitsAndReinsertion) {
  double whole = 0.0, split = 0.0;
  const double binned = nodes_per_primary_ray({}, whole);
  BuildOptions options;
  options.builder = "sbvh";
  options.presplit = true;
  options.optimizer = "reinsertion";
  options.reinsertion_share = 1.0f;
  EXPECT_LT(nodes_per_primary_ray(options, split), 0.65 * binned);
  EXPECT_LT(split, 1.3 * whole);
}

}  // namespace
}  // namespace tracer::test
