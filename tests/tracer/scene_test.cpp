// Poses, bounds and cameras.
#include "tracer/scene/scene.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/bvh/ray_kernels.h"

namespace tracer::test {
namespace {

void expect_near(const vec3& a, const vec3& b, float tolerance = 1e-5f) {
  EXPECT_LT(glm::length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z;
}

TEST(Pose, WithoutMotionIsTheTransform) {
  Instance instance;
  instance.transform = glm::translate(mat4(1.0f), vec3(1, 2, 3));
  EXPECT_EQ(pose(instance, 17.0f), instance.transform);
}

TEST(Pose, BouncesInTheWorldAndSpinsAboutThePivot) {
  Instance instance;
  instance.transform = glm::scale(mat4(1.0f), vec3(2.0f));
  instance.motion = {
      .spin = pi, .bounce_height = 3.0f, .bounce_rate = pi, .phase = 0.0f, .pivot = vec3(1, 0, 0)};
  const mat4 half = pose(instance, 0.5f);  // a quarter turn, the top of the bounce
  expect_near(vec3(half * vec4(1, 0, 0, 1)), vec3(2, 3, 0));
  expect_near(vec3(half * vec4(2, 0, 0, 1)), vec3(2, 3, -2));
}

TEST(SceneBounds, OfAllInstances) {
  Scene scene = scene_of({sphere(8)});
  Instance instance;
  instance.transform = glm::translate(mat4(1.0f), vec3(10, 0, 0));
  scene.instances.push_back(instance);
  const Box box = bounds(scene);
  EXPECT_FLOAT_EQ(box.lo.x, -1.0f);
  EXPECT_FLOAT_EQ(box.hi.x, 11.0f);
}

TEST(Camera, CentreAndCorners) {
  Camera camera;
  camera.eye = vec3(0, 0, 5);
  camera.target = vec3(0.0f);
  camera.fov_degrees = 90.0f;
  const CameraFrame view = frame(camera, 200, 100);
  expect_near(primary_ray(view, vec2(100, 50)).direction, vec3(0, 0, -1));
  expect_near(primary_ray(view, vec2(0, 0)).direction, glm::normalize(vec3(-2, 1, -1)));
  expect_near(primary_ray(view, vec2(200, 100)).direction, glm::normalize(vec3(2, -1, -1)));
}

TEST(Camera, ManyRaysAreThoseOfEachPixel) {
  Camera camera;
  camera.eye = {3, 2, -1};
  for (const bool orthographic : {false, true}) {
    camera.orthographic = orthographic;
    const CameraFrame view = frame(camera, 200, 100);
    std::vector<vec2> pixels;
    for (int i = 0; i < 23; ++i)  // no multiple of eight
      pixels.emplace_back(0.3f + 29.0f * static_cast<float>(i), 97.1f / static_cast<float>(i + 1));
    for (const IsaRow& isa : isas()) {
      prefer_isa(isa.id);
      std::vector<Ray> rays(pixels.size());
      primary_rays(view, pixels, rays);
      for (size_t i = 0; i < rays.size(); ++i) {
        const Ray one = primary_ray(view, pixels[i]);
        EXPECT_EQ(rays[i].origin, one.origin) << isa.id << " " << i;
        EXPECT_EQ(rays[i].direction, one.direction) << isa.id << " " << i;
        EXPECT_EQ(rays[i].t_min, one.t_min) << isa.id << " " << i;
        EXPECT_EQ(rays[i].t_max, one.t_max) << isa.id << " " << i;
      }
    }
    prefer_isa("");
  }
}

TEST(Camera, ProjectIsTheInverseOfThePrimaryRay) {
  Camera camera;
  camera.eye = vec3(3, 4, 5);
  camera.target = vec3(-1, 0.5f, 0);
  for (const bool orthographic : {false, true}) {
    camera.orthographic = orthographic;
    const CameraFrame view = frame(camera, 640, 480);
    for (const vec2 pixel : {vec2(1, 2), vec2(320, 240), vec2(600.5f, 33.25f)}) {
      const Ray ray = primary_ray(view, pixel);
      const auto projected = project(view, ray.origin + 7.0f * ray.direction);
      ASSERT_TRUE(projected.has_value());
      EXPECT_NEAR(projected->pixel.x, pixel.x, 1e-2f);
      EXPECT_NEAR(projected->pixel.y, pixel.y, 1e-2f);
    }
  }
}

TEST(Camera, NothingBehindThePinhole) {
  const CameraFrame view = frame(Camera{}, 100, 100);
  EXPECT_FALSE(project(view, vec3(0, 0, 6)).has_value());
}

TEST(Camera, LookingAlongUpStillHasAFrame) {
  Camera camera;
  camera.eye = vec3(0, 5, 0);
  camera.target = vec3(0.0f);
  const CameraFrame view = frame(camera, 100, 100);
  EXPECT_NEAR(glm::length(view.right), 1.0f, 1e-5f);
  EXPECT_NEAR(glm::dot(view.right, view.forward), 0.0f, 1e-5f);
}

TEST(Camera, FramedShowsTheWholeBoxAtAnyScale) {
  for (const float scale : {1e-12f, 1.0f, 1e15f}) {
    const Box box{scale * vec3(-1, -2, -3), scale * vec3(5, 2, 3)};
    const Camera camera = default_camera(box);
    const CameraFrame view = frame(camera, 1280, 720);
    for (int corner = 0; corner < 8; ++corner) {
      const vec3 point(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                       corner & 4 ? box.hi.z : box.lo.z);
      const auto projected = project(view, point);
      ASSERT_TRUE(projected.has_value());
      EXPECT_GE(projected->pixel.x, 0.0f);
      EXPECT_LE(projected->pixel.x, 1280.0f);
      EXPECT_GE(projected->pixel.y, 0.0f);
      EXPECT_LE(projected->pixel.y, 720.0f);
    }
  }
}

}  // namespace
}  // namespace tracer::test
