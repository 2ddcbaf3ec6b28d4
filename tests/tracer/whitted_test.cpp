// Light transport with answers known beforehand.
#include "tracer/render/whitted.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/bvh/ray_kernels.h"

namespace tracer::test {
namespace {

// A square of 20 x 20 in the plane y = 0 that faces up, seen from straight above.
class Ground : public testing::Test {
 protected:
  Ground() {
    Mesh mesh = grid(1);
    for (vec3& position : mesh.positions)
      position = 20.0f * (position - vec3(0.5f, 0.0f, 0.5f));
    scene = scene_of({mesh});
    look.materials = scene.materials;
    look.sky.flat_color = vec3(0.25f);
    look.ambient = vec3(0.0f);
    look.camera.eye = vec3(0.3f, 4, 0.2f);
    look.camera.target = vec3(0.3f, 0, 0.2f);
    options.width = options.height = 1;
  }

  vec3 radiance(bool counting = true) {
    const SceneBvh bvh = bvh_of(scene);
    const World world{scene, bvh, look, options};
    const vec2 middle[] = {vec2(0.5f)};
    whitted.trace(world, frame(look.camera, 1, 1), middle, counting);
    return whitted.radiance()[0];
  }
  Counters counters(RayClass ray_class) const {
    return whitted.counters()[0][static_cast<size_t>(ray_class)];
  }
  void expect_radiance(const vec3& expected) {
    const vec3 found = radiance();
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(found[k], expected[k], 1e-4f * (1.0f + expected[k]));
    EXPECT_EQ(radiance(false), found) << "counting must not change the picture";
  }

