#include "tracer/render/views.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/tracer/hand_made.h"
#include "tracer/choice.h"

namespace tracer {
namespace {

constexpr int width = 64;
constexpr int height = 64;

const ViewRow& view(std::string_view id) {
  return *find_row(views(), id);
}

// A snapshot whose camera looks straight at the triangle, and one pixel of it.
struct OnePixel {
  Snapshot snapshot = hand_made_snapshot();
  Hit hit = triangle_hit();
  ClassCounters counters{};
  int depth = 0;
  int x = width / 2;
  int y = height / 2;
  int ray_class = ray_class_count;
  std::string_view counter = "nodes";

  OnePixel() {
    snapshot.film = empty_film(width, height);
    counters[0].rays = 1;
  }
  ViewInput input(std::string_view id) const {
    return view_input(snapshot, view(id), *find_row(tracer::counters(), counter), ray_class);
  }
  vec3 color(std::string_view id) const {
    const ViewInput all = input(id);
    return view(id).color({all, x, y, hit, counters, depth});
  }
  float value(std::string_view id) const {
    const ViewInput all = input(id);
    return view(id).value({all, x, y, hit, counters, depth});
  }
};

void expect_color(vec3 color, vec3 expected) {
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(color[i], expected[i], 2e-3f) << "channel " << i;
}

TEST(Views, EveryRowHasTheFunctionOfItsKind) {
  for (const ViewRow& row : views()) {
    EXPECT_EQ(row.color != nullptr, row.kind == ViewKind::color) << row.id;
    EXPECT_EQ(row.value != nullptr, row.kind == ViewKind::value) << row.id;
    EXPECT_FALSE(row.help.empty()) << row.id;
    EXPECT_EQ(find_row(views(), row.id), &row) << "the id is there twice: " << row.id;
  }
}

TEST(Views, ColorsStayInRange) {
  const OnePixel pixel;
  for (const ViewRow& row : views()) {
    if (row.kind != ViewKind::color) continue;
    const vec3 color = pixel.color(row.id);
    for (int i = 0; i < 3; ++i) {
      EXPECT_GE(color[i], 0.0f) << row.id;
      EXPECT_LE(color[i], 1.0f) << row.id;
    }
  }
}

TEST(Views, AlbedoIsTheEditedMaterialAsSrgb) {
  OnePixel pixel;
  pixel.snapshot.settings.look->materials[0].albedo = vec3(0.2140f, 1.0f, 0.0f);
  expect_color(pixel.color("albedo"), {0.5f, 1.0f, 0.0f});
}

TEST(Views, UvIsRedAndGreen) {
  OnePixel pixel;
  pixel.hit = triangle_hit(0.25f, 0.5f);
  expect_color(pixel.color("uv"), {0.25f, 0.5f, 0.0f});
}

TEST(Views, UvCheckerAlternatesEachEighth) {
  OnePixel pixel;
  pixel.hit = triangle_hit(0.05f, 0.05f);
  const float first = pixel.color("uv_checker").z;
  pixel.hit = triangle_hit(0.15f, 0.05f);
  const float right = pixel.color("uv_checker").z;
  pixel.hit = triangle_hit(0.15f, 0.15f);
  const float diagonal = pixel.color("uv_checker").z;
  EXPECT_NE(first, right);
  EXPECT_EQ(first, diagonal);
}

TEST(Views, GrowthIsThatOfTheLeafThatHoldsTheTriangle) {
  OnePixel pixel;
  EXPECT_EQ(pixel.value("growth"), 1.0f);
  auto bvh = std::make_shared<SceneBvh>(*pixel.snapshot.bvh);
  auto blas = std::make_shared<Blas>(*bvh->blases[0]);
  blas->built_areas = std::make_shared<const std::vector<float>>(1, 150.0f);  // 600 now
  bvh->blases = {blas};
  pixel.snapshot.bvh = bvh;
  EXPECT_FLOAT_EQ(pixel.value("growth"), 4.0f);
  pixel.hit = {};
  EXPECT_TRUE(std::isnan(pixel.value("growth")));
}

TEST(Views, NormalsTowardsTheViewerAreBlue) {
  expect_color(OnePixel().color("normal"), {0.5f, 0.5f, 1.0f});
  expect_color(OnePixel().color("shading_normal"), {0.5f, 0.5f, 1.0f});
}

TEST(Views, FacingIsGreenInFrontAndRedBehind) {
  OnePixel pixel;
  const vec3 front = pixel.color("facing");
  EXPECT_GT(front.g, 2.0f * front.r);
  pixel.snapshot.settings.look->camera.eye = {0, 0, -5};
  const vec3 back = pixel.color("facing");
  EXPECT_GT(back.r, 2.0f * back.g);
}

TEST(Views, BarycentricWeightsAreTheChannels) {
  OnePixel pixel;
  pixel.hit = triangle_hit(0.2f, 0.7f);
  expect_color(pixel.color("barycentric"), {0.1f, 0.2f, 0.7f});
}

TEST(Views, IdsHaveDifferentColors) {
  OnePixel pixel;
  const vec3 zero = pixel.color("triangle");
  pixel.hit.triangle = 1;
  EXPECT_GT(glm::distance(zero, pixel.color("triangle")), 0.05f);
}

// At z = 0 the picture's half height is 5 tan(22.5 degrees) = 2.071 units, so 32 pixels. The camera
// moves until the pixel lies so far above the edge from (-10,-10) to (10,-10), where v = 0.
TEST(Views, WireframeLineIsOnePixelWide) {
  OnePixel pixel;
  const float units_a_pixel = 5.0f * std::tan(pi / 8.0f) / 32.0f;
  const auto brightness = [&](float pixels_above_edge) {
    Camera& camera = pixel.snapshot.settings.look->camera;
    camera.eye.y = camera.target.y = -10.0f + (pixels_above_edge + 0.5f) * units_a_pixel;
    const float v = pixels_above_edge * units_a_pixel / 30.0f;
    pixel.hit = triangle_hit((10.0f + 0.5f * units_a_pixel - 10.0f * v) / 20.0f, v);
    return pixel.color("wireframe").g;
  };
  EXPECT_LT(brightness(0.0f), 0.1f);
  const float half_covered = brightness(0.6f);
  EXPECT_GT(half_covered, 0.2f);
  EXPECT_LT(half_covered, 0.6f);
  EXPECT_GT(brightness(1.2f), 0.7f);
  EXPECT_GT(brightness(40.0f), 0.7f);
}

TEST(Views, DepthIsTheDistanceAndNothingWithoutHit) {
  OnePixel pixel;
  EXPECT_EQ(pixel.value("depth"), 5.0f);
  pixel.hit = {};
  EXPECT_TRUE(std::isnan(pixel.value("depth")));
}

TEST(Views, CounterIsOfTheChosenClassOrOfAll) {
  OnePixel pixel;
  pixel.counters[0] = {1, 10, 0, 3, 0};
  pixel.counters[1] = {2, 30, 0, 4, 0};
  EXPECT_EQ(pixel.value("counter"), 40.0f);
  pixel.ray_class = 1;
  EXPECT_EQ(pixel.value("counter"), 30.0f);
  pixel.counter = "triangles";
  EXPECT_EQ(pixel.value("counter"), 4.0f);
  pixel.counter = "rays";
  EXPECT_EQ(pixel.value("counter"), 2.0f);
}

TEST(Views, NoRayOfTheClassIsNoValue) {
  OnePixel pixel;
  pixel.ray_class = 2;
  EXPECT_TRUE(std::isnan(pixel.value("counter")));
  EXPECT_TRUE(std::isnan(pixel.value("cost")));
}

TEST(Views, CostUsesTheConstantsOfTheBuild) {
  OnePixel pixel;
  pixel.counters[0] = {1, 10, 0, 3, 0};
  EXPECT_FLOAT_EQ(pixel.value("cost"), 10 * 1.2f + 3 * 1.0f);
}

TEST(Views, RayDepthIsTheDepthReached) {
  OnePixel pixel;
  pixel.depth = 7;
  EXPECT_EQ(pixel.value("ray_depth"), 7.0f);
}

TEST(Counters, AllIsTheSumOfTheClasses) {
  ClassCounters by_class{};
  for (int i = 0; i < ray_class_count; ++i)
    by_class[i] = {1, 2, 3, 4, 5};
  EXPECT_EQ(of_class(by_class, ray_class_count), (Counters{4, 8, 12, 16, 20}));
  EXPECT_EQ(of_class(by_class, 2), (Counters{1, 2, 3, 4, 5}));
}

}  // namespace
}  // namespace tracer
