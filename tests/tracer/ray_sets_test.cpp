// The rays of a benchmark, and rays from a file.
#include "tracer/analyze/ray_sets.h"

#include <cmath>
#include <cstring>

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include "tests/tracer/make_scene.h"
#include "tests/tracer/temporary_folder.h"
#include "tracer/bvh/ray_kernels.h"
#include "tracer/bvh/traverse.h"

namespace tracer::test {
namespace {

using testing::HasSubstr;

struct World {
  Scene scene = scene_of({sphere(8), grid(4)});
  SceneBvh bvh;

  World() {
    scene.camera.eye = {0, 1, 4};
    bvh = bvh_of(scene);
  }
  std::vector<RaySet> sets(std::vector<std::string> classes = {}) const {
    return make_ray_sets(scene, bvh, scene.lights, {scene.camera, 32, 24, std::move(classes)}, {});
  }
};

TEST(RaySets, AreOfEveryClassAndBothViews) {
  std::vector<std::string> names;
  for (const RaySet& set : World().sets())
    names.push_back(set.id + " " + set.view);
  EXPECT_THAT(names, testing::ElementsAre("primary camera", "primary inside", "shadow camera",
                                          "shadow inside", "reflection camera", "reflection inside",
                                          "diffuse camera", "diffuse inside", "random "));
}

TEST(RaySets, AreThoseOfTheChosenClasses) {
  const auto sets = World().sets({"random", "shadow"});
  ASSERT_EQ(sets.size(), 3u);
  EXPECT_EQ(sets[0].id, "shadow");
  EXPECT_TRUE(sets[0].any_hit);
  EXPECT_EQ(sets[2].id, "random");
  EXPECT_FALSE(sets[2].any_hit);
}

TEST(RaySets, PrimaryRaysComeInTiles) {
  const World world;
  const auto sets = world.sets({"primary"});
  ASSERT_EQ(sets[0].rays.size(), 32u * 24u);
  const CameraFrame view = frame(world.scene.camera, 32, 24);
  EXPECT_EQ(sets[0].rays[1].direction, primary_ray(view, {1.5f, 0.5f}).direction);
  EXPECT_EQ(sets[0].rays[8].direction, primary_ray(view, {0.5f, 1.5f}).direction);
  EXPECT_EQ(sets[0].rays[64].direction, primary_ray(view, {8.5f, 0.5f}).direction);
}

TEST(RaySets, InsideAClosedBodyEveryRayHits) {
  World world;
  world.scene = scene_of({sphere(16)});
  world.bvh = bvh_of(world.scene);
  const auto sets = world.sets({"primary"});
  ASSERT_EQ(sets[1].view, "inside");
  std::vector<Hit> hits(sets[1].rays.size());
  ray_kernel(world.bvh.options.layout).intersect(world.bvh, sets[1].rays, hits);
  EXPECT_TRUE(std::all_of(hits.begin(), hits.end(), is_hit));
}

TEST(RaySets, ShadowRaysEndAtTheLightsThatAreOn) {
  World world;
  world.scene.lights = {{.position = {0, 9, 0}}, {.position = {3, 3, 3}, .on = false}};
  for (const RaySet& set : world.sets({"shadow"})) {
    for (const Ray& ray : set.rays) {
      const vec3 end = ray.origin + ray.t_max * ray.direction;
      EXPECT_LT(glm::length(end - vec3(0, 9, 0)), 1e-4f);
    }
  }
}

TEST(RaySets, WithoutLightsShadowRaysGoAboveTheScene) {
  World world;
  world.scene.lights.clear();
  const auto sets = world.sets({"shadow"});
  ASSERT_FALSE(sets.empty());
  for (const Ray& ray : sets[0].rays)
    EXPECT_GT((ray.origin + ray.direction).y, bounds(world.bvh).hi.y);
}

TEST(RaySets, BouncesLeaveTheSurfaceOnTheSideTheyCameFrom) {
  World world;
  world.scene = scene_of({grid(1)});  // in y = 0, seen from above
  world.scene.camera = {.eye = {0.5f, 2, 0.6f}, .target = {0.5f, 0, 0.5f}};
  world.bvh = bvh_of(world.scene);
  for (const char* id : {"diffuse", "reflection"}) {
    const auto sets = world.sets({id});
    ASSERT_EQ(sets[0].view, "camera");
    EXPECT_GT(sets[0].rays.size(), 50u);
    for (const Ray& ray : sets[0].rays)
      EXPECT_GE(ray.direction.y, 0.0f) << id;
  }
}

TEST(RaySets, RandomRaysGoThroughTheSphereAroundTheScene) {
  const World world;
  const vec3 middle = center(bounds(world.bvh));
  const float radius = 0.5f * glm::length(extent(bounds(world.bvh)));
  const auto sets = world.sets({"random"});
  for (const Ray& ray : sets.front().rays) {
    EXPECT_NEAR(glm::length(ray.origin - middle), radius, 1e-4f * radius);
    EXPECT_LT(glm::dot(ray.direction, ray.origin - middle), 0.0f);
    EXPECT_NEAR(glm::length(ray.direction), 1.0f, 1e-5f);
  }
}

TEST(RaySets, AreValidAndTheSameForOneThreadAndAnotherBuilder) {
  const World world;
  const auto sets = world.sets();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  World other;
  BuildOptions options;
  options.builder = "median";
  options.layout = "wide8";
  other.bvh = bvh_of(other.scene, options);
  const auto again = other.sets();
  ASSERT_EQ(sets.size(), again.size());
  for (size_t i = 0; i < sets.size(); ++i) {
    ASSERT_EQ(sets[i].rays.size(), again[i].rays.size());
    for (size_t k = 0; k < sets[i].rays.size(); ++k) {
      ASSERT_TRUE(is_valid(sets[i].rays[k]));
      ASSERT_EQ(std::memcmp(&sets[i].rays[k], &again[i].rays[k], sizeof(Ray)), 0);
    }
  }
}

std::string bytes_of(const std::vector<float>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float)};
}

