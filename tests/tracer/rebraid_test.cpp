// Re-braiding: what is opened, and that nothing else changes by it.
#include "tracer/bvh/rebraid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "rebraided.h"
#include "tracer/analyze/box_set.h"
#include "tracer/analyze/overlap.h"
#include "tracer/analyze/point_cost.h"
#include "tracer/analyze/ray_words.h"
#include "tracer/analyze/replay.h"
#include "tracer/bvh/ray_kernels.h"
#include "tracer/bvh/refit.h"
#include "tracer/bvh/trace.h"
#include "tracer/pipeline.h"
#include "tracer/scene/builtin.h"
#include "wide_layouts.h"

namespace tracer::test {
namespace {

BuildOptions rebraiding(std::string layout = "binary") {
  BuildOptions options;
  options.rebraid = true;
  options.layout = std::move(layout);
  return options;
}

class EveryRebraidedLayout : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Rebraid, EveryRebraidedLayout,
                         testing::Values("binary", "wide4", "wide8", "quantised8"),
                         [](const auto& layout) { return layout.param; });

void expect_hits_of_brute_force(const Scene& scene, const SceneBvh& bvh) {
  const std::vector<Ray> rays = rays_through(bounds(bvh), ray_count(500));
  std::vector<Hit> expected;
  for (const Ray& ray : rays)
    expected.push_back(brute_force(scene, bvh, ray));
  for (const KernelRow& kernel : ray_kernels()) {
    const RayKernel run = ray_kernel(bvh.options.layout, kernel.id);
    std::vector<Hit> hits(rays.size());
    std::vector<uint8_t> blocked(rays.size());
    run.intersect(bvh, rays, hits);
    run.occluded(bvh, rays, blocked);
    for (size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(hits[i], expected[i]) << kernel.id << " ray " << i;
      ASSERT_EQ(blocked[i] != 0, is_hit(expected[i])) << kernel.id << " ray " << i;
    }
  }
}

TEST_P(EveryRebraidedLayout, HitsWhatBruteForceDoes) {
  const Scene scene = crowd();
  for (const char* builder : {"binned", "sbvh", "agglomerative"}) {
    SCOPED_TRACE(builder);
    BuildOptions options = rebraiding(GetParam());
    options.builder = builder;
    options.presplit = true;
    const SceneBvh bvh = bvh_of(scene, options);
    EXPECT_GT(bvh.tlas.references.size(), scene.instances.size());
    expect_hits_of_brute_force(scene, bvh);
  }
}

// What rays entered before is no matter to a tree that is built anew for each frame.
TEST_P(EveryRebraidedLayout, HitsWhatBruteForceDoesAfterARefit) {
  const Scene scene = crowd();
  const BuildOptions options = rebraiding(GetParam());
  Scene moved = scene;
  auto blases = build_blases(scene, options, nullptr, {});
  for (size_t i = 0; i < blases.size(); ++i) {
    for (vec3& position : moved.meshes[i].positions)
      position = vec3(position.x + 0.4f * position.y, 1.3f * position.y, position.z);
    blases[i] = refitted(*blases[i], moved.meshes[i]);
  }
  const SceneBvh bvh = place_instances(moved, blases, options, 0.0f);
  EXPECT_FALSE(bvh.entries.empty());
  expect_hits_of_brute_force(moved, bvh);
}

TEST_P(EveryRebraidedLayout, HitsTheSameOnEveryInstructionSet) {
  expect_the_binary_hits(bvh_of(crowd(), rebraiding(GetParam())));
}

TEST(Rebraid, OpensAsManyAsTheBudgetAllows) {
  const Scene scene = crowd();
  for (const LayoutRow& layout : layouts()) {
    const SceneBvh bvh = bvh_of(scene, rebraiding(std::string(layout.id)));
    EXPECT_GT(bvh.entries.size(), scene.instances.size()) << layout.id;
    EXPECT_LE(bvh.entries.size(), rebraid_budget * scene.instances.size()) << layout.id;
    EXPECT_EQ(bvh.entries.size(), bvh.tlas.references.size()) << layout.id;
  }
}

TEST(Rebraid, LeavesWhatFillsItsBoxAlone) {
  Scene scene = scene_of({sphere(8), grid(8)});
  for (size_t i = 0; i < 10; ++i) {
    scene.instances.push_back(scene.instances[i]);
    scene.instances.back().transform = moved(vec3(0.3f * float(i), 0.0f, 0.0f));
  }
  const SceneBvh braided = bvh_of(scene, rebraiding());
  const SceneBvh plain = bvh_of(scene);
  EXPECT_TRUE(braided.entries.empty());
  EXPECT_EQ(braided.tlas.references, plain.tlas.references);
}

// A stick fills its box where it lies along an axis.
TEST(Rebraid, DependsOnHowAnInstanceStands) {
  Scene scene = scene_of({stick(), stick()});
  const float askew = std::acos(1.0f / std::sqrt(3.0f));  // the diagonal to an axis
  scene.instances[1].transform = glm::rotate(mat4(1.0f), askew, vec3(0, 1, -1));
  for (const LayoutRow& layout : layouts()) {
    const SceneBvh bvh = bvh_of(scene, rebraiding(std::string(layout.id)));
    const std::vector<uint32_t>& instances = bvh.tlas.references;
    EXPECT_GT(std::count(instances.begin(), instances.end(), 0u), 1) << layout.id;
    EXPECT_EQ(std::count(instances.begin(), instances.end(), 1u), 1) << layout.id;
  }
}

TEST(Rebraid, LeavesASingleInstanceAlone) {
  EXPECT_TRUE(bvh_of(scene_of({stick()}), rebraiding()).entries.empty());
  EXPECT_TRUE(bvh_of(Scene{}, rebraiding()).tlas.nodes.empty());
}

TEST(Rebraid, LeavesLeavesAlone) {
  const Scene scene = scene_of({soup(1, 1.0f), soup(1, 1.0f)});
  for (const LayoutRow& layout : layouts())
    EXPECT_TRUE(bvh_of(scene, rebraiding(std::string(layout.id))).entries.empty());
}

TEST_P(EveryRebraidedLayout, IsTheSameForAnyNumberOfThreads) {
  const Scene scene = crowd();
  const auto build_with = [&](size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return bvh_of(scene, rebraiding(GetParam()));
  };
  const SceneBvh one = build_with(1), many = build_with(4);
  EXPECT_FALSE(one.entries.empty());
  EXPECT_EQ(one.entries, many.entries);
  EXPECT_EQ(one.tlas.references, many.tlas.references);
}

TEST_P(EveryRebraidedLayout, BoxesHoldThePartsToTheBit) {
  const SceneBvh bvh = bvh_of(crowd(), rebraiding(GetParam()));
  const TlasInput input = tlas_input(bvh);
  std::vector<uint32_t> nodes;
  for (const EntryPoint& entry : input.entries)
    nodes.push_back(entry.node);
  const std::vector<Box> parts = part_boxes(bvh, input.instances, nodes);
  for (size_t i = 0; i < parts.size(); ++i)
    EXPECT_TRUE(contains(input.boxes[i], parts[i])) << i;
}

struct Cost {
  double nodes = 0.0, instances = 0.0;
};
Cost cost_of_rays(const SceneBvh& bvh) {
  Counters counters;
  CountProbe probe(counters);
  const std::vector<Ray> rays = rays_through(bounds(bvh), 4096);
  for (const Ray& ray : rays)
    trace<false>(bvh, ray, probe);
  return {double(counters.nodes + counters.leaves) / double(rays.size()),
          double(counters.instances) / double(rays.size())};
}

TEST_P(EveryRebraidedLayout, RaysEnterFewerInstancesThatAreLongAndTurned) {
  const Scene scene = crowd();
  BuildOptions options = rebraiding(GetParam());
  const Cost braided = cost_of_rays(bvh_of(scene, options));
  options.rebraid = false;
  const Cost plain = cost_of_rays(bvh_of(scene, options));
  EXPECT_LT(braided.nodes, 0.9 * plain.nodes);
  EXPECT_LT(braided.instances, 0.6 * plain.instances);
}

TEST_P(EveryRebraidedLayout, TheBuiltInSticksAreCutAndCostLess) {
  const Scene scene = make_builtin_scene(parse_scene_source("sticks"), {});
  BuildOptions options = rebraiding(GetParam());
  const SceneBvh braided = bvh_of(scene, options);
  EXPECT_GT(braided.entries.size(), 8 * scene.instances.size());
  options.rebraid = false;
  EXPECT_LT(cost_of_rays(braided).nodes, 0.7 * cost_of_rays(bvh_of(scene, options)).nodes);
}

// The tools that look at a TLAS.

TEST_P(EveryRebraidedLayout, BoxesBeginWhereRaysDo) {
  const auto bvh = std::make_shared<const SceneBvh>(bvh_of(crowd(), rebraiding(GetParam())));
  BoxOptions options;
  options.what = "all";
  options.last_level = max_box_level;
  const NodeBoxes boxes = node_boxes(bvh, options, {});
  std::vector<size_t> lowest(bvh->instances.size(), 0);
  size_t entered = 0;
  for (size_t place = 0; place < bvh->entries.size(); ++place) {
    const uint32_t instance = bvh->tlas.references[place];
    const NodePlace at = {bvh->instances[instance].mesh, bvh->entries[place].node};
    for (const NodeBox& box : boxes.boxes)
      entered += box.place == at && box.instance == instance ? 1 : 0;
  }
  EXPECT_EQ(entered, bvh->entries.size());
  EXPECT_FALSE(boxes.at_least);
}

TEST_P(EveryRebraidedLayout, RootsAreVisitedAsOftenAsTheirPartsSay) {
  const auto bvh = std::make_shared<const SceneBvh>(bvh_of(crowd(), rebraiding(GetParam())));
  const Inspection inspection = inspect(bvh, nullptr, {});
  ASSERT_EQ(inspection.entered.size(), bvh->blases.size());
  EXPECT_EQ(references_name(*inspection.tlas), "parts of instances");
  for (uint32_t mesh = 0; mesh < bvh->blases.size(); ++mesh) {
    const TreeTable& table = *inspection.blases[mesh];
    // Visits as of random lines through the root's box.
    std::vector<uint32_t> visits;
    for (uint32_t node = 0; node < table.nodes.size(); ++node)
      visits.push_back(uint32_t(1e9 * area_share(table, node)));
    visits[0] = 0;
    if (inspection.entered[mesh] == std::vector<uint32_t>{0}) continue;
    EXPECT_NEAR(root_visits(inspection, mesh, visits), 1e9, 1e5);
  }
}

TEST_P(EveryRebraidedLayout, StepsKnowTheirDepthAndWhereTheyBegin) {
  const auto bvh = std::make_shared<const SceneBvh>(bvh_of(crowd(), rebraiding(GetParam())));
  const Inspection inspection = inspect(bvh, nullptr, {});
  size_t below_roots = 0;
  for (const Ray& ray : rays_through(bounds(*bvh), 500)) {
    CastRay cast;
    cast.ray = ray;
    const LoggedRay logged = log_ray(*bvh, cast);
    for (size_t i = 0; i < logged.steps.size(); ++i) {
      const Step& step = logged.steps[i];
      const bool in_tlas = step.instance == none;
      const TreeTable& table =
          *table_of(inspection, in_tlas ? none : bvh->instances[step.instance].mesh);
      if (step.kind == StepKind::node || step.kind == StepKind::leaf) {
        ASSERT_EQ(step.depth, table.nodes[step.id].depth);
      }
      for (const TestedChild& child : tested_children(logged, i))
        ASSERT_EQ(table.nodes[child.node].parent, step.id);
      if (step.kind != StepKind::instance || step.from == 0) continue;
      ++below_roots;
      ASSERT_EQ(logged.steps[i + 1].id, step.from);
      EXPECT_EQ(is_untested(*bvh, logged, i + 1), GetParam() != "binary");
      EXPECT_THAT(explain(*bvh, logged, i), testing::HasSubstr("from node"));
    }
  }
  EXPECT_GT(below_roots, 100u);
}

TEST(Rebraid, InstancesOverlapAsMuchAsWithoutIt) {
  const Scene scene = crowd();
  const InstanceOverlap braided = instance_overlap(bvh_of(scene, rebraiding()), {});
  const InstanceOverlap plain = instance_overlap(bvh_of(scene), {});
  EXPECT_EQ(braided.mean, plain.mean);
  EXPECT_EQ(braided.mean_neighbours, plain.mean_neighbours);
}

TEST(Rebraid, APointCostsNothingUselessOnItsOwnWay) {
  const Scene scene = crowd();
  const SceneBvh braided = bvh_of(scene, rebraiding()), plain = bvh_of(scene);
  NoProbe probe;
  double with = 0.0, without = 0.0;
  for (const Ray& ray : rays_through(bounds(plain), 2000)) {
    const Hit hit = trace<false>(plain, ray, probe);
    if (!is_hit(hit)) continue;
    const PointCost cost = point_cost(scene, braided, hit);
    EXPECT_GE(cost.boxes, cost.useless);
    with += cost.cost;
    without += point_cost(scene, plain, hit).cost;
  }
  EXPECT_LT(with, without);
}

TEST(Rebraid, AReplayEndsWithTheTlas) {
  BuildOptions options = rebraiding();
  options.optimizer = "reinsertion";
  const auto bvh = std::make_shared<const SceneBvh>(bvh_of(crowd(), options));
  const Replay replay = replay_build(bvh, none, nullptr, {});
  EXPECT_EQ(replay.references[0], bvh->tlas.references.size());
  EXPECT_EQ(replay.same[0], 0u);
}

TEST(Rebraid, IsChangedWithoutBuildingTheTreesOfTheMeshes) {
  Settings settings;
  settings.source.name = "teapots";
  settings.render = {.width = 8, .height = 8, .ray_depth = 0, .samples = 1, .shadows = false};
  Pipeline pipeline;
  pipeline.run(settings, {}, [](const auto&) {});
  const auto before = pipeline.snapshot();
  settings.build.rebraid = true;
  pipeline.run(settings, {}, [](const auto&) {});
  const auto after = pipeline.snapshot();
  EXPECT_EQ(before->bvh->blases, after->bvh->blases);
  EXPECT_NE(before->bvh, after->bvh);
  EXPECT_TRUE(after->bvh->options.rebraid);
  EXPECT_TRUE(after->settings.build.rebraid);
}

}  // namespace
}  // namespace tracer::test
