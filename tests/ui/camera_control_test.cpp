// Orbit, pan, zoom and fly as pure functions.
#include "ui/camera_control.h"

#include <cmath>

#include <gtest/gtest.h>

namespace {

using tracer::Camera;
using tracer::vec2;
using tracer::vec3;

Camera at_five() {
  return Camera{};  // at (0,0,5), looks to the origin, y is up
}

float distance(const Camera& camera) {
  return glm::length(camera.eye - camera.target);
}

void expect_near(const vec3& a, const vec3& b, float error = 1e-4f) {
  EXPECT_NEAR(a.x, b.x, error);
  EXPECT_NEAR(a.y, b.y, error);
  EXPECT_NEAR(a.z, b.z, error);
}

TEST(CameraControl, OrbitKeepsTheTargetAndTheDistance) {
  const Camera camera = ui::orbit(at_five(), 0.7f, 0.3f);
  EXPECT_EQ(camera.target, vec3(0.0f));
  EXPECT_NEAR(distance(camera), 5.0f, 1e-4f);
}

TEST(CameraControl, DraggingRightTurnsTheViewRightAndMovesTheEyeLeft) {
  const Camera camera = ui::orbit(at_five(), 0.5f * tracer::pi, 0.0f);
  expect_near(camera.eye, {-5.0f, 0.0f, 0.0f});
}

TEST(CameraControl, DraggingDownRaisesTheEye) {
  EXPECT_GT(ui::orbit(at_five(), 0.0f, -0.5f).eye.y, 1.0f);
}

TEST(CameraControl, OrbitStopsAtThePoles) {
  Camera camera = at_five();
  for (int i = 0; i < 100; ++i)
    camera = ui::orbit(camera, 0.01f, -0.3f);
  EXPECT_GT(camera.eye.y, 4.9f);
  EXPECT_GT(std::hypot(camera.eye.x, camera.eye.z), 0.01f);
}

TEST(CameraControl, OrbitUsesTheUpAxis) {
  Camera camera = at_five();
  camera.eye = {5.0f, 0.0f, 0.0f};
  camera.up = {0.0f, 0.0f, 1.0f};
  const Camera turned = ui::orbit(camera, 0.4f, 0.0f);
  EXPECT_NEAR(turned.eye.z, 0.0f, 1e-5f);
  EXPECT_GT(std::abs(turned.eye.y), 1.0f);
}

TEST(CameraControl, LookingAroundKeepsTheEye) {
  const Camera camera = ui::look_around(at_five(), 0.5f * tracer::pi, 0.0f);
  EXPECT_EQ(camera.eye, at_five().eye);
  expect_near(camera.target, {5.0f, 0.0f, 5.0f});
}

TEST(CameraControl, PanLetsTheTargetsPointFollowTheMouse) {
  const int height = 400;
  const Camera camera = ui::pan(at_five(), {30.0f, -20.0f}, height);
  const auto seen = tracer::project(tracer::frame(camera, height, height), vec3(0.0f));
  ASSERT_TRUE(seen.has_value());
  EXPECT_NEAR(seen->pixel.x, 230.0f, 0.1f);
  EXPECT_NEAR(seen->pixel.y, 180.0f, 0.1f);
}

TEST(CameraControl, ZoomKeepsThePointWhereItIs) {
  const vec3 point(0.8f, 0.4f, 1.0f);
  const Camera near = ui::zoom_at(at_five(), point, 0.5f, 0.0f);
  const auto before = tracer::project(tracer::frame(at_five(), 300, 200), point);
  const auto after = tracer::project(tracer::frame(near, 300, 200), point);
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(before->pixel.x, after->pixel.x, 0.01f);
  EXPECT_NEAR(before->pixel.y, after->pixel.y, 0.01f);
  EXPECT_NEAR(after->depth, 0.5f * before->depth, 1e-4f);
}

TEST(CameraControl, ZoomKeepsThePointInAnOrthographicPictureToo) {
  Camera flat = at_five();
  flat.orthographic = true;
  const vec3 point(0.8f, 0.4f, 1.0f);
  const Camera near = ui::zoom_at(flat, point, 0.5f, 0.0f);
  const auto before = tracer::project(tracer::frame(flat, 300, 200), point);
  const auto after = tracer::project(tracer::frame(near, 300, 200), point);
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(before->pixel.x, after->pixel.x, 0.01f);
}

TEST(CameraControl, ZoomStopsBeforeTheTarget) {
  Camera camera = at_five();
  for (int i = 0; i < 1000; ++i)
    camera = ui::zoom_at(camera, camera.target, 0.5f, 0.01f);
  EXPECT_GE(distance(camera), 0.01f);
  EXPECT_LT(distance(camera), 0.03f);
}

TEST(CameraControl, ZoomingOutForeverStaysFinite) {
  Camera camera = at_five();
  for (int i = 0; i < 1000; ++i)
    camera = ui::zoom_at(camera, camera.target, 2.0f, 0.01f);
  EXPECT_TRUE(std::isfinite(camera.eye.z));
}

TEST(CameraControl, FlyMovesEyeAndTargetAlongTheViewAndTheWorldsUp) {
  const Camera camera = ui::fly(at_five(), {1.0f, 2.0f, 3.0f});
  expect_near(camera.eye, {1.0f, 2.0f, 2.0f});
  expect_near(camera.target, {1.0f, 2.0f, -3.0f});
}

TEST(CameraControl, SeenAlongAnAxis) {
  expect_near(ui::seen_along(at_five(), {-1.0f, 0.0f, 0.0f}).eye, {5.0f, 0.0f, 0.0f});
}

TEST(CameraControl, FromAboveThePictureStillHasAnUp) {
  const Camera camera = ui::seen_along(at_five(), {0.0f, -1.0f, 0.0f});
  EXPECT_GT(camera.eye.y, 4.99f);
  const tracer::CameraFrame frame = tracer::frame(camera, 10, 10);
  EXPECT_NEAR(glm::dot(frame.right, frame.up), 0.0f, 1e-4f);
  EXPECT_NEAR(frame.right.x, 1.0f, 1e-3f);  // x to the right, as from the front
}

TEST(CameraControl, FocusOnAPointIsNotDegenerate) {
  const tracer::Box point = {vec3(3.0f), vec3(3.0f)};
  const Camera camera = ui::focused_on(at_five(), point, 1.5f);
  EXPECT_EQ(camera.target, vec3(3.0f));
  EXPECT_GT(distance(camera), 0.1f);
}

TEST(CameraControl, FocusOnNothingChangesNothing) {
  EXPECT_EQ(ui::focused_on(at_five(), tracer::Box{}, 1.0f), at_five());
}

}  // namespace
