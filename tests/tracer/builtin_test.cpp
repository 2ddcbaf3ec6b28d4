#include "tracer/scene/builtin.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <set>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tracer/error.h"
#include "tracer/math/rng.h"
#include "tracer/scene/builtin_parts.h"

namespace tracer {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// Small, so that the whole file takes a second or two.
SceneSource small(std::string_view id) {
  SceneSource source;
  source.name = id;
  if (id == "massive") source.parameters = {{"detail", 2}};
  if (id == "stadium") source.parameters = {{"detail", 8}};
  if (id == "sticks") source.parameters = {{"sticks", 20}, {"rings", 9}};
  if (id == "needles") source.parameters = {{"triangles", 500}};
  if (id == "hairball") source.parameters = {{"strands", 50}};
  if (id == "terrain") source.parameters = {{"triangles", 5000}};
  return source;
}

Scene make(std::string_view id, std::vector<SceneParameter> parameters = {}) {
  SceneSource source;
  source.name = id;
  source.parameters = std::move(parameters);
  return make_builtin_scene(source, {});
}

std::string message_of(const SceneSource& source) {
  try {
    make_builtin_scene(source, {});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

bool finite(vec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void expect_promises(const Mesh& mesh, size_t materials) {
  SCOPED_TRACE(mesh.name);
  ASSERT_GE(mesh.triangles.size(), 1u);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  ASSERT_EQ(mesh.materials.size(), mesh.triangles.size());
  if (!mesh.uvs.empty()) {
    ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
  }
  for (const vec3& point : mesh.positions)
    ASSERT_TRUE(finite(point));
  for (const vec3& normal : mesh.normals)
    ASSERT_NEAR(glm::length(normal), 1.0f, 1e-4f);
  for (const vec2& uv : mesh.uvs)
    ASSERT_TRUE(finite({uv, 0}));
  for (const uint32_t material : mesh.materials)
    ASSERT_LT(material, materials);
  size_t agreeing = 0;
  for (const uvec3& t : mesh.triangles) {
    ASSERT_LT(std::max({t.x, t.y, t.z}), mesh.positions.size());
    const vec3 face = glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                 mesh.positions[t.z] - mesh.positions[t.x]);
    ASSERT_GT(glm::length(face), 0.0f);
    const vec3 normal = mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z];
    if (glm::dot(face, normal) > 0.0f) agreeing++;
  }
  // A coarse mesh has a few triangles that bend away from their exact normals.
  EXPECT_GE(static_cast<double>(agreeing), 0.98 * static_cast<double>(mesh.triangles.size()));
}

class BuiltinScene : public testing::TestWithParam<std::string> {};

TEST_P(BuiltinScene, KeepsThePromisesOfAScene) {
  const Scene scene = make_builtin_scene(small(GetParam()), {});
  EXPECT_EQ(scene.name, GetParam());
  EXPECT_THAT(scene.warnings, testing::IsEmpty());
  ASSERT_FALSE(scene.meshes.empty());
  ASSERT_FALSE(scene.instances.empty());
  ASSERT_FALSE(scene.materials.empty());
  EXPECT_FALSE(scene.lights.empty());
  EXPECT_FALSE(scene.sky_image.texels.empty());
  EXPECT_GT(glm::distance(scene.camera.eye, scene.camera.target), 0.0f);
  EXPECT_EQ(scene.counts.read, scene.counts.used);
  EXPECT_GT(scene.counts.used, 0u);
  for (const Mesh& mesh : scene.meshes)
    expect_promises(mesh, scene.materials.size());
  std::set<std::string> names;
  for (const Material& material : scene.materials) {
    EXPECT_TRUE(names.insert(material.name).second) << material.name;
    EXPECT_LE(material.reflectivity + material.transmission, 1.0f) << material.name;
    if (material.texture != none) {
      EXPECT_LT(material.texture, scene.textures.size());
    }
  }
  for (const Instance& instance : scene.instances) {
    ASSERT_LT(instance.mesh, scene.meshes.size());
    if (instance.material != none) {
      ASSERT_LT(instance.material, scene.materials.size());
    }
    ASSERT_TRUE(std::isfinite(glm::determinant(instance.transform)));
    ASSERT_GT(glm::determinant(instance.transform), 0.0f) << instance.name;
  }
}

TEST_P(BuiltinScene, IsTheSameEveryTime) {
  const Scene a = make_builtin_scene(small(GetParam()), {});
  const Scene b = make_builtin_scene(small(GetParam()), {});
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (size_t i = 0; i < a.meshes.size(); i++) {
    EXPECT_EQ(a.meshes[i].positions, b.meshes[i].positions);
    EXPECT_EQ(a.meshes[i].normals, b.meshes[i].normals);
    EXPECT_EQ(a.meshes[i].triangles, b.meshes[i].triangles);
    EXPECT_EQ(a.meshes[i].materials, b.meshes[i].materials);
  }
  ASSERT_EQ(a.instances.size(), b.instances.size());
  for (size_t i = 0; i < a.instances.size(); i++) {
    ASSERT_EQ(a.instances[i].transform, b.instances[i].transform);
    ASSERT_EQ(a.instances[i].motion, b.instances[i].motion);
  }
}

TEST_P(BuiltinScene, BuildsWithTheLeastValues) {
  const BuiltinSceneRow* row = nullptr;
  for (const BuiltinSceneRow& candidate : builtin_scenes()) {
    if (candidate.id == GetParam()) row = &candidate;
  }
  ASSERT_NE(row, nullptr);
  SceneSource source;
  source.name = GetParam();
  for (const SceneParameterRow& parameter : row->parameters) {
    EXPECT_LE(parameter.min, parameter.default_value);
    EXPECT_LE(parameter.default_value, parameter.max);
    source.parameters.push_back({std::string(parameter.id), parameter.min});
  }
  const Scene scene = make_builtin_scene(source, {});
  for (const Mesh& mesh : scene.meshes)
    expect_promises(mesh, scene.materials.size());
}

TEST_P(BuiltinScene, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(make_builtin_scene(small(GetParam()), {stop.get_token(), {}}), Error);
}

std::vector<std::string> all_ids() {
  std::vector<std::string> ids;
  for (const BuiltinSceneRow& row : builtin_scenes())
    ids.emplace_back(row.id);
  return ids;
}
INSTANTIATE_TEST_SUITE_P(Builtin, BuiltinScene, testing::ValuesIn(all_ids()),
                         [](const auto& test) { return test.param; });

TEST(Builtin, TeapotsAreSixteenHalfOfThemMirrors) {
  const Scene scene = make("teapots");
  ASSERT_EQ(scene.instances.size(), 16u);
  int mirrors = 0;
  for (const Instance& instance : scene.instances) {
    if (scene.materials[instance.material].reflectivity > 0.5f) mirrors++;
    EXPECT_GT(instance.motion.spin, 0.0f);
    EXPECT_GT(instance.motion.bounce_height, 0.0f);
  }
  EXPECT_EQ(mirrors, 8);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].position, vec3(3, 10, 2));
  EXPECT_EQ(scene.lights[0].color * scene.lights[0].intensity, vec3(150, 150, 120));
  EXPECT_EQ(scene.ambient, vec3(0.2f, 0.2f, 0.4f));
  EXPECT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(scene.counts.used, 6320u);
}

