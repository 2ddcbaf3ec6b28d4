#include "tracer/analyze/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/analyze/epo.h"
#include "tracer/analyze/quality.h"

namespace tracer::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Case {
  Scene scene = scene_of({soup(400, 0.2f)});
  Look look = look_of(scene);
  ComparisonView view;
  std::vector<BuildOptions> options;

  Case() {
    view.camera.eye = vec3(0.5f, 0.5f, 3.0f);
    view.camera.target = vec3(0.5f);
    view.width = 64;
    view.height = 48;
  }
  void add(const char* builder, const char* optimizer = "none") {
    options.emplace_back().builder = builder;
    options.back().optimizer = optimizer;
  }
  std::vector<ComparedBuild> compared(const Job& job = {}) const {
    return compare_builds(scene, look, options, view, job);
  }
};

TEST(Comparison, FiguresAreThoseOfTheTree) {
  Case of;
  of.add("binned");
  const ComparedBuild row = of.compared().at(0);
  const SceneBvh bvh = bvh_of(of.scene);
  const TreeStatistics tree = blas_statistics(bvh);
  EXPECT_EQ(row.state, BuildState::done);
  EXPECT_EQ(row.sah, tree.sah);
  EXPECT_EQ(row.nodes, tree.nodes);
  EXPECT_EQ(row.depth, tree.max_depth);
  EXPECT_EQ(row.bytes, tree.bytes);
  EXPECT_EQ(row.epo, blas_epo(of.scene, bvh, epo_limits, {}).value);
  EXPECT_EQ(row.builds, 5);
  EXPECT_GT(row.build_ms, 0.0);
  EXPECT_NEAR(row.mtris_per_s, 0.4 / row.build_ms, 1e-9);
  EXPECT_GT(row.nodes_per_ray, 1.0);
  EXPECT_GT(row.triangles_per_ray, 0.0);
  EXPECT_GT(row.mrays_per_s, 0.0);
  EXPECT_NEAR(measured_cost(row), double(1.2f) * row.nodes_per_ray + row.triangles_per_ray, 1e-9);
}

TEST(Comparison, EveryBuilderAndOptimizerHasARow) {
  Case of;
  for (const BuilderRow& builder : builders()) {
    for (const OptimizerRow& optimizer : optimizers())
      of.add(std::string(builder.id).c_str(), std::string(optimizer.id).c_str());
  }
  for (const ComparedBuild& row : of.compared()) {
    EXPECT_EQ(row.state, BuildState::done) << describe(row.options);
    for (const ComparisonColumn& column : comparison_columns())
      EXPECT_GT(column.value(row), 0.0) << describe(row.options) << ' ' << column.id;
  }
}

TEST(Comparison, RowsArePublishedOneAfterTheOther) {
  Case of;
  of.add("binned");
  of.add("median");
  std::vector<int> done;
  float last = -1.0f;
  const Job job{{}, [&](float fraction, std::string_view what) {
                  EXPECT_GE(fraction, last);
                  EXPECT_LE(fraction, 1.0f);
                  EXPECT_THAT(std::string(what), HasSubstr(": "));
                  last = fraction;
                }};
  compare_builds(
      of.scene, of.look, of.options, of.view, job, [&](const std::vector<ComparedBuild>& rows) {
        ASSERT_EQ(rows.size(), 2u);
        done.push_back(int(std::count_if(rows.begin(), rows.end(), [](const ComparedBuild& row) {
          return row.state == BuildState::done;
        })));
      });
  EXPECT_THAT(done, ElementsAre(1, 2));
}

TEST(Comparison, WhatCannotBeBuiltSaysWhyAndTheRestGoesOn) {
  Case of;
  of.add("no-such-builder");
  of.add("binned");
  const auto rows = of.compared();
  EXPECT_EQ(rows[0].state, BuildState::failed);
  EXPECT_THAT(rows[0].error, HasSubstr("no-such-builder"));
  EXPECT_EQ(rows[1].state, BuildState::done);
}

TEST(Comparison, AStopLeavesTheRestWaiting) {
  Case of;
  of.add("binned");
  of.add("median");
  std::stop_source stop;
  const auto rows =
      compare_builds(of.scene, of.look, of.options, of.view, {stop.get_token(), nullptr},
                     [&](const auto&) { stop.request_stop(); });
  EXPECT_EQ(rows[0].state, BuildState::done);
  EXPECT_EQ(rows[1].state, BuildState::waiting);
}

ComparedBuild built(double ms, double cost) {
  ComparedBuild row;
  row.state = BuildState::done;
  row.build_ms = ms;
  row.triangles_per_ray = cost;
  return row;
}

TEST(ParetoFront, HoldsWhatNoOtherBeatsInBoth) {
  std::vector<ComparedBuild> rows = {built(1, 30), built(2, 20), built(3, 25), built(4, 20),
                                     built(9, 10), built(9, 10), built(0, 0)};
  rows.back().state = BuildState::failed;
  EXPECT_THAT(pareto_front(rows), ElementsAre(true, true, false, false, true, true, false));
}

TEST(Describe, TheBuilderAndWhatIsNotAsByDefault) {
  BuildOptions options;
  EXPECT_EQ(describe(options), "binned");
  options.optimizer = "rotations";
  options.bins = 16;
  options.collapse = false;
  EXPECT_EQ(describe(options), "binned + rotations, collapse off, bins 16");
}

}  // namespace
}  // namespace tracer::test