  Scene scene;
  Look look;
  RenderOptions options;
  Whitted whitted;
};

TEST_F(Ground, AmbientIsAlbedoTimesAmbient) {
  look.materials[0].albedo = vec3(0.5f, 0.25f, 1.0f);
  look.ambient = vec3(0.2f, 0.4f, 0.6f);
  expect_radiance(vec3(0.1f, 0.1f, 0.6f));
}

TEST_F(Ground, PointLightFallsOffWithTheSquare) {
  look.materials[0].albedo = vec3(1.0f);
  Light light;
  light.color = vec3(8.0f);
  light.position = vec3(0.3f, 2.0f, 0.2f);
  look.lights = {light};
  expect_radiance(vec3(2.0f));
  look.lights[0].position.y = 4.0f;
  expect_radiance(vec3(0.5f));
}

TEST_F(Ground, ObliqueLightIsWeakerByTheCosine) {
  look.materials[0].albedo = vec3(1.0f);
  Light light;
  light.color = vec3(25.0f * 5.0f);
  light.position = vec3(0.3f + 4.0f, 3.0f, 0.2f);  // distance 5, cosine 3/5
  look.lights = {light, light};
  look.lights[1].on = false;
  expect_radiance(vec3(3.0f));
}

TEST_F(Ground, LightBelowDoesNotArrive) {
  Light light;
  light.position = vec3(0.3f, -1.0f, 0.2f);
  look.lights = {light};
  expect_radiance(vec3(0.0f));
  EXPECT_EQ(counters(RayClass::shadow).rays, 0u);
}

TEST_F(Ground, ShadowsCanBeSwitchedOff) {
  // A lid between the light and the ground, out of the camera's way.
  Mesh lid = grid(1);
  for (vec3& position : lid.positions)
    position = position + vec3(1.0f, 1.0f, -0.3f);
  scene.meshes.push_back(scene_of({lid}).meshes[0]);
  scene.instances.push_back({});
  scene.instances[1].mesh = 1;
  Light light;
  light.position = vec3(2.3f, 2.0f, 0.2f);
  light.color = vec3(8.0f * std::sqrt(2.0f));
  look.lights = {light};
  look.materials[0].albedo = vec3(1.0f);
  expect_radiance(vec3(0.0f));
  options.shadows = false;
  expect_radiance(vec3(1.0f));
}

TEST_F(Ground, AMirrorShowsTheSky) {
  look.materials[0].reflectivity = 1.0f;
  look.materials[0].specular = vec3(1.0f, 0.5f, 0.0f);
  expect_radiance(vec3(0.25f, 0.125f, 0.0f));
  radiance();
  EXPECT_EQ(counters(RayClass::reflection).rays, 1u);
  EXPECT_EQ(whitted.depth()[0], 1);
}

TEST_F(Ground, DepthZeroIsPrimaryOnly) {
  look.materials[0].reflectivity = 1.0f;
  options.ray_depth = 0;
  expect_radiance(vec3(0.0f));
  radiance();
  EXPECT_EQ(counters(RayClass::reflection).rays, 0u);
  EXPECT_EQ(whitted.depth()[0], 0);
}

TEST_F(Ground, HalfMirrorMixes) {
  look.materials[0].reflectivity = 0.5f;
  look.materials[0].albedo = vec3(1.0f);
  look.ambient = vec3(0.6f);
  expect_radiance(vec3(0.3f + 0.125f));
}

// White furnace: whatever light does in a closed or glass world of equal radiance, it stays equal.
TEST_F(Ground, GlassInAWhiteFurnaceIsInvisible) {
  scene = scene_of({sphere(24)});
  look.materials = scene.materials;
  look.materials[0].transmission = 1.0f;
  look.sky.flat_color = vec3(1.0f);
  look.camera.eye = vec3(0.35f, 3.0f, 0.2f);
  look.camera.target = vec3(0.35f, 0, 0.2f);
  options.ray_depth = 32;
  const vec3 found = radiance();
  EXPECT_NEAR(found.x, 1.0f, 5e-3f);  // paths below a weight of 1/1024 are dropped
  EXPECT_GT(counters(RayClass::refraction).rays, 0u);
  EXPECT_GT(counters(RayClass::reflection).rays, 0u);
}

TEST_F(Ground, GlassReflectsFourPercentAtRightAngles) {
  // Under the glass it is dark: only the reflection comes back.
  look.materials[0].transmission = 1.0f;
  look.materials[0].refraction_index = 1.5f;
  Mesh floor = scene.meshes[0];
  for (vec3& position : floor.positions)
    position.y -= 1.0f;
  floor.materials.assign(floor.triangles.size(), 1);
  scene.meshes.push_back(floor);
  scene.instances.push_back({});
  scene.instances[1].mesh = 1;
  Material black;
  black.albedo = vec3(0.0f);
  look.materials.push_back(black);
  expect_radiance(vec3(0.04f * 0.25f));
}

TEST_F(Ground, RefractionBendsBySnell) {
  // 45 degrees into glass of index sqrt(2) goes on at 30 degrees: a spot of emission shows where.
  look.materials[0].transmission = 1.0f;
  look.materials[0].refraction_index = std::sqrt(2.0f);
  look.camera.eye = vec3(-4, 4, 0.1f);
  look.camera.target = vec3(0, 0, 0.1f);
  Mesh spot = grid(1);
  const float x = std::tan(pi / 6.0f);  // at depth 1
  for (vec3& position : spot.positions) {
    position = 0.02f * (position - vec3(0.5f, 0, 0.5f)) + vec3(x, -1.0f, 0.1f);
  }
  spot.normals.assign(spot.positions.size(), vec3(0, 1, 0));
  spot.materials.assign(spot.triangles.size(), 1);
  scene.meshes.push_back(spot);
  scene.instances.push_back({});
  scene.instances[1].mesh = 1;
  Material lamp;
  lamp.emission = vec3(10.0f);
  look.materials.push_back(lamp);
  EXPECT_GT(radiance().x, 5.0f);
}

TEST_F(Ground, TotalReflectionInside) {
  // From below, beyond the critical angle of 41.8 degrees, everything is reflected.
  look.materials[0].transmission = 1.0f;
  look.camera.eye = vec3(0, -1, 0.1f);
  look.camera.target = vec3(2, 0, 0.1f);
  expect_radiance(vec3(0.25f));
  radiance();
  EXPECT_EQ(counters(RayClass::refraction).rays, 0u);
  EXPECT_EQ(counters(RayClass::reflection).rays, 1u);
}

TEST_F(Ground, FacingMirrorsStopAtTheDepth) {
  Mesh ceiling = scene.meshes[0];
  for (vec3& position : ceiling.positions)
    position.y = 5.0f;
  scene.meshes.push_back(ceiling);
  scene.instances.push_back({});
  scene.instances[1].mesh = 1;
  look.materials[0].reflectivity = 1.0f;
  options.ray_depth = 32;
  radiance();
  EXPECT_EQ(whitted.depth()[0], 32);
  EXPECT_EQ(counters(RayClass::reflection).rays, 32u);
}

TEST_F(Ground, OnlyTheFastPassIsTimed) {
  radiance(true);
  EXPECT_EQ(whitted.rates()[0].rays, 0u);
  radiance(false);
  EXPECT_EQ(whitted.rates()[0].rays, 1u);
  EXPECT_GT(whitted.rates()[0].seconds, 0.0);
}

// Mirrors, glass and shadows, from a camera that sees all classes of rays.
class ChosenKernel : public testing::TestWithParam<const LayoutRow*> {
 protected:
  ChosenKernel() {
    BuildOptions build;
    build.layout = GetParam()->id;
    bvh = bvh_of(scene, build);
    const int size = 48;
    for (int i = 0; i < size * size; ++i)
      points.emplace_back(float(i % size) + 0.5f, float(i / size) + 0.5f);
    camera = frame(look.camera, size, size);
  }