TEST(Builtin, MassiveHasElevenThousandInstancesOfOneMesh) {
  const Scene scene = make("massive", {{"detail", 2}});
  EXPECT_EQ(scene.instances.size(), 11000u);
  EXPECT_EQ(scene.meshes.size(), 1u);
}

TEST(Builtin, MassiveHasAsManyInstancesAsAsked) {
  for (const double count : {1.0, 2.0, 100.0, 512.0, 12345.0}) {
    const Scene scene = make("massive", {{"instances", count}, {"detail", 2}});
    EXPECT_EQ(scene.instances.size(), static_cast<size_t>(count));
    std::set<std::tuple<float, float, float>> places;
    for (const Instance& instance : scene.instances) {
      const vec4& origin = instance.transform[3];
      EXPECT_TRUE(places.emplace(origin.x, origin.y, origin.z).second) << instance.name;
    }
  }
}

TEST(Builtin, TerrainHasTheTrianglesAskedForWithinOnePercent) {
  for (const double count : {1000.0, 1001.0, 1234.0, 5003.0, 77777.0, 300000.0}) {
    const auto got = static_cast<double>(make("terrain", {{"triangles", count}}).counts.used);
    EXPECT_NEAR(got, count, 0.01 * count);
  }
}

TEST(Builtin, TerrainReachesTenMillion) {
  const BuiltinSceneRow* terrain = nullptr;
  for (const BuiltinSceneRow& row : builtin_scenes()) {
    if (row.id == "terrain") terrain = &row;
  }
  ASSERT_NE(terrain, nullptr);
  EXPECT_EQ(terrain->parameters[0].id, "triangles");
  EXPECT_EQ(terrain->parameters[0].max, 1e7);
}

