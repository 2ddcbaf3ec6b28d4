// Boxes drawn into pictures: where their lines are, what fades behind surfaces.
#include "tracer/render/overlay.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "hand_made.h"
#include "tracer/render/overlay_raster.h"
#include "tracer/scene/camera.h"

namespace tracer {
namespace {

constexpr uint32_t black = 0xff000000u;

// The box of the hand-made scene, [-1, 1] in x and y and from z_lo to z_hi, before a surface at
// z = 0 or before nothing.
struct Stage {
  Snapshot snapshot = hand_made_snapshot();
  Picture picture;
  BoxOptions options;

  Stage(float z_lo, float z_hi, bool surface, int width = 200, int height = 100) {
    auto bvh = std::make_shared<SceneBvh>(*snapshot.bvh);
    auto blas = std::make_shared<Blas>(*bvh->blases[0]);
    blas->tree.nodes[0].lo = {-1, -1, z_lo};
    blas->tree.nodes[0].hi = {1, 1, z_hi};
    bvh->blases[0] = blas;
    snapshot.bvh = bvh;
    const CameraFrame camera = frame(snapshot.settings.look->camera, width, height);
    snapshot.film = hand_made_film(width, height, [&](int x, int y) {
      if (!surface) return PixelContent();
      const Ray ray = primary_ray(camera, vec2(x, y) + 0.5f);
      Hit hit = triangle_hit();
      hit.t = -ray.origin.z / ray.direction.z;
      return pixel_of(hit);
    });
    options.show = true;
    options.tree = "blas";
    picture.image = {width, height, std::vector<uint32_t>(size_t(width) * height, black)};
  }

