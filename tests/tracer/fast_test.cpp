// The fast tests: nearly the hits of the watertight ones, from every kernel.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/bvh/ray_kernels.h"
#include "tracer/bvh/traverse.h"
#include "tracer/render/whitted.h"
#include "tracer/scene/camera.h"
#include "tracer/scene/scene.h"

namespace tracer::test {
namespace {

constexpr double tolerated = 1e-3;  // of the rays

// x + y <= 1 in the plane z = 2.
LeafTriangle corner_triangle() {
  return {{0, 1, 0}, {0, 0, 1}, {2, 2, 2}};
}

TriangleHit fast_hit(const LeafTriangle& triangle, vec3 origin, vec3 direction, float t_min = 0.0f,
                     float t_max = infinity) {
  return intersect(triangle, FastTriangleRay{origin, direction}, t_min, t_max);
}

TEST(FastTriangle, KnownHitFromBothSides) {
  const TriangleHit front = fast_hit(corner_triangle(), {0.25f, 0.5f, 0}, {0, 0, 4});
  EXPECT_TRUE(front.hit);
  EXPECT_EQ(front.t, 0.5f);
  EXPECT_EQ(front.u, 0.25f);
  EXPECT_EQ(front.v, 0.5f);
  const TriangleHit back = fast_hit(corner_triangle(), {0.25f, 0.5f, 4}, {0, 0, -4});
  EXPECT_TRUE(back.hit);
  EXPECT_EQ(back.t, 0.5f);
  EXPECT_EQ(back.u, 0.25f);
  EXPECT_EQ(back.v, 0.5f);
}

TEST(FastTriangle, MissesBesideAndBehindAndOutOfRange) {
  const LeafTriangle triangle = corner_triangle();
  for (const vec2 beside : {vec2(-0.1f, 0.5f), vec2(0.5f, -0.1f), vec2(0.6f, 0.6f)})
    EXPECT_FALSE(fast_hit(triangle, vec3(beside, 0), {0, 0, 1}).hit);
  EXPECT_FALSE(fast_hit(triangle, {0.25f, 0.25f, 0}, {0, 0, -1}).hit);
  EXPECT_FALSE(fast_hit(triangle, {0.25f, 0.25f, 2}, {1, 0, 0}).hit) << "in its plane";
  EXPECT_TRUE(fast_hit(triangle, {0.25f, 0.25f, 0}, {0, 0, 1}, 2.0f, 2.0f).hit);
  EXPECT_FALSE(fast_hit(triangle, {0.25f, 0.25f, 0}, {0, 0, 1}, 0.0f, 1.99f).hit);
  EXPECT_FALSE(fast_hit(triangle, {0.25f, 0.25f, 0}, {0, 0, 1}, 2.01f).hit);
  const LeafTriangle needle = {{0, 1, 0.5f}, {0, 0, 0}, {2, 2, 2}};
  EXPECT_FALSE(fast_hit(needle, {0.5f, 0, 0}, {0, 0, 1}).hit) << "without area";
}

TEST(FastTriangle, NeverHitsBehindTheEnd) {
  std::mt19937 random(5);
  const Box space{vec3(-1.0f), vec3(1.0f)};
  int hits = 0;
  for (int i = 0; i < 200000; ++i) {
    LeafTriangle triangle;
    for (int k = 0; k < 3; ++k) {
      const vec3 corner = random_point(random, space);
      triangle.x[k] = corner.x;
      triangle.y[k] = corner.y;
      triangle.z[k] = corner.z;
    }
    const vec3 from = random_point(random, space), way = random_direction(random);
    const TriangleHit first = fast_hit(triangle, from, way);
    if (!first.hit) continue;
    ++hits;
    const TriangleHit again = fast_hit(triangle, from, way, 0.0f, first.t);
    EXPECT_TRUE(!again.hit || again.t <= first.t);
  }
  EXPECT_GT(hits, 5000);
}

TEST(FastBox, HasNoMargin) {
  BvhNode node;
  node.lo = vec3(1, -1, -1);
  node.hi = vec3(3, 1, 1);
  const auto span = [&](vec3 origin, vec3 direction, float t_max) {
    return box_span<Tests::fast>(node, box_ray<Tests::fast>(origin, direction), 0.0f, t_max);
  };
  EXPECT_EQ(span({0, 0, 0}, {2, 0, 0}, infinity).entry, 0.5f);
  EXPECT_EQ(span({0, 0, 0}, {2, 0, 0}, infinity).exit, 1.5f);
  EXPECT_TRUE(span({0, 0, 0}, {1, 0, -0.0f}, 1.0f).hit);
  EXPECT_FALSE(span({0, 0, 0}, {1, 0, 0}, 0.9999999f).hit);
  EXPECT_FALSE(span({0, 1.001f, 0}, {1, 0, 0}, infinity).hit);
  EXPECT_FALSE(span({0, 0, 0}, {-1, 0, 0}, infinity).hit);
}

// Blocks of 4 x 4 pixels from outside, then rays that have nothing in common; some end on the way,
// some are not valid.
std::vector<Ray> rays_at(const Box& box) {
  Camera camera;
  camera.eye = center(box) + vec3(0.9f, 0.6f, 1.3f) * glm::length(extent(box));
  camera.target = center(box);
  const CameraFrame view = frame(camera, 128, 128);
  std::vector<Ray> rays;
  for (int block = 0; block < 32 * 32; ++block) {
    for (int pixel = 0; pixel < 16; ++pixel) {
      const vec2 at(block % 32 * 4 + pixel % 4, block / 32 * 4 + pixel / 4);
      rays.push_back(primary_ray(view, at + 0.5f));
    }
  }
  std::mt19937 random(7);
  for (int i = 0; i < 16384; ++i) {
    Ray ray;
    ray.origin = random_point(random, box);
    ray.direction = (i % 3 == 0 ? 0.01f : 1.0f) * random_direction(random);
    if (i % 5 == 0) ray.t_max = 0.3f * glm::length(extent(box)) / glm::length(ray.direction);
    if (i % 7 == 0) ray.direction[i % 3] = 0.0f;
    rays.push_back(ray);
  }
  rays.back().direction = vec3(0.0f);
  rays[100].origin.x = std::numeric_limits<float>::quiet_NaN();
  return rays;
}

bool is_near(const Hit& a, const Hit& b, float scale) {
  if (!is_hit(a) || !is_hit(b)) return is_hit(a) == is_hit(b);
  const bool same_triangle = a.triangle == b.triangle && a.instance == b.instance;
  if (same_triangle && glm::length(vec2(a.u - b.u, a.v - b.v)) > 1e-3f) return false;
  return std::abs(a.t - b.t) <= scale + 1e-4f * std::abs(b.t);
}

struct Case {
  const char* name;
  Scene scene;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  all.push_back({"closed", scene_of({sphere(40, 1.0f, vec3(2, 3, 4), 0.2f)})});
  all.push_back({"several", scene_of({soup(3000, 0.1f), sphere(12, 0.4f), grid(6)})});
  all.push_back({"teapots", load_scene(parse_scene_source("teapots"), {})});
  all.push_back({"terrain", load_scene(parse_scene_source("terrain:triangles=20000"), {})});
  return all;
}

class FastKernels : public testing::TestWithParam<std::string> {
 protected:
  std::vector<std::pair<SceneBvh, std::string>> bvhs() const {
    std::vector<std::pair<SceneBvh, std::string>> all;
    for (const Case& one : cases()) {
      BuildOptions options;
      options.layout = GetParam();
      all.emplace_back(bvh_of(one.scene, options), one.name);
    }
    return all;
  }
};

TEST_P(FastKernels, AgreeWithTheWatertightOnesForNearlyAllRays) {
  for (const auto& [bvh, name] : bvhs()) {
    const std::vector<Ray> rays = rays_at(bounds(bvh));
    const float scale = 1e-5f * glm::length(extent(bounds(bvh)));
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    std::vector<uint8_t> blocked(rays.size());
    ray_kernel(GetParam()).intersect(bvh, rays, expected);
    EXPECT_GT(std::count_if(expected.begin(), expected.end(), is_hit), 2000) << name;
    for (const IsaRow& isa : isas()) {
      for (const KernelRow& kernel : ray_kernels()) {
        const RayKernel fast = ray_kernel(GetParam(), kernel.id, isa.id, Tests::fast);
        fast.intersect(bvh, rays, hits);
        fast.occluded(bvh, rays, blocked);
        int differ = 0, blocked_otherwise = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
          const float tolerance = scale / std::max(glm::length(rays[i].direction), 1e-9f);
          differ += is_near(hits[i], expected[i], tolerance) ? 0 : 1;
          blocked_otherwise += (blocked[i] != 0) == is_hit(hits[i]) ? 0 : 1;
          if (is_hit(hits[i])) {
            ASSERT_LE(hits[i].t, rays[i].t_max);
            ASSERT_GE(std::min({hits[i].u, hits[i].v, 1.001f - hits[i].u - hits[i].v}), 0.0f);
          }
        }
        const double most = tolerated * double(rays.size());
        EXPECT_LE(differ, most) << name << " " << kernel.id << " " << isa.id;
        EXPECT_LE(blocked_otherwise, most) << name << " " << kernel.id << " " << isa.id;
        EXPECT_FALSE(is_hit(hits[100]) || is_hit(hits.back())) << "of rays that are not valid";
      }
    }
  }
}

// Every row has functions of its own, so that a test above compares what it says.
TEST_P(FastKernels, AreOthers) {
  for (const IsaRow& isa : isas()) {
    for (const KernelRow& kernel : ray_kernels()) {
      const RayKernel watertight = ray_kernel(GetParam(), kernel.id, isa.id);
      const RayKernel fast = ray_kernel(GetParam(), kernel.id, isa.id, Tests::fast);
      EXPECT_NE(fast.intersect, watertight.intersect) << kernel.id;
      EXPECT_NE(fast.occluded, watertight.occluded) << kernel.id;
      const bool is_own = has_kernel(GetParam(), kernel.id) && kernel.id != ray_kernels()[0].id;
      const RayKernel single = ray_kernel(GetParam(), "single", isa.id, Tests::fast);
      EXPECT_EQ(fast.intersect != single.intersect, is_own) << kernel.id;
    }
  }
}

TEST_P(FastKernels, FindNothingInAnEmptyScene) {
  BuildOptions options;
  options.layout = GetParam();
  const SceneBvh bvh = bvh_of(scene_of({}), options);
  const Ray ray{vec3(0.0f), 0.0f, vec3(1, 0, 0), infinity};
  for (const KernelRow& kernel : ray_kernels()) {
    Hit hit;
    uint8_t blocked = 1;
    const RayKernel fast = ray_kernel(GetParam(), kernel.id, {}, Tests::fast);
    fast.intersect(bvh, {&ray, 1}, {&hit, 1});
    fast.occluded(bvh, {&ray, 1}, {&blocked, 1});
    EXPECT_FALSE(is_hit(hit));
    EXPECT_EQ(blocked, 0);
  }
}

std::vector<std::string> layout_ids() {
  std::vector<std::string> ids;
  for (const LayoutRow& layout : layouts())
    ids.emplace_back(layout.id);
  return ids;
}
INSTANTIATE_TEST_SUITE_P(Fast, FastKernels, testing::ValuesIn(layout_ids()),
                         [](const auto& info) { return info.param; });

// The first pass stays as it is; the others trace nearly the same picture.
TEST(FastPicture, IsThatOfTheWatertightTests) {
  const Scene scene = load_scene(parse_scene_source("teapots"), {});
  BuildOptions build;
  build.layout = "wide8";
  const SceneBvh bvh = bvh_of(scene, build);
  const Look look = look_of(scene);
  const CameraFrame view = frame(scene.camera, 64, 48);
  std::vector<vec2> points;
  for (int i = 0; i < 64 * 48; ++i)
    points.emplace_back(i % 64 + 0.5f, i / 64 + 0.5f);
  const auto picture = [&](bool fast, bool counting) {
    RenderOptions options;
    options.fast = fast;
    Whitted whitted;
    whitted.trace({scene, bvh, look, options}, view, points, counting);
    return std::vector<vec3>(whitted.radiance().begin(), whitted.radiance().end());
  };
  EXPECT_EQ(picture(true, true), picture(false, true));
  const std::vector<vec3> plain = picture(false, false), fast = picture(true, false);
  size_t close = 0;
  for (size_t i = 0; i < points.size(); ++i)
    close += glm::length(plain[i] - fast[i]) <= 0.02f * (1.0f + glm::length(plain[i])) ? 1 : 0;
  EXPECT_GE(close, points.size() * 98 / 100);
  EXPECT_NE(plain, fast) << "the setting must reach the kernels";
}

}  // namespace
}  // namespace tracer::test