TEST(Builtin, AnotherSeedGivesAnotherTerrain) {
  const Scene a = make("terrain", {{"triangles", 5000}, {"seed", 1}});
  const Scene b = make("terrain", {{"triangles", 5000}, {"seed", 2}});
  EXPECT_NE(a.meshes[0].positions, b.meshes[0].positions);
}

TEST(Builtin, CountsAreParameters) {
  EXPECT_EQ(make("needles", {{"triangles", 321}}).counts.used, 321u);
  EXPECT_EQ(make("stacked", {{"copies", 5}, {"concentric", 7}}).counts.used, 12u);
  EXPECT_EQ(make("showcase", {{"floor", 3}}).meshes[0].triangles.size(), 18u);
  const auto bald = make("hairball", {{"strands", 1}, {"segments", 1}}).counts.used;
  EXPECT_EQ(make("hairball", {{"strands", 10}, {"segments", 5}}).counts.used,
            bald - 6 + 10 * 5 * 6);
  EXPECT_GT(make("stadium", {{"detail", 10}}).counts.used,
            make("stadium", {{"detail", 5}}).counts.used);
}

TEST(Builtin, StackedTrianglesAreEqualOrHaveEqualCentres) {
  const Scene scene = make("stacked", {{"copies", 9}, {"concentric", 33}});
  const Mesh& mesh = scene.meshes[0];
  const auto box_of = [&](const uvec3& t) {
    return grown(grown(grown({}, mesh.positions[t.x]), mesh.positions[t.y]), mesh.positions[t.z]);
  };
  std::set<float> sizes;
  for (size_t i = 0; i < mesh.triangles.size(); i++) {
    const Box box = box_of(mesh.triangles[i]);
    if (i < 9) {
      EXPECT_EQ(box, box_of(mesh.triangles[0]));
    } else {
      EXPECT_EQ(center(box), vec3(0.0f));
      sizes.insert(box.hi.y);
    }
  }
  EXPECT_EQ(sizes.size(), 33u);
}

TEST(Builtin, UnknownSceneNamesTheKnownOnes) {
  SceneSource source;
  source.name = "teapotz";
  EXPECT_THAT(message_of(source),
              AllOf(HasSubstr("teapotz"), HasSubstr("teapots"), HasSubstr("terrain")));
}

TEST(Builtin, UnknownParameterNamesTheKnownOnes) {
  SceneSource source;
  source.name = "terrain";
  source.parameters = {{"trangles", 5000}};
  EXPECT_THAT(message_of(source),
              AllOf(HasSubstr("trangles"), HasSubstr("triangles"), HasSubstr("seed")));
}

TEST(Builtin, ParametersOutsideTheirRangeAreRefused) {
  SceneSource source;
  source.name = "terrain";
  for (const double value : {0.0, -1.0, 999.0, 1e7 + 1, 5000.5, std::nan(""), HUGE_VAL}) {
    source.parameters = {{"triangles", value}};
    EXPECT_THAT(message_of(source), AllOf(HasSubstr("triangles"), HasSubstr("10000000"))) << value;
  }
}

