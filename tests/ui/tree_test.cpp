// The Tree panel.
#include <gtest/gtest.h>

#include "driver.h"
#include "tracer/analyze/frame_visits.h"
#include "ui/layout.h"

namespace {

using ui::Driver;
using ui::NodePlace;

// What the program's background work would have found.
void inspect(Driver& driver) {
  driver.work.inspection.result = std::make_shared<const tracer::Inspection>(
      tracer::inspect(driver.snapshot->bvh, driver.work.inspection.result.get(), {}));
  const tracer::Snapshot& snapshot = *driver.snapshot;
  const tracer::World world{*snapshot.scene, *snapshot.bvh, *snapshot.settings.look,
                            snapshot.settings.render};
  const auto camera =
      tracer::frame(snapshot.settings.look->camera, snapshot.film.width, snapshot.film.height);
  driver.work.visits.result = std::make_shared<const tracer::CountedVisits>(
      tracer::CountedVisits{snapshot.bvh, tracer::count_visits(world, camera, {})});
}

class TreePanel : public testing::Test {
 protected:
  explicit TreePanel(std::string_view scene = "teapots:detail=2") : driver(scene) {
    inspect(driver);
    driver.state.layout.left = 500.0f;
    driver.show("tree");
  }
  const tracer::TreeTable& table() const { return *driver.state.tree.table; }
  uint32_t child(uint32_t node, size_t at = 0) const { return children_of(table(), node)[at]; }
  // One whose row is on the screen and has children.
  uint32_t inner_child() const {
    const uint32_t left = child(0);
    return is_leaf(table().nodes[left]) ? child(0, 1) : left;
  }
  void go_to_mesh(uint32_t mesh) { driver.choose("tree/Tree", "mesh " + std::to_string(mesh)); }
  std::string row(uint32_t node) const { return "tree/node " + std::to_string(node); }

