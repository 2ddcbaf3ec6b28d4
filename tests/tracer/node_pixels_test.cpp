// The pixels of a node against the logs of their rays.
#include "tracer/analyze/node_pixels.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "make_scene.h"
#include "tracer/analyze/ray_log.h"

namespace tracer::test {
namespace {

// Two balls of one mesh, a mirror below them, a light above: rays of three classes.
struct Mirrored {
  Mirrored() {
    Mesh floor = grid(4);
    for (vec3& position : floor.positions)
      position = 8.0f * (position - vec3(0.5f, 0.13f, 0.5f));
    scene = scene_of({sphere(8), floor});
    scene.instances[0].transform = glm::translate(mat4(1.0f), vec3(-1.2f, 0, 0));
    scene.instances.push_back(scene.instances[0]);
    scene.instances[2].transform = glm::translate(mat4(1.0f), vec3(1.2f, 0, 0));
    scene.materials.resize(2);
    scene.materials[1].reflectivity = 0.8f;
    std::fill(scene.meshes[1].materials.begin(), scene.meshes[1].materials.end(), 1u);
    look = look_of(scene);
    Light light;
    light.position = vec3(0, 5, 3);
    look.lights = {light};
    look.camera.eye = vec3(0, 1, 6);
    look.camera.target = vec3(0);
    options.width = 80;
    options.height = 50;
    bvh = std::make_shared<const SceneBvh>(bvh_of(scene));
  }
  World world() const { return {scene, *bvh, look, options}; }
  CameraFrame camera() const { return frame(look.camera, options.width, options.height); }
  NodePixels pixels(const Watched& node) const {
    return node_pixels(world(), bvh, camera(), node, {});
  }

  Scene scene;
  Look look;
  RenderOptions options;
  std::shared_ptr<const SceneBvh> bvh;
};

// What a log of the pixel's rays says.
uint8_t entered(const RayLog& log, const Watched& node) {
  uint8_t bits = 0;
  for (const LoggedRay& ray : log.rays) {
    for (const Step& step : ray.steps) {
      if (step.result != StepResult::entered || step.id != node.node) continue;
      if (step.kind != StepKind::node && step.kind != StepKind::leaf) continue;
      const bool top = step.instance == none;
      if (top != (node.mesh == none)) continue;
      if (!top && log.bvh->instances[step.instance].mesh != node.mesh) continue;
      if (!top && node.instance != none && step.instance != node.instance) continue;
      bits |= uint8_t(1u << int(ray.cast.ray_class));
    }
  }
  return bits;
}

TEST(NodePixels, AreThoseOfTheRayLogs) {
  const Mirrored scene;
  const World world = scene.world();
  for (const Watched& node : {Watched{none, 0, none}, Watched{none, 1, none}, Watched{0, 0, none},
                              Watched{0, 5, none}, Watched{0, 5, 2}, Watched{1, 2, none}}) {
    const NodePixels pixels = scene.pixels(node);
    uint64_t some = 0;
    for (int y = 0; y < pixels.height; ++y) {
      for (int x = 0; x < pixels.width; ++x) {
        const RayLog log = log_pixel(world, scene.bvh, scene.camera(), {x, y});
        const uint8_t wanted = entered(log, node);
        ASSERT_EQ(pixels.entered[size_t(y * pixels.width + x)], wanted)
            << x << " " << y << " node " << node.node;
        some += wanted != 0 ? 1 : 0;
      }
    }
    EXPECT_GT(some, 0u) << node.node;
    EXPECT_EQ(count(pixels, ray_class_count), some);
  }
}

TEST(NodePixels, OfOneInstanceAreFewer) {
  const Mirrored scene;
  const uint64_t both = count(scene.pixels({0, 0, none}), ray_class_count);
  const uint64_t left = count(scene.pixels({0, 0, 0}), ray_class_count);
  const uint64_t right = count(scene.pixels({0, 0, 2}), ray_class_count);
  EXPECT_LT(left, both);
  EXPECT_LT(right, both);
  EXPECT_GE(left + right, both);
}

TEST(NodePixels, AreTheSameForAnyNumberOfThreads) {
  const Mirrored scene;
  const NodePixels many = scene.pixels({0, 3, none});
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(scene.pixels({0, 3, none}).entered, many.entered);
}

TEST(NodePixels, StoppedIsOfNothing) {
  const Mirrored scene;
  std::stop_source source;
  source.request_stop();
  const Job job{source.get_token(), nullptr};
  EXPECT_EQ(node_pixels(scene.world(), scene.bvh, scene.camera(), {}, job).bvh, nullptr);
}

TEST(NodePixels, BlocksCoverEachPixelOnce) {
  const Mirrored scene;
  const NodePixels pixels = scene.pixels({0, 2, none});
  for (int ray_class = 0; ray_class <= ray_class_count; ++ray_class) {
    std::vector<int> covered(pixels.entered.size(), 0);
    const std::vector<PixelBlock> blocks = blocks_of(pixels, ray_class);
    for (const PixelBlock& block : blocks) {
      for (int y = block.y0; y < block.y1; ++y) {
        for (int x = block.x0; x < block.x1; ++x)
          ++covered[size_t(y * pixels.width + x)];
      }
    }
    for (size_t i = 0; i < covered.size(); ++i)
      ASSERT_EQ(covered[i], has_class(pixels.entered[i], ray_class) ? 1 : 0);
  }
}

TEST(NodePixels, BlocksJoinEqualRuns) {
  NodePixels pixels;
  pixels.width = 5;
  pixels.height = 3;
  pixels.entered = {0, 1, 1, 0, 1,  //
                    0, 1, 1, 0, 0,  //
                    1, 1, 1, 0, 2};
  EXPECT_EQ(blocks_of(pixels, 0).size(), 3u);
  EXPECT_EQ(blocks_of(pixels, 1).size(), 1u);
  EXPECT_EQ(count(pixels, ray_class_count), 9u);
}

}  // namespace
}  // namespace tracer::test
