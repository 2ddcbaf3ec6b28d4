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
  constexpr float margin = 1.05f;
  const CameraFrame view = frame(camera, 1, 1);
  const vec3 middle = center(box);
  const float half_height = std::tan(glm::radians(camera.fov_degrees) * 0.5f);
  const vec2 half_size(half_height * aspect, half_height);
  // The least distance at which every corner is between the borders of the picture.
  float distance = 0.0f;
  for (int corner = 0; corner < 8; ++corner) {
    const vec3 point(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                     corner & 4 ? box.hi.z : box.lo.z);
    const vec3 offset = point - middle;
    const float nearer = camera.orthographic ? 0.0f : -glm::dot(offset, view.forward);
    const float right = std::abs(glm::dot(offset, view.right));
    const float up = std::abs(glm::dot(offset, view.up));
    distance =
        std::max(distance, margin * std::max(right / half_size.x, up / half_size.y) + nearer);
  }
  camera.target = middle;
  camera.eye = middle - view.forward * (distance > 0.0f ? distance : 1.0f);
  return camera;
}

}  // namespace tracer
