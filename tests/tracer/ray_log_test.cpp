// One ray's log and one frame's visits against the counters of the picture.
#include "tracer/analyze/ray_log.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "make_scene.h"
#include "tracer/analyze/frame_visits.h"
#include "tracer/analyze/inspection.h"
#include "tracer/render/passes.h"

namespace tracer::test {
namespace {

// A glass ball, a mirror ball and a floor under a light: rays of every class.
struct Balls {
  // Of the floor, which is re-braided if it is steep.
  explicit Balls(float slope = 0.0f) {
    Mesh floor = grid(8);
    for (vec3& position : floor.positions)
      position = 8.0f * (position - vec3(0.5f, 0.13f, 0.5f));
    for (vec3& position : floor.positions)
      position.y += slope * position.x;
    scene = scene_of({sphere(16, 1.0f, vec3(-1, 0, 0)), sphere(16, 1.0f, vec3(1, 0, 0)), floor});
    for (Mesh& mesh : scene.meshes) {
      for (size_t i = 0; i < mesh.normals.size(); ++i)
        mesh.normals[i] = vec3(0, 1, 0);
    }
    scene.materials.resize(3);
    scene.materials[0].transmission = 1.0f;
    scene.materials[1].reflectivity = 0.8f;
    for (size_t i = 0; i < 3; ++i)
      std::fill(scene.meshes[i].materials.begin(), scene.meshes[i].materials.end(), uint32_t(i));
    look = look_of(scene);
    Light light;
    light.position = vec3(0, 5, 3);
    look.lights = {light};
    look.camera.eye = vec3(0, 1, 6);
    look.camera.target = vec3(0);
    options.width = 64;
    options.height = 40;
  }

