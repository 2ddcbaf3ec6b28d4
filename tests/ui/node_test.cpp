// The Node panel.
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "driver.h"
#include "tracer/analyze/frame_visits.h"
#include "ui/node_splits.h"

namespace {

using ui::Driver;
using ui::NodePlace;

class NodePanel : public testing::Test {
 protected:
  NodePanel() : driver("teapots:detail=2") {
    driver.work.inspection.result = std::make_shared<const tracer::Inspection>(
        tracer::inspect(driver.snapshot->bvh, nullptr, {}));
    driver.work.visits.result = std::make_shared<const tracer::CountedVisits>(
        tracer::CountedVisits{driver.snapshot->bvh, tracer::count_visits(world(), camera(), {})});
    driver.show("node");
  }

  tracer::World world() const {
    const tracer::Snapshot& snapshot = *driver.snapshot;
    return {*snapshot.scene, *snapshot.bvh, *snapshot.settings.look, snapshot.settings.render};
  }
  tracer::CameraFrame camera() const {
    return tracer::frame(driver.snapshot->settings.look->camera, driver.snapshot->film.width,
                         driver.snapshot->film.height);
  }
  const tracer::TreeTable& table(uint32_t mesh) const {
    return *table_of(*driver.work.inspection.result, mesh);
  }
  void select(const NodePlace& place) {
    driver.state.selection = {};
    driver.state.selection.node = place;
    driver.requests = {};
    driver.frame(3);
  }
  // What the program's background work does when it is asked.
  void split() {
    ASSERT_TRUE(driver.requests.node_splits);
    const NodePlace place = *driver.requests.node_splits;
    driver.work.splits.result = std::make_shared<const tracer::NodeSplits>(
        tracer::node_splits(*driver.snapshot->scene, driver.snapshot->bvh, table(place.mesh),
                            place.mesh, place.node, {}));
    driver.frame(3);
  }
  void watch() {
    ASSERT_TRUE(driver.requests.node_pixels);
    driver.work.node_pixels.result = std::make_shared<const ui::WatchedPixels>(
        ui::WatchedPixels{driver.snapshot->render_generation,
                          tracer::node_pixels(world(), driver.snapshot->bvh, camera(),
                                              *driver.requests.node_pixels, {})});
    driver.frame(3);
  }

