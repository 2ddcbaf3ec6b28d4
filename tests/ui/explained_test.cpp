// Every number in the panels that look into the trees has a definition, in a tooltip or in that of
// its column.
#include <fstream>
#include <regex>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "driver.h"
#include "tracer/analyze/box_set.h"
#include "tracer/analyze/frame_visits.h"
#include "ui/widgets.h"

namespace {

using ui::Driver;

template <class Result>
void give(ui::Background<Result>& background, Result result) {
  background.result = std::make_shared<const Result>(std::move(result));
}

// What the program's background work does, of what was asked for in the last frame.
void answer(Driver& driver) {
  const tracer::Snapshot& snapshot = *driver.snapshot;
  const tracer::World world{*snapshot.scene, *snapshot.bvh, *snapshot.settings.look,
                            snapshot.settings.render};
  const tracer::CameraFrame camera =
      tracer::frame(world.look.camera, world.options.width, world.options.height);
  const ui::Requests asked = driver.requests;
  ui::Work& work = driver.work;
  if (asked.inspect) give(work.inspection, tracer::inspect(snapshot.bvh, nullptr, {}));
  if (asked.count_visits) {
    give(work.visits, tracer::CountedVisits{snapshot.bvh, tracer::count_visits(world, camera, {})});
  }
  if (asked.hot_spots) {
    give(work.hot_spots, tracer::hot_spots(*snapshot.scene, work.inspection.result,
                                           work.visits.result, *asked.hot_spots, 20, {}));
  }
  if (asked.icicle) {
    give(work.icicle,
         tracer::make_icicle(tracer::icicle_sources(*asked.icicle, work.inspection.result,
                                                    work.visits.result, work.measures.result),
                             {}));
  }
  if (asked.node_pixels) {
    give(work.node_pixels, ui::WatchedPixels{snapshot.render_generation,
                                             tracer::node_pixels(world, snapshot.bvh, camera,
                                                                 *asked.node_pixels, {})});
  }
  if (asked.node_splits) {
    const auto [mesh, node] = *asked.node_splits;
    give(work.splits,
         tracer::node_splits(*snapshot.scene, snapshot.bvh,
                             *tracer::table_of(*work.inspection.result, mesh), mesh, node, {}));
  }
  if (asked.log_rays) {
    const tracer::RayLog log =
        asked.log_rays->again
            ? tracer::log_again(*asked.log_rays->again, snapshot.bvh)
            : tracer::log_pixel(world, snapshot.bvh, camera, asked.log_rays->pixel);
    give(work.rays, ui::LoggedRays{*asked.log_rays, std::make_shared<const tracer::RayLog>(log)});
  }
  if (asked.replay) {
    const tracer::Mesh* mesh =
        *asked.replay == tracer::none ? nullptr : &snapshot.scene->meshes[*asked.replay];
    give(work.replay, tracer::replay_build(snapshot.bvh, *asked.replay, mesh, {}));
  }
}

// Some frames, with all that is asked for.
void frames(Driver& driver) {
  for (int i = 0; i < 3; ++i) {
    driver.requests = {};
    driver.frame();
    answer(driver);
  }
  driver.frame(2);
}

void expect_explained(const Driver& driver) {
  for (const std::string& text : driver.items.unexplained)
    ADD_FAILURE() << text;
}

// An optimised tree, and a pixel with rays of several classes.
void prepare(Driver& driver, const char* panel) {
  driver.edited.settings.build.builder = "ploc";
  driver.edited.settings.build.optimizer = "reinsertion";
  driver.trace();
  driver.state.selection.node = ui::NodePlace{0, 1};
  driver.state.selection.pixel =
      tracer::ivec2(driver.snapshot->film.width / 2, driver.snapshot->film.height / 2);
  driver.show(panel);
  frames(driver);
}

TEST(Explained, ANumberWithoutHelpIsNoticed) {
  Driver driver;
  const auto drawn = [&](auto draw) {
    driver.items.unexplained.clear();
    ImGui::NewFrame();
    ImGui::Begin("test");
    draw();
    ImGui::End();
    ImGui::EndFrame();
    return driver.items.unexplained.size();
  };
  EXPECT_EQ(drawn([] { ui::hint("12 nodes"); }), 1u);
  EXPECT_EQ(drawn([] { ui::hint("12 nodes", "How many there are"); }), 0u);
  EXPECT_EQ(drawn([] { ui::hint("no nodes"); }), 0u);
  EXPECT_EQ(drawn([] { ui::text_row("Nodes", "12", ""); }), 1u);
  const auto table = [](const char* help) {
    ImGui::BeginTable("table", 1);
    ImGui::TableSetupColumn("Nodes");
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    ui::header("Nodes", help);
    ImGui::TableNextRow();
    ui::cell("12");
    ImGui::EndTable();
  };
  EXPECT_EQ(drawn([&] { table(""); }), 1u);
  EXPECT_EQ(drawn([&] { table("How many there are"); }), 0u);
}

TEST(Explained, Tree) {
  Driver driver;
  prepare(driver, "tree");
  for (const tracer::NodeMeasureRow& measure : tracer::node_measures())
    driver.state.tree.columns.emplace_back(measure.id);
  driver.click("tree/Open all");
  driver.state.selection.triangle = 3;
  frames(driver);
  expect_explained(driver);
}

TEST(Explained, Node) {
  Driver driver("showcase", {1400, 2400});
  prepare(driver, "node");
  driver.state.node.show_pixels = true;
  for (const uint32_t node : {0u, 1u, 2u, 40u}) {
    driver.state.selection.node = ui::NodePlace{0, node};
    frames(driver);
  }
  driver.state.selection.node = ui::NodePlace{tracer::none, 0};
  frames(driver);
  driver.state.selection.node.reset();
  driver.state.selection.instance = 0;
  driver.state.selection.triangle = 3;
  frames(driver);
  expect_explained(driver);
}

TEST(Explained, Icicle) {
  Driver driver;
  prepare(driver, "icicle");
  for (const char* drawing : {"icicle", "treemap"}) {
    driver.state.icicle.drawing = drawing;
    driver.state.icicle.to = 0.5;
    driver.state.icicle.view.length = 0.5;
    frames(driver);
  }
  expect_explained(driver);
}

TEST(Explained, Boxes) {
  Driver driver;
  prepare(driver, "boxes");
  driver.edited.view.boxes.show = true;
  driver.state.box_filter.hidden.push_back({0, 2});
  for (const tracer::BoxSetRow& set : tracer::box_sets()) {
    driver.edited.view.boxes.what = set.id;
    driver.trace();
    frames(driver);
  }
  expect_explained(driver);
}

TEST(Explained, HotNodes) {
  Driver driver;
  prepare(driver, "hot");
  driver.state.hot.with_cause = false;
  frames(driver);
  EXPECT_TRUE(driver.is_there("hot/spot 1/row"));
  expect_explained(driver);
}

TEST(Explained, Ray) {
  Driver driver("showcase", {1900, 1100});
  driver.state.layout.bottom = 500.0f;
  prepare(driver, "ray");
  EXPECT_TRUE(driver.is_there("ray/step 1/row"));
  driver.click("ray/Lock");
  driver.edited.settings.build.builder = "median";
  driver.trace();
  frames(driver);
  EXPECT_TRUE(driver.is_there("ray/strip before"));
  expect_explained(driver);
}

TEST(Explained, Replay) {
  Driver driver;
  driver.state.replay.mesh = 0;
  driver.state.replay.chosen = true;
  prepare(driver, "replay");
  const tracer::Replay& replay = *driver.work.replay.result;
  for (const size_t step :
       {size_t{0}, size_t{3}, replay.log.order.size() + 1, step_count(replay)}) {
    driver.state.replay.step = step;
    driver.frame(2);
  }
  expect_explained(driver);
}

// Texts that go past the wrappers would not be noticed above.
TEST(Explained, ThesePanelsShowTextsThroughTheWrappers) {
  const std::regex raw(R"(ImGui::(Text|LabelText|BulletText)\w*\()");
  for (const char* file : {"panels/tree", "panels/node", "panels/icicle", "panels/boxes",
                           "panels/hot_spots", "panels/ray", "panels/replay", "tree_list",
                           "node_splits", "ray_tables", "icicle", "treemap"}) {
    std::ifstream stream(fmt::format("{}/ui/{}.cpp", BVHSCOPE_SOURCE_DIR, file));
    ASSERT_TRUE(stream) << file;
    std::string line;
    while (std::getline(stream, line))
      EXPECT_FALSE(std::regex_search(line, raw)) << file << ": " << line;
  }
}

}  // namespace