  Driver driver;
};

TEST_F(TreePanel, AsksForTheNodesAndTheirVisits) {
  EXPECT_TRUE(driver.requests.inspect);
  EXPECT_TRUE(driver.requests.count_visits);
  driver.state.tree.columns = {"sah"};
  driver.requests = {};
  driver.frame(2);
  EXPECT_TRUE(driver.requests.inspect);
  EXPECT_FALSE(driver.requests.count_visits) << "no column shows them";
}

TEST_F(TreePanel, BeginsWithTheTlasOfManyInstances) {
  EXPECT_EQ(driver.state.tree.mesh, tracer::none);
  EXPECT_TRUE(driver.is_there(row(0) + "/row"));
  EXPECT_TRUE(table().tlas);
}

TEST_F(TreePanel, ArrowsOpenAndCloseDownToInstances) {
  uint32_t node = child(0);
  while (!is_leaf(table().nodes[node])) {
    driver.click(row(node) + "/arrow");
    node = child(node);
    ASSERT_TRUE(driver.is_there(row(node) + "/row"));
  }
  driver.click(row(node) + "/arrow");
  const uint32_t instance = table().references[table().nodes[node].first];
  EXPECT_TRUE(driver.is_there("tree/instance " + std::to_string(instance) + "/row"));
  EXPECT_FALSE(driver.state.selection.node) << "the arrow selects nothing";
  driver.click(row(0) + "/arrow");
  driver.frame(2);
  EXPECT_FALSE(driver.is_there(row(node) + "/row"));
}

TEST_F(TreePanel, AClickSelectsAndHoveringLightsUp) {
  const uint32_t node = inner_child();
  driver.click(row(node) + "/row");
  EXPECT_EQ(driver.state.selection.node, (NodePlace{tracer::none, node}));
  driver.hover(row(0) + "/row");
  EXPECT_EQ(driver.state.hovered.node, (NodePlace{tracer::none, 0}));
}

TEST_F(TreePanel, ADoubleClickOpensANode) {
  const uint32_t node = inner_child();
  driver.double_click(row(node) + "/row");
  EXPECT_TRUE(driver.is_there(row(child(node)) + "/row"));
}

TEST_F(TreePanel, ADoubleClickOnAnInstanceGoesIntoItsTreeAndLinksGoUp) {
  driver.state.selection.instance = 3;  // as another panel selects it
  driver.frame(3);
  ASSERT_TRUE(driver.is_there("tree/instance 3/row")) << "the list opens to it";
  driver.double_click("tree/instance 3/row");
  const uint32_t mesh = driver.snapshot->bvh->instances[3].mesh;
  EXPECT_EQ(driver.state.tree.mesh, mesh);
  EXPECT_EQ(driver.state.selection.instance, 3u);
  driver.frame(3);
  EXPECT_EQ(driver.state.tree.mesh, mesh) << "it stays there";
  EXPECT_FALSE(table().tlas);
  driver.click("tree/instance");
  driver.frame(3);
  EXPECT_EQ(driver.state.tree.mesh, tracer::none);
  EXPECT_TRUE(driver.is_there("tree/instance 3/row"));
  go_to_mesh(mesh);
  EXPECT_EQ(driver.state.tree.mesh, mesh);
  driver.click("tree/TLAS");
  EXPECT_EQ(driver.state.tree.mesh, tracer::none);
}

TEST_F(TreePanel, OpensToWhatAnotherPanelSelects) {
  const auto& nodes = driver.snapshot->bvh->blases[0]->tree.nodes;
  const auto node = static_cast<uint32_t>(nodes.size() - 1);
  driver.state.selection = {};
  driver.state.selection.node = NodePlace{0, node};
  driver.frame(3);
  EXPECT_EQ(driver.state.tree.mesh, 0u);
  EXPECT_TRUE(driver.is_there(row(node) + "/row"));
}

TEST_F(TreePanel, OpensToATriangleThatIsPickedInThePicture) {
  driver.state.selection = {};
  driver.state.selection.instance = 0;
  driver.state.selection.triangle = 7;
  driver.frame(3);
  EXPECT_EQ(driver.state.tree.mesh, driver.snapshot->bvh->instances[0].mesh);
  EXPECT_TRUE(driver.is_there("tree/triangle 7/row"));
}

TEST_F(TreePanel, SearchFindsNodesTrianglesAndInstances) {
  go_to_mesh(0);
  driver.click("tree/Find");
  driver.type("n 9\n");
  driver.frame(3);
  EXPECT_EQ(driver.state.selection.node, (NodePlace{0, 9}));
  EXPECT_TRUE(driver.is_there(row(9) + "/row"));

  driver.state.tree.search.text = "T11";
  driver.click("tree/Find");
  driver.type("\n");
  driver.frame(3);
  EXPECT_EQ(driver.state.selection.triangle, 11u);
  EXPECT_TRUE(driver.is_there("tree/triangle 11/row"));

  driver.state.tree.search.text = "5";
  driver.choose("tree/Kind", "instance");
  driver.click("tree/Find");
  driver.type("\n");
  driver.frame(3);
  EXPECT_EQ(driver.state.tree.mesh, tracer::none);
  EXPECT_EQ(driver.state.selection.instance, 5u);
  EXPECT_TRUE(driver.is_there("tree/instance 5/row"));
}

TEST_F(TreePanel, SearchSaysWhatItDoesNotFind) {
  ui::TreeSearch& search = driver.state.tree.search;
  for (const char* text : {"n 99999999", "t 3", "i 4000", "x 3", "n", "n 3 4", "99999999999"}) {
    search.text = text;
    driver.click("tree/Find");
    driver.type("\n");
    EXPECT_FALSE(search.answer.empty()) << text;
    EXPECT_FALSE(driver.state.selection.node) << text;
  }
  search.text.clear();
  driver.click("tree/Find");
  driver.type("\n");
  EXPECT_TRUE(search.answer.empty());
}

TEST_F(TreePanel, ColumnsAreChosenSortedAndRemembered) {
  EXPECT_TRUE(driver.is_there("tree/column/sah"));
  EXPECT_FALSE(driver.is_there("tree/column/overlap"));
  driver.click("tree/Columns...");
  driver.click("tree/columns/overlap");
  driver.click("tree/columns/visits");
  driver.click_at({700, 300});
  driver.frame(3);
  EXPECT_EQ(driver.state.tree.columns, (std::vector<std::string>{"sah", "references", "overlap"}));
  EXPECT_TRUE(driver.is_there("tree/column/overlap"));

  ui::UiState other;
  layout_from_json(other, layout_to_json(driver.state));
  EXPECT_EQ(other.tree.columns, driver.state.tree.columns);
  layout_from_json(other, R"({"tree_columns": ["sah", "nonsense", 3, "sah"]})");
  EXPECT_EQ(other.tree.columns, (std::vector<std::string>{"sah"}));
}

TEST_F(TreePanel, AClickOnAColumnSortsSiblings) {
  go_to_mesh(0);
  driver.click("tree/Open all");
  const auto sorted = [&](bool descending) {
    const auto& rows = driver.state.tree.rows.rows;
    for (uint32_t node = 0; node < table().nodes.size(); ++node) {
      if (is_leaf(table().nodes[node])) continue;
      const auto left = std::find(rows.begin(), rows.end(), child(node));
      const auto right = std::find(rows.begin(), rows.end(), child(node, 1));
      const bool first = left < right;
      const uint32_t a = table().nodes[child(node)].references;
      const uint32_t b = table().nodes[child(node, 1)].references;
      if (a != b && first != (descending ? a > b : a < b)) return false;
    }
    return true;
  };
  EXPECT_FALSE(sorted(true));
  driver.click("tree/column/references");
  EXPECT_TRUE(sorted(true));
  driver.click("tree/column/references");
  EXPECT_TRUE(sorted(false));
  driver.click("tree/column/references");
  EXPECT_TRUE(driver.state.tree.sort.empty());
}

TEST_F(TreePanel, OpenAllAndCloseAll) {
  go_to_mesh(0);
  driver.click("tree/Open all");
  EXPECT_EQ(driver.state.tree.rows.rows.size(), table().nodes.size());
  driver.hover(row(0) + "/row");
  driver.wheel(-5.0f);
  driver.frame(2);
  EXPECT_GT(driver.state.tree.top, 0.0);
  EXPECT_FALSE(driver.is_there(row(0) + "/row"));
  driver.drag("tree/Rows", 0.0f, 500.0f);
  EXPECT_EQ(driver.state.tree.top,
            static_cast<double>(table().nodes.size()) - driver.state.tree.page);
  driver.click("tree/Close all");
  driver.frame(2);
  EXPECT_EQ(driver.state.tree.rows.rows.size(), 3u);
  EXPECT_TRUE(driver.is_there(row(0) + "/row"));
}

TEST_F(TreePanel, TheContextMenuHidesIsolatesFocusesAndCopies) {
  const uint32_t node = inner_child();
  const NodePlace place{tracer::none, node};
  const auto choose = [&](const char* item) {
    driver.click(row(node) + "/row", 1);
    driver.click(std::string("tree/menu/") + item);
  };
  choose("Hide in 3D");
  EXPECT_EQ(driver.state.box_filter.hidden, std::vector<NodePlace>{place});
  choose("Show in 3D");
  EXPECT_TRUE(driver.state.box_filter.hidden.empty());
  choose("Isolate in 3D");
  EXPECT_EQ(driver.state.box_filter.isolated, place);
  choose("Show all in 3D");
  EXPECT_EQ(driver.state.box_filter, ui::BoxFilter());
  const tracer::Camera before = driver.edited.settings.look->camera;
  choose("Focus");
  EXPECT_FALSE(driver.edited.settings.look->camera == before);
  choose("Copy the row");
  const std::string copied = ImGui::GetClipboardText();
  EXPECT_NE(copied.find("node " + std::to_string(node) + " of TLAS"), std::string::npos);
  EXPECT_NE(copied.find("Visits: "), std::string::npos);
  choose("Open all below");
  EXPECT_GT(driver.state.tree.rows.rows.size(), 5u);
}

TEST_F(TreePanel, AnotherBuildClosesTheListAndForgetsTheFilter) {
  go_to_mesh(0);
  driver.click("tree/Open all");
  driver.state.box_filter.hidden = {{0, 3}};
  driver.edited.settings.build.builder = "median";
  driver.trace();
  driver.frame(3);
  EXPECT_TRUE(driver.state.box_filter.hidden.empty());
  driver.click(row(0) + "/row");
  EXPECT_FALSE(driver.state.selection.node) << "its nodes are of a tree that is gone";
  inspect(driver);
  driver.frame(3);
  driver.click(row(0) + "/row");
  EXPECT_EQ(driver.state.selection.node, (NodePlace{0, 0}));
}

TEST(TreePanelOfOneMesh, BeginsWithItsTree) {
  Driver driver("terrain:triangles=1000");
  inspect(driver);
  driver.show("tree");
  EXPECT_EQ(driver.state.tree.mesh, 0u);
  EXPECT_TRUE(driver.is_there("tree/node 0/row"));
}

TEST(TreePanelWithoutNodes, SaysWhatItWaitsFor) {
  Driver driver;
  driver.show("tree");
  EXPECT_FALSE(driver.is_there("tree/node 0/row"));
  EXPECT_TRUE(driver.requests.inspect);
}

}  // namespace