TEST(Builtin, ProgressRisesToOne) {
  float last = 0.0f;
  int calls = 0;
  Job job;
  job.report = [&](float fraction, std::string_view) {
    EXPECT_GE(fraction, last);
    last = fraction;
    calls++;
  };
  make_builtin_scene(small("terrain"), job);
  EXPECT_FLOAT_EQ(last, 1.0f);
  EXPECT_GT(calls, 10);
  EXPECT_LE(calls, 300);
}

TEST(Builtin, StopsInTheMiddle) {
  std::stop_source stop;
  Job job{stop.get_token(), {}};
  float last = 0.0f;
  job.report = [&](float fraction, std::string_view) {
    last = fraction;
    if (fraction > 0.3f) stop.request_stop();
  };
  EXPECT_THROW(make_builtin_scene(small("terrain"), job), Error);
  EXPECT_LT(last, 0.4f);
}

TEST(Assets, AreFound) {
  EXPECT_TRUE(std::filesystem::exists(asset_path("bricks.png")));
  EXPECT_TRUE(std::filesystem::exists(asset_path("sky.hdr")));
}

TEST(Assets, TheFolderOfTheEnvironmentComesFirst) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("bvhscope_assets_" + std::to_string(std::rand()));
  std::filesystem::create_directories(folder / "bricks.png");
  setenv("BVHSCOPE_ASSETS_DIR", folder.c_str(), 1);
  EXPECT_EQ(asset_path("bricks.png"), folder / "bricks.png");
  EXPECT_TRUE(std::filesystem::exists(asset_path("sky.hdr")));  // falls back to the others

  // A broken file is a warning, and the scene is still there.
  const Scene scene = make("teapots");
  EXPECT_THAT(scene.warnings, testing::ElementsAre(HasSubstr("bricks.png")));
  EXPECT_EQ(scene.materials[0].texture, none);
  unsetenv("BVHSCOPE_ASSETS_DIR");
  std::filesystem::remove_all(folder);
}

TEST(Sphere, HasTheTrianglesPromised) {
  EXPECT_EQ(make_sphere(8, 5).triangles.size(), 2u * 8 * 4);
  EXPECT_EQ(make_sphere(3, 2).triangles.size(), 6u);
}

TEST(Sphere, PointsAreTheirNormals) {
  const Mesh mesh = make_sphere(20, 10);
  for (size_t i = 0; i < mesh.positions.size(); i++) {
    EXPECT_LT(glm::distance(mesh.positions[i], mesh.normals[i]), 1e-6f);
  }
}

TEST(Rng, IsPcg32) {
  // The first numbers of the reference generator with initstate 42, initseq 54.
  Rng rng = make_rng(42, 54);
  for (const uint32_t expected : {0xa15c02b7u, 0x7b47f409u, 0xba1d3330u, 0x83d2f293u}) {
    EXPECT_EQ(next(rng), expected);
  }
}

TEST(Rng, UniformIsInRangeAndEven) {
  Rng rng = make_rng(7);
  double sum = 0.0;
  for (int i = 0; i < 10000; i++) {
    const float value = uniform(rng);
    ASSERT_GE(value, 0.0f);
    ASSERT_LT(value, 1.0f);
    sum += value;
  }
  EXPECT_NEAR(sum / 10000, 0.5, 0.02);
}

TEST(Rng, DirectionsAreUnitAndEven) {
  Rng rng = make_rng(9);
  vec3 sum(0.0f);
  for (int i = 0; i < 10000; i++) {
    const vec3 direction = direction_on_sphere(rng);
    ASSERT_NEAR(glm::length(direction), 1.0f, 1e-5f);
    sum += direction;
  }
  EXPECT_LT(glm::length(sum) / 10000.0f, 0.05f);
}

}  // namespace
}  // namespace tracer