  std::vector<vec3> picture(Whitted& whitted) {
    whitted.trace({scene, bvh, look, options}, camera, points, false);
    return {whitted.radiance().begin(), whitted.radiance().end()};
  }

  Scene scene = load_scene(parse_scene_source("showcase"), {});
  Look look = look_of(scene);
  RenderOptions options;
  SceneBvh bvh;
  std::vector<vec2> points;
  CameraFrame camera;
};

TEST_P(ChosenKernel, TracesItsClassAloneAndThePictureIsTheSame) {
  const std::string_view layout = GetParam()->id;
  Whitted automatic;
  const std::vector<vec3> expected = picture(automatic);
  for (const KernelRow& kernel : ray_kernels()) {
    for (size_t i = 0; i < ray_class_count; ++i) {
      SCOPED_TRACE(fmt::format("{} {}", kernel.id, ray_classes()[i].id));
      options = {};
      options.kernels[i] = kernel.id;
      const bool has = has_kernel(layout, kernel.id);
      EXPECT_EQ(kernel_of(options, layout, RayClass(i)), has ? kernel.id : automatic_kernel);
      Whitted whitted;
      EXPECT_EQ(picture(whitted), expected);
      const RayRate& rate = whitted.rates()[i];
      EXPECT_EQ(rate.rays, automatic.rates()[i].rays);
      EXPECT_GT(rate.rays, 0u);
      if (!has) continue;
      EXPECT_EQ(rate.in_packets, kernel.id == "packet" ? rate.rays : 0);
      EXPECT_EQ(rate.in_streams, kernel.id == "stream" ? rate.rays : 0);
    }
  }
}

TEST_P(ChosenKernel, ThatIsNotKnownCountsAsAutomatic) {
  Whitted automatic, unknown;
  const std::vector<vec3> expected = picture(automatic);
  options.kernels.fill("x");
  EXPECT_EQ(kernel_of(options, GetParam()->id, RayClass::shadow), automatic_kernel);
  EXPECT_EQ(picture(unknown), expected);
}

std::vector<const LayoutRow*> all_layouts() {
  std::vector<const LayoutRow*> rows;
  for (const LayoutRow& row : layouts())
    rows.push_back(&row);
  return rows;
}
INSTANTIATE_TEST_SUITE_P(Layouts, ChosenKernel, testing::ValuesIn(all_layouts()),
                         [](const auto& info) { return std::string(info.param->id); });

TEST(KernelChoice, TakesTheFasterOneAndTriesTheOtherNowAndThen) {
  KernelChoice choice;
  EXPECT_EQ(choice.next(5), "single");  // too few for a stream
  const auto streams_of = [&](double single_seconds, double stream_seconds) {
    int streams = 0;
    for (int turn = 0; turn < 160; ++turn) {
      const std::string_view kernel = choice.next(1000);
      const bool stream = kernel == "stream";
      choice.took(kernel, 1000, stream ? stream_seconds : single_seconds);
      streams += stream ? 1 : 0;
    }
    return streams;
  };
  EXPECT_GT(streams_of(2.0, 1.0), 130);
  EXPECT_LT(streams_of(1.0, 2.0), 60);  // notices that the other is faster now
  const int still_single = streams_of(1.0, 2.0);
  EXPECT_LT(still_single, 20);
  EXPECT_GT(still_single, 0);
  EXPECT_GT(streams_of(2.0, 1.0), 80);   // and back
  choice.took("packet", 1000000, 1e-6);  // say nothing of the two
  choice.took("single", 5, 1e-9);
  EXPECT_GT(streams_of(2.0, 1.0), 130);
}

}  // namespace
}  // namespace tracer::test