  CameraFrame camera() const {
    return frame(snapshot.settings.look->camera, snapshot.film.width, snapshot.film.height);
  }
  void draw() { draw_boxes(picture, snapshot, node_boxes(snapshot.bvh, options, {}), options); }
  int brightness(vec2 at) const {
    const uint32_t pixel =
        picture.image.pixels[size_t(at.y) * size_t(picture.image.width) + size_t(at.x)];
    return int(std::max({pixel & 0xff, pixel >> 8 & 0xff, pixel >> 16 & 0xff}));
  }
  int brightness_of(vec3 point) const { return brightness(project(camera(), point)->pixel); }
  size_t drawn() const {
    return picture.image.pixels.size() -
           size_t(std::count(picture.image.pixels.begin(), picture.image.pixels.end(), black));
  }
};

TEST(Overlay, EdgesLieWhereTheCameraSeesThem) {
  Stage stage(-1, 1, false);
  stage.options.fade_hidden = false;
  stage.draw();
  for (const float z : {-1.0f, 1.0f}) {
    EXPECT_GT(stage.brightness_of({1, 0.3f, z}), 100) << z;
    EXPECT_GT(stage.brightness_of({-0.4f, -1, z}), 100) << z;
  }
  EXPECT_GT(stage.brightness_of({1, 1, 0.2f}), 100);
  EXPECT_EQ(stage.brightness_of({0.2f, 0.3f, 1}), 0) << "inside of a face";
  EXPECT_EQ(stage.brightness({2, 2}), 0);
  ASSERT_TRUE(stage.picture.boxes);
  EXPECT_EQ(stage.picture.boxes->drawn, 1u);
}

TEST(Overlay, FollowsAnOrthographicCamera) {
  Stage stage(-1, 1, false);
  stage.snapshot.settings.look->camera.orthographic = true;
  stage.snapshot.settings.look->camera.eye = {2, 1, 5};
  stage.draw();
  for (const vec3 point : {vec3(1, 0.3f, 1), vec3(-0.4f, -1, 1), vec3(1, 1, 0.2f)})
    EXPECT_GT(stage.brightness_of(point), 100);
}

TEST(Overlay, WhatIsBehindASurfaceIsFainter) {
  Stage stage(-3, 2, true);
  stage.draw();
  const int front = stage.brightness_of({1, 0.3f, 2});
  const int back = stage.brightness_of({1, 0.3f, -3});
  EXPECT_GT(front, 100);
  EXPECT_GT(back, 5);
  EXPECT_LT(3 * back, front);
  stage.options.fade_hidden = false;
  std::fill(stage.picture.image.pixels.begin(), stage.picture.image.pixels.end(), black);
  stage.draw();
  EXPECT_GT(stage.brightness_of({1, 0.3f, -3}), 100);
}

TEST(Overlay, ABoxThatTouchesTheSurfaceIsNotHiddenByIt) {
  Stage stage(0, 0, true);
  stage.draw();
  EXPECT_GT(stage.brightness_of({1, 0.3f, 0}), 100);
}

TEST(Overlay, FacesAreTranslucent) {
  Stage stage(-1, 1, false);
  stage.options.wire = false;
  stage.draw();
  EXPECT_EQ(stage.drawn(), 0u);
  stage.options.translucent = true;
  stage.draw();
  const int face = stage.brightness_of({0.2f, 0.3f, 1});
  EXPECT_GT(face, 10);
  EXPECT_LT(face, 100);
}

TEST(Overlay, TheCameraMayBeInsideTheBoxOrBehindIt) {
  Stage inside(-50, 50, false);
  inside.draw();
  EXPECT_GT(inside.drawn(), 0u);
  Stage behind(6, 50, false);
  behind.draw();
  EXPECT_EQ(behind.drawn(), 0u);
}

TEST(Overlay, BoxesOfAnotherBvhAreNotDrawn) {
  Stage stage(-1, 1, false);
  const NodeBoxes boxes = node_boxes(stage.snapshot.bvh, stage.options, {});
  stage.snapshot.bvh = std::make_shared<const SceneBvh>(*stage.snapshot.bvh);
  draw_boxes(stage.picture, stage.snapshot, boxes, stage.options);
  EXPECT_FALSE(stage.picture.boxes);
  EXPECT_EQ(stage.drawn(), 0u);
}

TEST(Overlay, IsTheSameForAnyNumberOfThreads) {
  Settings settings;
  settings.source.name = "teapots";
  settings.render = {.width = 160, .height = 120, .ray_depth = 0, .samples = 1};
  Pipeline pipeline;
  pipeline.run(settings, {}, {});
  const Snapshot& snapshot = *pipeline.snapshot();
  BoxOptions options;
  options.show = options.translucent = true;
  options.last_level = 12;
  options.color = "sah";
  const auto image = [&] {
    Picture picture = colorize(snapshot, {});
    draw_boxes(picture, snapshot, node_boxes(snapshot.bvh, options, {}), options);
    return picture.image.pixels;
  };
  const auto many = image();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(image(), many);
  EXPECT_NE(colorize(snapshot, {}).image.pixels, many);
}

TEST(Overlay, TheLegendIsInTheLowerRight) {
  Stage stage(-1, 1, false, 1280, 720);
  stage.draw();
  const auto without = stage.picture.image.pixels;
  draw_box_legend(stage.picture, stage.options);
  size_t changed = 0;
  for (int y = 0; y < 720; ++y) {
    for (int x = 0; x < 1280; ++x) {
      const size_t i = size_t(y) * 1280 + size_t(x);
      if (stage.picture.image.pixels[i] == without[i]) continue;
      ++changed;
      ASSERT_GT(x, 640);
      ASSERT_GT(y, 360);
    }
  }
  EXPECT_GT(changed, 10000u);
}

TEST(OverlaySources, CountWhatTheColoursAskFor) {
  Settings settings;
  settings.source.name = "showcase";
  settings.render = {.width = 64, .height = 48, .ray_depth = 1, .samples = 1};
  Pipeline pipeline;
  pipeline.run(settings, {}, {});
  const Snapshot& snapshot = *pipeline.snapshot();
  BoxOptions options;
  EXPECT_EQ(box_sources(snapshot, options, {}), BoxSources());
  for (const char* color : {"visits", "observed", "epo"}) {
    options.color = color;
    const BoxSources sources = box_sources(snapshot, options, {});
    EXPECT_TRUE(node_boxes(snapshot.bvh, options, sources).has_values) << color;
  }
}

// Rows of an image of one value a pixel: how much of it the line covers.
std::vector<int> covered(const ScreenLine& line, float width, int size) {
  Image image{size, size, std::vector<uint32_t>(size_t(size) * size_t(size), black)};
  for (int y = 0; y < size; y += 4) {
    draw_line({image, y, std::min(y + 4, size), {}}, line, width, {0xffffffffu, 1.0f, 1.0f});
  }
  std::vector<int> values;
  for (const uint32_t pixel : image.pixels)
    values.push_back(int(pixel & 0xff));
  return values;
}

TEST(OverlayRaster, ALineCoversItsWidthTimesItsLength) {
  for (const vec2 end : {vec2(56, 8), vec2(56, 30), vec2(40, 56), vec2(8, 56), vec2(50, 47)}) {
    for (const float width : {1.0f, 2.0f, 3.5f}) {
      const std::vector<int> values = covered({{8, 8, 0}, {end, 0}}, width, 64);
      double sum = 0.0;
      for (const int value : values)
        sum += double(value) / 255.0;
      const double length = double(glm::length(end - vec2(8, 8)));
      EXPECT_NEAR(sum, double(width) * length, 0.06 * double(width) * length + 2.0);
    }
  }
}

TEST(OverlayRaster, ALineThroughNothingOfTheImageIsCutAway) {
  ScreenLine line{{-50, 10, 0}, {-20, 90, 0}};
  EXPECT_FALSE(clip(line, 100, 100, 4));
  line = {{-50, 50, 1}, {150, 50, 3}};
  ASSERT_TRUE(clip(line, 100, 100, 0));
  EXPECT_EQ(line.from, vec3(0, 50, 1.5f));
  EXPECT_EQ(line.to, vec3(100, 50, 2.5f));
}

}  // namespace
}  // namespace tracer
