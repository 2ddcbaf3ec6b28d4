// The Hot nodes and Replay panels.
#include <gtest/gtest.h>

#include "driver.h"
#include "ui/replay.h"

namespace {

using ui::Driver;

void inspect(Driver& driver) {
  const tracer::Snapshot& snapshot = *driver.snapshot;
  driver.work.inspection.result =
      std::make_shared<const tracer::Inspection>(tracer::inspect(snapshot.bvh, nullptr, {}));
}

void find_hot_spots(Driver& driver) {
  inspect(driver);
  const tracer::Snapshot& snapshot = *driver.snapshot;
  const tracer::RenderOptions& options = snapshot.settings.render;
  const tracer::World world{*snapshot.scene, *snapshot.bvh, *snapshot.settings.look, options};
  driver.work.visits.result = std::make_shared<const tracer::CountedVisits>(tracer::CountedVisits{
      snapshot.bvh,
      tracer::count_visits(world, tracer::frame(world.look.camera, options.width, options.height),
                           {})});
  driver.work.hot_spots.result = std::make_shared<const tracer::HotSpots>(
      tracer::hot_spots(*snapshot.scene, driver.work.inspection.result, driver.work.visits.result,
                        tracer::ray_class_count, 20, {}));
}

void show_replay(Driver& driver, uint32_t mesh) {
  driver.state.replay.mesh = mesh;
  driver.state.replay.chosen = true;
  const tracer::Snapshot& snapshot = *driver.snapshot;
  const tracer::Mesh* built_over = mesh == tracer::none ? nullptr : &snapshot.scene->meshes[mesh];
  driver.work.replay.result = std::make_shared<const tracer::Replay>(
      tracer::replay_build(snapshot.bvh, mesh, built_over, {}));
  driver.show("replay");
}

TEST(HotPanel, AsksForWhatItShows) {
  Driver driver;
  driver.show("hot");
  EXPECT_TRUE(driver.requests.inspect);
  EXPECT_TRUE(driver.requests.count_visits);
  EXPECT_EQ(driver.requests.hot_spots, tracer::ray_class_count);
  driver.choose("hot/Rays", "shadow");
  driver.requests = {};
  driver.frame(2);
  EXPECT_EQ(driver.requests.hot_spots, int(tracer::RayClass::shadow));
}

TEST(HotPanel, AClickSelectsTheNode) {
  Driver driver;
  find_hot_spots(driver);
  driver.state.hot.with_cause = false;
  driver.show("hot");
  const auto& spots = driver.work.hot_spots.result->spots;
  ASSERT_FALSE(spots.empty());
  driver.click("hot/spot 1/row");
  const ui::NodePlace expected{spots[0].mesh, spots[0].node};
  EXPECT_EQ(driver.state.selection.node, expected);
}

TEST(HotPanel, LeavesOutWhatOnlyTheViewMakesHot) {
  Driver driver;
  find_hot_spots(driver);
  driver.show("hot");
  const auto& spots = driver.work.hot_spots.result->spots;
  size_t of_view = 0;
  while (of_view < spots.size() && spots[of_view].cause != tracer::HotCause::view)
    ++of_view;
  ASSERT_LT(of_view, spots.size());
  const std::string row = "hot/spot " + std::to_string(of_view + 1) + "/row";
  EXPECT_FALSE(driver.is_there(row));
  driver.state.hot.with_cause = false;
  driver.find(row);  // scrolled to
}

TEST(ReplayPanel, StepsSelectTheNodeTheyMake) {
  Driver driver;
  show_replay(driver, 0);
  const tracer::Replay& replay = *driver.work.replay.result;
  EXPECT_EQ(driver.requests.replay, 0u);
  EXPECT_EQ(driver.state.replay.step, step_count(replay)) << "begins with the finished tree";
  driver.click("replay/|<");
  EXPECT_EQ(driver.state.replay.step, 0u);
  EXPECT_FALSE(driver.state.selection.node);
  driver.click("replay/>");
  driver.click("replay/>");
  const ui::NodePlace second{0, replay.same[replay.log.order[1]]};
  EXPECT_EQ(driver.state.selection.node, second);
  driver.frame();
  EXPECT_EQ(driver.state.replay.boxes, boxes_after(replay, 2, 400));
  driver.click("replay/<");
  EXPECT_EQ(driver.state.replay.step, 1u);
}

TEST(ReplayPanel, PlaysToTheEnd) {
  Driver driver;
  show_replay(driver, tracer::none);
  driver.state.replay.speed = 5000.0f;
  driver.click("replay/Play");
  driver.frame(10);
  EXPECT_FALSE(driver.state.replay.playing);
  EXPECT_EQ(driver.state.replay.step, step_count(*driver.work.replay.result));
}

TEST(ReplayPanel, GoesOnWithWhatTheOptimizerMoves) {
  Driver driver;
  driver.edited.settings.build.builder = "ploc";
  driver.edited.settings.build.optimizer = "reinsertion";
  driver.trace();
  show_replay(driver, 0);
  const tracer::Replay& replay = *driver.work.replay.result;
  ASSERT_FALSE(replay.log.moves.empty());
  ASSERT_TRUE(replay.finishes);
  driver.click("replay/<");  // what makes leaves
  driver.frame();
  EXPECT_TRUE(driver.is_there("replay/Moved"));
  EXPECT_TRUE(driver.is_there("replay/Round"));
  EXPECT_FALSE(driver.state.selection.node) << "of the tree that is being changed";
  driver.state.replay.step = replay.log.order.size();
  driver.frame(2);
  EXPECT_TRUE(driver.is_there("replay/Triangles"));
  EXPECT_FALSE(driver.is_there("replay/Moved"));
}

TEST(ReplayPanel, ShowsNothingOfATreeThatIsGone) {
  Driver driver;
  show_replay(driver, 0);
  EXPECT_TRUE(driver.is_there("replay/Play"));
  driver.edited.settings.build.builder = "midpoint";
  driver.trace();
  driver.frame(2);
  EXPECT_FALSE(driver.is_there("replay/Play"));
}

}  // namespace
