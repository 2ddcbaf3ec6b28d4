// From pixels to rays and back.
#include "tracer/scene/camera.h"

#include <cmath>

#include "tracer/math/normalize.h"

namespace tracer {

namespace {

// Any unit vector at a right angle to a unit vector.
vec3 perpendicular(const vec3& v) {
  const vec3 other = std::abs(v.x) < 0.5f ? vec3(1, 0, 0) : vec3(0, 0, 1);
  return glm::normalize(glm::cross(v, other));
}

}  // namespace

CameraFrame frame(const Camera& camera, int width, int height) {
  CameraFrame result;
  result.eye = camera.eye;
  result.forward = safe_normalize(camera.target - camera.eye, vec3(0, 0, -1));
  const vec3 up = safe_normalize(camera.up, vec3(0, 1, 0));
  const vec3 side = glm::cross(result.forward, up);
  result.right =
      glm::dot(side, side) > 1e-8f ? glm::normalize(side) : perpendicular(result.forward);
  result.up = glm::cross(result.right, result.forward);
  result.resolution = vec2(width, height);
  result.orthographic = camera.orthographic;
  float half_height = std::tan(glm::radians(camera.fov_degrees) * 0.5f);
  if (camera.orthographic) half_height *= safe_length(camera.target - camera.eye);
  result.half_size = {half_height * static_cast<float>(width) / static_cast<float>(height),
                      half_height};
  return result;
}

Ray primary_ray(const CameraFrame& frame, vec2 pixel) {
  const vec2 on_plane =
      (pixel / frame.resolution * 2.0f - 1.0f) * vec2(frame.half_size.x, -frame.half_size.y);
  const vec3 offset = frame.right * on_plane.x + frame.up * on_plane.y;
  Ray ray;
  if (frame.orthographic) {
    ray.origin = frame.eye + offset;
    ray.direction = frame.forward;
  } else {
    ray.origin = frame.eye;
    ray.direction = glm::normalize(frame.forward + offset);
  }
  return ray;
}

std::optional<Projected> project(const CameraFrame& frame, vec3 point) {
  const vec3 offset = point - frame.eye;
  const float depth = glm::dot(offset, frame.forward);
  vec2 on_plane(glm::dot(offset, frame.right), glm::dot(offset, frame.up));
  if (!frame.orthographic) {
    if (!(depth > 0.0f)) return {};
    on_plane /= depth;
  }
  on_plane /= vec2(frame.half_size.x, -frame.half_size.y);
  return Projected{(on_plane * 0.5f + 0.5f) * frame.resolution, depth};
}

Camera framed_on(Camera camera, const Box& box, float aspect) {
  const vec3 middle = center(box);
  const float radius = 0.5f * safe_length(extent(box));
  const vec3 backward = safe_normalize(camera.eye - camera.target, vec3(0, 0, 1));
  const float half_height = glm::radians(camera.fov_degrees) * 0.5f;
  const float half_width = std::atan(std::tan(half_height) * aspect);
  const float distance = radius / std::sin(std::min(half_height, half_width));
  camera.target = middle;
  camera.eye = middle + backward * (distance > 0.0f ? distance : 1.0f);
  return camera;
}

}  // namespace tracer