  Driver driver;
};

TEST_F(NodePanel, WithoutASelectionItSaysWhatToDo) {
  EXPECT_FALSE(driver.is_there("node/Kind"));
  EXPECT_FALSE(driver.requests.node_splits);
}

TEST_F(NodePanel, ShowsTheBoxAndEveryMeasure) {
  select({0, 0});
  for (const char* label : {"Kind", "Lower", "Upper", "Extent", "Surface"})
    EXPECT_TRUE(driver.is_there(std::string("node/") + label)) << label;
  for (const tracer::NodeMeasureRow& measure : tracer::node_measures()) {
    if (measure.id == "kind") continue;
    EXPECT_TRUE(driver.is_there("node/" + std::string(measure.label))) << measure.id;
  }
}

TEST_F(NodePanel, LinksGoDownUpAndAcross) {
  select({0, 0});
  driver.click("node/links/child 1");
  const std::vector<uint32_t> children = table(0).children;
  EXPECT_EQ(driver.state.selection.node, (NodePlace{0, children[0]}));
  driver.click("node/links/sibling " + std::to_string(children[1]));
  EXPECT_EQ(driver.state.selection.node, (NodePlace{0, children[1]}));
  driver.hover("node/links/parent");
  EXPECT_EQ(driver.state.hovered.node, (NodePlace{0, 0}));
  driver.click("node/links/parent");
  EXPECT_EQ(driver.state.selection.node, (NodePlace{0, 0}));
}

TEST_F(NodePanel, LeadsToTheNodeThatHasTakenOneIn) {
  driver.edited.settings.build.layout = "wide8";
  driver.trace();
  driver.work.inspection.result = std::make_shared<const tracer::Inspection>(
      tracer::inspect(driver.snapshot->bvh, nullptr, {}));
  uint32_t lacking = 0;
  while (table(0).nodes[lacking].in_layout)
    ++lacking;
  select({0, lacking});
  EXPECT_FALSE(driver.requests.node_splits);
  driver.click("node/holder");
  EXPECT_EQ(driver.state.selection.node, (NodePlace{0, holder(table(0), lacking)}));
  driver.frame(2);
  EXPECT_TRUE(driver.is_there("node/links/child 8"));
  EXPECT_FALSE(driver.is_there("node/links/child 9"));

  driver.state.layout.left = 500.0f;
  driver.show("tree");
  driver.choose("tree/Tree", "mesh 0");
  driver.click("tree/Find");
  driver.type(fmt::format("n {}\n", lacking));
  driver.frame(3);
  EXPECT_EQ(driver.state.selection.node, (NodePlace{0, holder(table(0), lacking)}));
  EXPECT_NE(driver.state.tree.search.answer.find("it is in node"), std::string::npos)
      << driver.state.tree.search.answer;
}

TEST_F(NodePanel, OffersTheLeafOfAPickedTriangle) {
  driver.state.selection = {};
  driver.state.selection.instance = 2;
  driver.state.selection.triangle = 7;
  driver.frame(3);
  const uint32_t mesh = driver.snapshot->bvh->instances[2].mesh;
  const uint32_t leaf = leaves_of(table(mesh), 7)[0];
  driver.click("node/leaf " + std::to_string(leaf));
  EXPECT_EQ(driver.state.selection.node, (NodePlace{mesh, leaf}));
  EXPECT_EQ(driver.state.selection.instance, 2u) << "as this instance shows it";
  driver.click("node/triangle 7");
  EXPECT_EQ(driver.state.selection.triangle, 7u);
  EXPECT_EQ(driver.state.selection.node, (NodePlace{mesh, leaf})) << "the panel stays";
}

TEST_F(NodePanel, TheLeafOfAnInstanceListsIt) {
  const uint32_t leaf = leaves_of(table(tracer::none), 3)[0];
  select({tracer::none, leaf});
  driver.click("node/instance 3");
  EXPECT_EQ(driver.state.selection.instance, 3u);
}

TEST_F(NodePanel, AsksForPixelsOnlyWhileTheyAreShown) {
  select({0, 0});
  EXPECT_FALSE(driver.requests.node_pixels);
  driver.click("node/Show its pixels");
  EXPECT_EQ(driver.requests.node_pixels, (tracer::Watched{0, 0, tracer::none}));
  watch();
  uint64_t wanted = 0;  // pixels with a ray into the BLAS
  for (int y = 0; y < driver.snapshot->film.height; ++y) {
    for (int x = 0; x < driver.snapshot->film.width; ++x) {
      const auto facts = tracer::pixel(driver.snapshot->film, x, y);
      uint32_t entered = 0;
      for (const tracer::Counters& counters : *facts.counters)
        entered += counters.instances;
      wanted += entered > 0 ? 1 : 0;
    }
  }
  ASSERT_GT(driver.state.node.pixels, 0u);
  EXPECT_LE(driver.state.node.pixels, wanted);
  uint64_t covered = 0;
  for (const tracer::PixelBlock& block : driver.state.node.blocks)
    covered += uint64_t(block.x1 - block.x0) * uint64_t(block.y1 - block.y0);
  EXPECT_EQ(covered, driver.state.node.pixels);

  const uint64_t all = driver.state.node.pixels;
  driver.choose("node/Of", "shadow");
  driver.frame(2);
  EXPECT_LT(driver.state.node.pixels, all) << "not all that enter its box hit something";
  EXPECT_GT(driver.state.node.pixels, 0u);

  driver.state.selection.node = NodePlace{0, 1};
  driver.requests = {};
  driver.frame(2);
  EXPECT_EQ(driver.requests.node_pixels, (tracer::Watched{0, 1, tracer::none}));
}

TEST_F(NodePanel, WithAnInstanceSelectedOnlyItsRaysCount) {
  select({0, 0});
  driver.state.selection.instance = 4;
  driver.click("node/Show its pixels");
  EXPECT_EQ(driver.requests.node_pixels, (tracer::Watched{0, 0, 4}));
}

TEST_F(NodePanel, SplitsAreAskedForAndShown) {
  select({0, 0});
  EXPECT_EQ(driver.requests.node_splits, (NodePlace{0, 0}));
  EXPECT_FALSE(driver.is_there("node/splits/cost on X"));
  split();
  for (const char* axis : {"X", "Y", "Z"})
    EXPECT_TRUE(driver.is_there(std::string("node/splits/cost on ") + axis));
  driver.hover("node/splits/sweep/row");
  EXPECT_EQ(driver.state.node.lit_choice, "sweep");
  driver.hover("node/splits/cost on X");
  EXPECT_EQ(driver.state.node.lit_choice, "");
  driver.state.selection.node = NodePlace{0, 1};
  driver.frame(3);
  EXPECT_FALSE(driver.is_there("node/splits/cost on X")) << "those of another node are not shown";
}

TEST_F(NodePanel, AfterAnotherBuildNothingIsSelected) {
  select({0, 0});
  split();
  driver.edited.settings.build.builder = "median";
  driver.trace();
  driver.frame(3);
  EXPECT_FALSE(driver.state.selection.node);
  EXPECT_FALSE(driver.is_there("node/Kind"));
}

TEST(CostRange, HoldsTheLeafAndAllThatIsKnown) {
  tracer::NodeSplits splits;
  splits.leaf_cost = 10.0;
  splits.axes[1].objects = {NAN, 4.0, 7.0};
  splits.axes[1].space = {3.0, NAN, 12.0};
  const ui::CostRange range = ui::cost_range(splits);
  EXPECT_LT(range.lo, 3.0);
  EXPECT_GT(range.lo, 1.5);
  EXPECT_GT(range.hi, 12.0);
  EXPECT_LT(range.hi, 14.0);
}

}  // namespace