TEST(RayFile, HasEightNumbersARay) {
  const TemporaryFolder folder;
  const auto file =
      folder.file("a.rays", bytes_of({1, 2, 3, 0.5f, 4, 5, 6, 7, 0, 0, 0, -1, 0, 0, 2, infinity}));
  const RayFile read = read_rays(file);
  ASSERT_EQ(read.rays.size(), 2u);
  EXPECT_EQ(read.rays[0].origin, vec3(1, 2, 3));
  EXPECT_EQ(read.rays[0].t_min, 0.5f);
  EXPECT_EQ(read.rays[0].direction, vec3(4, 5, 6));
  EXPECT_EQ(read.rays[0].t_max, 7.0f);
  EXPECT_EQ(read.rays[1].t_min, 0.0f) << "negative ones count as 0";
  EXPECT_EQ(read.left_out, 0u);
}

TEST(RayFile, LeavesOutWhatCannotHit) {
  const TemporaryFolder folder;
  const auto file = folder.file("a.rays", bytes_of({NAN, 2, 3, 0,   4, 5, 6, 7,  // not a number
                                                    0,   0, 0, 0,   0, 0, 0, 1,  // no direction
                                                    0,   0, 0, 2,   0, 0, 1, 1,  // empty interval
                                                    0,   0, 0, NAN, 0, 0, 1, 1,  // no interval
                                                    0,   0, 0, 0,   0, 0, 1, infinity}));  // fine
  const RayFile read = read_rays(file);
  EXPECT_EQ(read.rays.size(), 1u);
  EXPECT_EQ(read.left_out, 4u);
}

std::string message_for(const std::filesystem::path& file) {
  return message_of([&] { read_rays(file); });
}

TEST(RayFile, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  EXPECT_THAT(message_for(folder.path / "missing.rays"), HasSubstr("missing.rays"));
  EXPECT_THAT(message_for(folder.file("odd.rays", std::string(40, '\0'))),
              HasSubstr("40 bytes are no rays"));
  EXPECT_THAT(message_for(folder.file("empty.rays")), HasSubstr("0 bytes are no rays"));
  EXPECT_THAT(message_for(folder.file("zero.rays", std::string(64, '\0'))),
              HasSubstr("none of its 2 rays can hit anything"));
  EXPECT_THAT(message_for(folder.path), HasSubstr(folder.path.string()));
}

TEST(RayFile, IsNotReadIfItIsTooLarge) {
  const TemporaryFolder folder;
  const auto file = folder.file("huge.rays");
  std::filesystem::resize_file(file, 32 * (max_file_rays + 1));  // takes no space
  EXPECT_THAT(message_for(file), HasSubstr("huge.rays"));
}

}  // namespace
}  // namespace tracer::test
