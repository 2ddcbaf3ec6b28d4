// Builds step by step.
#include "tracer/analyze/replay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "make_scene.h"
#include "tracer/analyze/tree_table.h"

namespace tracer::test {
namespace {

using testing::ElementsAre;
using testing::UnorderedElementsAre;

std::shared_ptr<const SceneBvh> shared_bvh(const Scene& scene, const BuildOptions& options) {
  return std::make_shared<const SceneBvh>(bvh_of(scene, options));
}

Replay replay_of(const Scene& scene, const BuildOptions& options) {
  return replay_build(shared_bvh(scene, options), 0, scene.meshes.data(), {});
}

Replay three_leaves_replayed() {
  auto bvh = std::make_shared<SceneBvh>();
  auto blas = std::make_shared<Blas>();
  blas->tree = three_leaves();
  bvh->blases.push_back(blas);
  bvh->options.traversal_cost = 2.0f;
  bvh->options.intersection_cost = 5.0f;
  return replay_build(bvh, 0, nullptr, {});
}

double sah_of(const SceneBvh& bvh) {
  return double(tree_table(bvh.blases[0]->tree, false, bvh.options.traversal_cost,
                           bvh.options.intersection_cost)
                    .nodes[0]
                    .sah);
}

// A triangle in the plane y = 0 from x to x + 1.
Mesh triangles_at(std::initializer_list<float> places) {
  Mesh mesh;
  for (const float x : places) {
    const auto first = uint32_t(mesh.positions.size());
    for (const vec3& corner : {vec3(x, 0, 0), vec3(x + 1, 0, 0), vec3(x, 0, 1)})
      mesh.positions.push_back(corner);
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    mesh.materials.push_back(0);
  }
  return mesh;
}

std::vector<float> widths_of_merges(const Replay& steps) {
  std::vector<float> widths;
  for (size_t step = 0; step < steps.log.order.size(); ++step) {
    const BvhNode& node = steps.log.nodes[node_of(steps, step)];
    widths.push_back(node.hi.x - node.lo.x);
  }
  return widths;
}

BuildOptions options_of(std::string_view builder, std::string_view optimizer) {
  BuildOptions options;
  options.builder = builder;
  options.optimizer = optimizer;
  return options;
}

// Calls function(options) for every builder with every optimizer, with and without making leaves.
template <class Function>
void for_each_build(const Function& function) {
  for (const BuilderRow& builder : builders()) {
    for (const OptimizerRow& optimizer : optimizers()) {
      for (const bool collapse : {false, true}) {
        BuildOptions options = options_of(builder.id, optimizer.id);
        options.collapse = collapse;
        SCOPED_TRACE(options.builder + " " + options.optimizer + (collapse ? " collapse" : ""));
        function(options);
      }
    }
  }
}

TEST(Replay, SplitsFromTheRootDown) {
  const Replay steps = three_leaves_replayed();
  EXPECT_THAT(steps.log.order, ElementsAre(0u, 2u));
  const auto& nodes = steps.log.nodes;
  EXPECT_THAT(boxes_after(steps, 0, 100), ElementsAre(box_of(nodes[0])));
  EXPECT_THAT(boxes_after(steps, 1, 100), UnorderedElementsAre(box_of(nodes[1]), box_of(nodes[2])));
  EXPECT_THAT(boxes_after(steps, 2, 100),
              UnorderedElementsAre(box_of(nodes[1]), box_of(nodes[3]), box_of(nodes[4])));
}

TEST(Replay, CostByHand) {
  const Replay steps = three_leaves_replayed();
  EXPECT_NEAR(steps.sah[0], 6 * 5.0, 1e-4);
  // Half areas 9; 3 with 1 reference, 7 with 5.
  EXPECT_NEAR(steps.sah[1], 2.0 + (3.0 * 1 * 5 + 7.0 * 5 * 5) / 9.0, 1e-4);
  EXPECT_NEAR(gain_of(steps, 0), 30.0 - double(steps.sah[1]), 1e-4);
}

TEST(Replay, AgglomerativeMergesTheNearestFirst) {
  BuildOptions options = options_of("agglomerative", "none");
  options.collapse = false;
  // Apart by 3 and by 2: not in the order of their places.
  const Replay steps = replay_of(scene_of({triangles_at({0, 3, 20, 22})}), options);
  EXPECT_TRUE(steps.bottom_up);
  EXPECT_THAT(widths_of_merges(steps), ElementsAre(3.0f, 4.0f, 23.0f));
  EXPECT_EQ(kind_of(steps, 0), BuildStep::merge);
  EXPECT_EQ(boxes_after(steps, 1, 100).size(), 3u);
  EXPECT_THAT(boxes_after(steps, 1, 1), ElementsAre(box_of(steps.log.nodes[steps.log.order[0]])));
  EXPECT_THAT(boxes_after(steps, 3, 100), ElementsAre(box_of(steps.log.nodes[0])));
}

TEST(Replay, PlocMergesInRounds) {
  BuildOptions options = options_of("ploc", "none");
  options.collapse = false;
  const Replay steps = replay_of(scene_of({triangles_at({0, 3, 20, 22})}), options);
  // By size the second would come first.
  EXPECT_THAT(widths_of_merges(steps), ElementsAre(4.0f, 3.0f, 23.0f));
  EXPECT_THAT(steps.log.rounds, ElementsAre(2u, 3u));
  EXPECT_EQ(round_of(steps, 1)->number, 1u);
  EXPECT_EQ(round_of(steps, 2)->number, 2u);
  EXPECT_EQ(round_of(steps, 2)->of, 2u);
}

TEST(Replay, EndsWithTheTree) {
  const Scene scene = scene_of({soup(3000, 0.1f)});
  for_each_build([&](const BuildOptions& options) {
    const Replay steps = replay_of(scene, options);
    EXPECT_NEAR(double(steps.sah.back()), sah_of(*steps.bvh), 1e-3 * sah_of(*steps.bvh));
    // Good trees may have nothing to be moved.
    if (options.builder == "lbvh") {
      EXPECT_EQ(!steps.log.moves.empty(), options.optimizer != "none");
    }
    EXPECT_EQ(step_count(steps), steps.log.order.size() + steps.log.moves.size() + steps.finishes);
    // Without a last step it is what the moves have saved that leads there.
    if (!options.collapse) {
      EXPECT_FALSE(steps.finishes);
    }
    if (options.collapse && steps.bottom_up) {
      EXPECT_TRUE(steps.finishes);
    }
    // Whatever the step, the boxes hold everything.
    for (const size_t step :
         {size_t{0}, step_count(steps) / 3, step_count(steps) - 1, step_count(steps)}) {
      const std::vector<Box> boxes = boxes_after(steps, step, SIZE_MAX);
      EXPECT_EQ(boxes.size(), box_count(steps, step));
      Box all;
      for (const Box& box : boxes)
        all = united(all, box);
      EXPECT_EQ(all, box_of(steps.bvh->blases[0]->tree.nodes[0]));
    }
  });
}

TEST(Replay, WhatIsBelowIsMadeFirstBottomUpAndLastTopDown) {
  const Scene scene = scene_of({soup(3000, 0.1f)});
  for_each_build([&](const BuildOptions& options) {
    const Replay steps = replay_of(scene, options);
    EXPECT_EQ(steps.log.order.size(), steps.log.nodes.size() / 2);
    for (const uint32_t node : steps.log.order) {
      for (const uint32_t side : {0u, 1u}) {
        const uint32_t child = steps.log.nodes[node].first + side;
        if (is_leaf(steps.log.nodes[child])) continue;
        EXPECT_EQ(steps.step_of[child] < steps.step_of[node], steps.bottom_up);
      }
    }
  });
}

TEST(Replay, TheLogChangesNoTreeAndIsTheSameForAnyNumberOfThreads) {
  const Scene scene = scene_of({soup(9000, 0.05f)});
  const std::vector<Box> boxes = boxes_of(scene.meshes[0]);
  for_each_build([&](const BuildOptions& options) {
    BuildSteps steps, alone;
    BuildLog log, log_alone;
    log.steps = &steps;
    log_alone.steps = &alone;
    const Bvh logged = build({boxes, scene.meshes.data()}, options, &log, {});
    const Bvh plain = build({boxes, scene.meshes.data()}, options, nullptr, {});
    tbb::task_arena(1).execute([&] {
      build({boxes, scene.meshes.data()}, options, &log_alone, {});
    });
    ASSERT_EQ(logged.nodes.size(), plain.nodes.size());
    for (size_t i = 0; i < plain.nodes.size(); ++i) {
      ASSERT_EQ(box_of(logged.nodes[i]), box_of(plain.nodes[i]));
      ASSERT_EQ(logged.nodes[i].first, plain.nodes[i].first);
    }
    EXPECT_EQ(steps.order, alone.order);
    EXPECT_EQ(steps.rounds, alone.rounds);
    EXPECT_EQ(steps.move_rounds, alone.move_rounds);
    ASSERT_EQ(steps.moves.size(), alone.moves.size());
    for (size_t i = 0; i < steps.moves.size(); ++i)
      ASSERT_EQ(steps.moves[i].moved, alone.moves[i].moved);
  });
}

TEST(Replay, AReinsertionGoesToWhereItSays) {
  const Scene scene = scene_of({soup(300, 0.2f)});
  BuildOptions options = options_of("lbvh", "reinsertion");
  options.reinsertion_share = 1.0f;
  options.reinsertion_rounds = 1;
  const Replay steps = replay_of(scene, options);
  const TreeMove* first = move_of(steps, steps.log.order.size());
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(kind_of(steps, steps.log.order.size()), BuildStep::reinsertion);
  EXPECT_GT(first->saved, 0.0f);
  // Before the first move all three boxes are nodes of the builder's tree, two of them siblings.
  const auto& nodes = steps.log.nodes;
  const auto is_node = [&](const Box& box) {
    return std::any_of(nodes.begin(), nodes.end(),
                       [&](const BvhNode& node) { return box_of(node) == box; });
  };
  EXPECT_TRUE(is_node(first->beside));
  bool siblings = false;
  for (uint32_t left = 1; left < nodes.size(); left += 2) {
    const Box a = box_of(nodes[left]), b = box_of(nodes[left + 1]);
    siblings = siblings || (a == first->moved && b == first->left) ||
               (b == first->moved && a == first->left);
  }
  EXPECT_TRUE(siblings);
}

TEST(Replay, ARotationMovesAChildBelowItsSibling) {
  const Replay steps = replay_of(scene_of({soup(300, 0.2f)}), options_of("lbvh", "rotations"));
  EXPECT_EQ(kind_of(steps, steps.log.order.size()), BuildStep::rotation);
  for (const TreeMove& move : steps.log.moves) {
    EXPECT_TRUE(contains(move.left, move.beside));
    EXPECT_GT(move.saved, 0.0f);
  }
}

TEST(Replay, NodesAreFoundInTheFinishedTree) {
  const Scene scene = scene_of({soup(3000, 0.1f)});
  const Replay splits = replay_of(scene, options_of("binned", "none"));
  for (uint32_t node = 0; node < splits.same.size(); ++node)
    EXPECT_EQ(splits.same[node], node);
  const Replay merges = replay_of(scene, options_of("ploc", "none"));
  const Bvh& tree = merges.bvh->blases[0]->tree;
  size_t found = 0;
  for (uint32_t node = 0; node < merges.same.size(); ++node) {
    if (merges.same[node] == none) continue;
    EXPECT_EQ(box_of(tree.nodes[merges.same[node]]), box_of(merges.log.nodes[node]));
    ++found;
  }
  EXPECT_EQ(found, tree.nodes.size());
}

TEST(Replay, OfARefittedTreeIsTheBuildBeforeIt) {
  const Scene scene = scene_of({sphere(20)});
  BuildOptions options = options_of("ploc", "none");
  options.collapse = false;  // or there would be a last step anyway
  const auto built = shared_bvh(scene, options);
  auto blas = std::make_shared<Blas>(*built->blases[0]);
  blas->built_areas = std::make_shared<const std::vector<float>>();
  for (BvhNode& node : blas->tree.nodes)
    node.hi.x += 1.0f;
  auto bvh = std::make_shared<SceneBvh>(*built);
  bvh->blases[0] = blas;
  const Replay steps = replay_build(bvh, 0, scene.meshes.data(), {});
  EXPECT_TRUE(steps.finishes);
  EXPECT_EQ(box_of(steps.log.nodes[0]), box_of(built->blases[0]->tree.nodes[0]));
  EXPECT_NEAR(double(steps.sah.back()), sah_of(*bvh), 1e-3 * sah_of(*bvh));
}

TEST(Replay, OfTheTopLevel) {
  const Scene scene = scene_of({sphere(4), sphere(4), sphere(4, 1.0f, vec3(5.0f)), sphere(4)});
  const auto bvh = shared_bvh(scene, options_of("agglomerative", "none"));
  const Replay steps = replay_build(bvh, none, nullptr, {});
  EXPECT_TRUE(steps.bottom_up);
  EXPECT_EQ(steps.log.order.size(), 3u);
  EXPECT_EQ(steps.references[0], 4u);
}

TEST(Replay, LeavesOutMovesBehindTheLimit) {
  BuildSteps steps;
  steps.moves.resize(most_moves - 1);
  for (int i = 0; i < 3; ++i)
    record_move(steps, {});
  EXPECT_EQ(steps.moves.size(), most_moves);
  EXPECT_EQ(steps.moves_left_out, 2u);
}

TEST(Replay, ShowsTheLargestBoxesIfThereAreTooMany) {
  const Replay steps = replay_of(scene_of({sphere(20)}), {});
  const std::vector<Box> all = boxes_after(steps, step_count(steps), SIZE_MAX);
  const std::vector<Box> some = boxes_after(steps, step_count(steps), 10);
  ASSERT_EQ(some.size(), 10u);
  for (size_t i = 0; i + 1 < all.size(); ++i)
    ASSERT_GE(half_area(all[i]), half_area(all[i + 1]));
  EXPECT_TRUE(std::equal(some.begin(), some.end(), all.begin()));
}

TEST(Replay, OfNothingAndOfOneLeaf) {
  auto bvh = std::make_shared<SceneBvh>();
  EXPECT_EQ(step_count(replay_build(bvh, none, nullptr, {})), 0u);
  for (const BuilderRow& builder : builders()) {
    const Replay steps = replay_of(scene_of({soup(1, 1.0f)}), options_of(builder.id, "none"));
    EXPECT_TRUE(steps.log.order.empty());
    EXPECT_EQ(step_count(steps), 0u);
    EXPECT_EQ(boxes_after(steps, 0, 10).size(), 1u);
  }
}

TEST(Replay, StoppedHasNoTree) {
  const Scene scene = scene_of({soup(300, 0.2f)});
  const auto bvh = shared_bvh(scene, options_of("ploc", "none"));
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(replay_build(bvh, 0, scene.meshes.data(), {stop.get_token(), {}}).bvh, nullptr);
}

}  // namespace
}  // namespace tracer::test
