#include "tracer/analyze/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tracer/hand_made.h"

namespace tracer {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> result;
  for (const auto& item : object.items())
    result.push_back(item.key());
  return result;
}

std::shared_ptr<const Snapshot> snapshot() {
  Snapshot made = hand_made_snapshot();
  made.film = hand_made_film(4, 4, [](int, int) {
    return pixel_of(RayClass::primary, {1, 3, 1, 2, 1});
  });
  made.rates[0] = {2'000'000, 1.0};
  return std::make_shared<const Snapshot>(made);
}

Json report() {
  const std::vector<std::shared_ptr<const Snapshot>> snapshots = {snapshot()};
  return report_json(snapshots);
}

TEST(Report, TopLevelFieldsInTheirOrder) {
  EXPECT_THAT(keys(report()), ElementsAre("schema", "scene", "settings", "builds", "machine"));
  EXPECT_THAT(keys(report()["scene"]),
              ElementsAre("name", "meshes", "instances", "triangles", "instanced_triangles",
                          "materials", "textures", "lights", "bounds_min", "bounds_max"));
  EXPECT_THAT(keys(report()["settings"]),
              ElementsAre("width", "height", "depth", "eye", "target", "fov_degrees", "tests"));
  EXPECT_THAT(keys(report()["machine"]), ElementsAre("cpu", "threads", "isa", "kernel_isa"));
}

TEST(Report, BuildFields) {
  const Json build = report()["builds"][0];
  EXPECT_EQ(build["builder"], "binned");
  EXPECT_EQ(build["nodes"], 1);
  EXPECT_EQ(build["sah"], 1.0);
  EXPECT_EQ(build["leaf_size_histogram"], Json::array({0, 1}));
  EXPECT_EQ(build["options"]["bins"], 32);
}

TEST(Report, RaysOfEveryClass) {
  const Json rays = report()["builds"][0]["rays"];
  EXPECT_THAT(keys(rays), ElementsAre("primary", "shadow", "reflection", "refraction"));
  EXPECT_EQ(rays["primary"]["count"], 16);
  EXPECT_EQ(rays["primary"]["nodes"]["mean"], 3.0);
  EXPECT_EQ(rays["primary"]["triangles"]["max"], 2.0);
  EXPECT_EQ(rays["shadow"]["count"], 0);
  const double threads = report()["machine"]["threads"];
  EXPECT_DOUBLE_EQ(rays["primary"]["mrays_per_s"], 2.0 * threads);
  EXPECT_EQ(rays["shadow"]["mrays_per_s"], 0.0);
}

TEST(Report, TextHasAColumnForEachBuild) {
  const std::vector<std::shared_ptr<const Snapshot>> snapshots = {snapshot(), snapshot()};
  const std::string text = report_text(report_json(snapshots));
  EXPECT_THAT(text,
              HasSubstr("SAH                                         1.00            1.00\n"));
  EXPECT_THAT(text, HasSubstr("primary rays\n"));
  EXPECT_THAT(text, testing::Not(HasSubstr("shadow rays")));
}

TEST(Report, SaysWhichKernelsWereChosen) {
  Snapshot chosen = *snapshot();
  chosen.settings.render.kernels = {"packet", "stream", "automatic", "automatic"};
  const std::vector<std::shared_ptr<const Snapshot>> snapshots = {
      snapshot(), std::make_shared<const Snapshot>(chosen)};
  const Json json = report_json(snapshots);
  EXPECT_EQ(json["builds"][0]["rays"]["primary"]["kernel"], "automatic");
  EXPECT_EQ(json["builds"][1]["rays"]["primary"]["kernel"], "packet");
  EXPECT_EQ(json["builds"][1]["rays"]["shadow"]["kernel"], "automatic") << "binary has no streams";
  EXPECT_THAT(report_text(json),
              HasSubstr("  kernel                               automatic  packet, chosen\n"));
}

TEST(Report, ABlendNeedsThreeBuildsThatDiffer) {
  std::vector<std::shared_ptr<const Snapshot>> snapshots = {snapshot()};
  EXPECT_FALSE(report_json(snapshots).contains("blend"));
  snapshots.push_back(snapshot());
  EXPECT_TRUE(report_json(snapshots)["blend"].is_null());
  EXPECT_THAT(report_text(report_json(snapshots)), HasSubstr("needs at least three builds"));
  for (const uint32_t nodes : {5u, 7u}) {
    Snapshot other = *snapshot();
    TreeStatistics tree = blas_statistics(*other.bvh);
    tree.sah = nodes;
    other.blas_statistics = std::make_shared<const TreeStatistics>(tree);
    other.film = hand_made_film(4, 4, [&](int, int) {
      return pixel_of(RayClass::primary, {1, nodes, 1, 2, 1});
    });
    snapshots.push_back(std::make_shared<const Snapshot>(other));
  }
  const Json blend = report_json(snapshots)["blend"];
  EXPECT_THAT(keys(blend), ElementsAre("alpha", "scale", "correlation",
                                       "mean_absolute_percentage_error", "builds"));
  EXPECT_EQ(blend["builds"].size(), 4u);
  EXPECT_NEAR(blend["builds"][3]["measured"], 7 * 1.2 + 2, 1e-5);
  EXPECT_THAT(report_text(report_json(snapshots)), HasSubstr("measured cost of a ray"));
}

TEST(Report, SceneCountsInstancedTriangles) {
  Scene scene = *hand_made_snapshot().scene;
  scene.instances.resize(3);
  EXPECT_EQ(scene_json(scene)["triangles"], 1);
  EXPECT_EQ(scene_json(scene)["instanced_triangles"], 3);
}

}  // namespace
}  // namespace tracer