  Scene scene;
  Look look;
  RenderOptions options;
};

// Builder, layout, and whether instances are re-braided.
class EveryBuilder : public testing::TestWithParam<std::tuple<std::string, std::string, bool>> {
 protected:
  BuildOptions options() const {
    BuildOptions build;
    build.builder = std::get<0>(GetParam());
    build.layout = std::get<1>(GetParam());
    build.presplit = true;
    build.rebraid = std::get<2>(GetParam());
    return build;
  }
  std::shared_ptr<const SceneBvh> bvh_of_balls(const Balls& balls) const {
    auto bvh = std::make_shared<const SceneBvh>(bvh_of(balls.scene, options()));
    EXPECT_EQ(!bvh->entries.empty(), options().rebraid);
    return bvh;
  }
};

TEST_P(EveryBuilder, StepsAddUpToThePixelsCounters) {
  const Balls balls(options().rebraid ? 0.7f : 0.0f);
  const auto bvh = bvh_of_balls(balls);
  const World world{balls.scene, *bvh, balls.look, balls.options};
  const CameraFrame camera = frame(balls.look.camera, balls.options.width, balls.options.height);
  const Film film = first_pass(world, camera, {});
  ClassCounters seen{};
  for (int y = 0; y < balls.options.height; y += 3) {
    for (int x = 0; x < balls.options.width; x += 3) {
      ClassCounters sum{};
      const RayLog log = log_pixel(world, bvh, camera, {x, y});
      for (const LoggedRay& ray : log.rays) {
        sum[int(ray.cast.ray_class)] += ray.counters;
        seen[int(ray.cast.ray_class)] += ray.counters;
      }
      ASSERT_EQ(sum, *pixel(film, x, y).counters) << x << ", " << y;
      ASSERT_EQ(log.rays[0].cast.hit, *pixel(film, x, y).hit);
    }
  }
  for (const Counters& counters : seen)
    EXPECT_GT(counters.nodes, 0u) << "rays of every class were compared";
}

TEST_P(EveryBuilder, VisitsAddUpToTheFilmsCounters) {
  const Balls balls(options().rebraid ? 0.7f : 0.0f);
  const auto bvh = bvh_of_balls(balls);
  const World world{balls.scene, *bvh, balls.look, balls.options};
  const CameraFrame camera = frame(balls.look.camera, balls.options.width, balls.options.height);
  const Film film = first_pass(world, camera, {});
  const auto visits = count_visits(world, camera, {});
  const Inspection inspection = inspect(bvh, nullptr, {});
  for (int ray_class = 0; ray_class < ray_class_count; ++ray_class) {
    Counters expected;
    for (int y = 0; y < balls.options.height; ++y) {
      for (int x = 0; x < balls.options.width; ++x)
        expected += (*pixel(film, x, y).counters)[size_t(ray_class)];
    }
    uint64_t nodes = 0, leaves = 0;
    for (const uint32_t mesh : {none, 0u, 1u, 2u}) {
      const TreeTable& table = *table_of(inspection, mesh);
      const std::vector<uint32_t> counts = tree_visits(*visits, mesh, ray_class);
      ASSERT_EQ(counts.size(), table.nodes.size());
      for (size_t i = 0; i < counts.size(); ++i)
        (is_leaf(table.nodes[i]) ? leaves : nodes) += counts[i];
    }
    EXPECT_EQ(nodes + leaves, expected.nodes + expected.leaves);
    // A leaf of a wide layout may be an inner node of the tree that is inspected.
    if (bvh->options.layout == "binary") {
      EXPECT_EQ(leaves, expected.leaves);
    }
  }
}

std::vector<std::tuple<std::string, std::string, bool>> builders_and_layouts() {
  std::vector<std::tuple<std::string, std::string, bool>> ids;
  for (const BuilderRow& builder : builders()) {
    for (const LayoutRow& layout : layouts()) {
      for (const bool rebraid : {false, true})
        ids.emplace_back(builder.id, layout.id, rebraid);
    }
  }
  return ids;
}
INSTANTIATE_TEST_SUITE_P(RayLog, EveryBuilder, testing::ValuesIn(builders_and_layouts()),
                         [](const auto& info) {
                           return std::get<0>(info.param) + "_" + std::get<1>(info.param) +
                                  (std::get<2>(info.param) ? "_rebraid" : "");
                         });

TEST(RayLog, ARayComesAfterTheOneItWasCastFrom) {
  const Balls balls;
  const auto bvh = std::make_shared<const SceneBvh>(bvh_of(balls.scene));
  const World world{balls.scene, *bvh, balls.look, balls.options};
  const CameraFrame camera = frame(balls.look.camera, balls.options.width, balls.options.height);
  size_t most = 0;
  for (int x = 0; x < balls.options.width; ++x) {
    const RayLog log = log_pixel(world, bvh, camera, {x, 20});
    most = std::max(most, log.rays.size());
    EXPECT_EQ(log.rays[0].cast.parent, none);
    for (size_t i = 1; i < log.rays.size(); ++i) {
      const CastRay& cast = log.rays[i].cast;
      ASSERT_LT(cast.parent, i);
      const CastRay& parent = log.rays[cast.parent].cast;
      ASSERT_TRUE(is_hit(parent.hit));
      const int bounces = cast.ray_class == RayClass::shadow ? 0 : 1;
      EXPECT_EQ(cast.bounce, parent.bounce + bounces);
      const vec3 from = parent.ray.origin + parent.hit.t * parent.ray.direction;
      EXPECT_LT(glm::length(cast.ray.origin - from), 1e-3f);
    }
  }
  EXPECT_GT(most, 5u);
}

TEST(FrameVisits, TheSameForOneThread) {
  const Balls balls;
  const SceneBvh bvh = bvh_of(balls.scene);
  const World world{balls.scene, bvh, balls.look, balls.options};
  const CameraFrame camera = frame(balls.look.camera, balls.options.width, balls.options.height);
  const auto many = count_visits(world, camera, {});
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto single = count_visits(world, camera, {});
  for (int ray_class = 0; ray_class <= ray_class_count; ++ray_class) {
    EXPECT_EQ(tree_visits(*many, none, ray_class), tree_visits(*single, none, ray_class));
    EXPECT_EQ(tree_visits(*many, 2, ray_class), tree_visits(*single, 2, ray_class));
  }
  EXPECT_GT(tree_visits(*many, 2, ray_class_count)[0], 0u);
}

TEST(FrameVisits, NothingIfStopped) {
  const Balls balls;
  const SceneBvh bvh = bvh_of(balls.scene);
  std::stop_source stop;
  stop.request_stop();
  const World world{balls.scene, bvh, balls.look, balls.options};
  EXPECT_EQ(count_visits(world, frame(balls.look.camera, 64, 40), {stop.get_token(), {}}), nullptr);
}

TEST(Inspection, TakesOverTablesOfTheSameTrees) {
  const Balls balls;
  const auto bvh = std::make_shared<const SceneBvh>(bvh_of(balls.scene));
  const Inspection first = inspect(bvh, nullptr, {});
  const auto moved = std::make_shared<const SceneBvh>(*bvh);
  const Inspection second = inspect(moved, &first, {});
  EXPECT_EQ(first.blases[1], second.blases[1]);
  EXPECT_NE(first.tlas, second.tlas);
  EXPECT_EQ(table_of(second, 17), nullptr);
}

TEST(Inspection, FiguresOfOtherTreesAreLeftOut) {
  const Balls balls;
  const auto bvh = std::make_shared<const SceneBvh>(bvh_of(balls.scene));
  const auto inspection = std::make_shared<const Inspection>(inspect(bvh, nullptr, {}));
  const World world{balls.scene, *bvh, balls.look, balls.options};
  auto counted = std::make_shared<CountedVisits>();
  counted->bvh = bvh;
  counted->visits = count_visits(world, frame(balls.look.camera, 64, 40), {});
  EXPECT_EQ(NodeFigures(inspection, 2, ray_class_count, counted, nullptr).facts().visits.size(),
            bvh->blases[2]->tree.nodes.size());
  counted->bvh = std::make_shared<const SceneBvh>(bvh_of(balls.scene));
  EXPECT_TRUE(NodeFigures(inspection, 2, ray_class_count, counted, nullptr).facts().visits.empty());
  EXPECT_EQ(NodeFigures(inspection, 9, ray_class_count, counted, nullptr).facts().table, nullptr);
}

}  // namespace
}  // namespace tracer::test
