// From pixels to rays and back.
#include "tracer/scene/camera.h"

#include <array>
#include <bit>
#include <cassert>
#include <cmath>

#include "tracer/math/axes.h"
#include "tracer/math/normalize.h"

namespace tracer {

namespace {

// Any unit vector at a right angle to a unit vector.
vec3 perpendicular(const vec3& v) {
  const vec3 other = std::abs(v.x) < 0.5f ? vec3(1, 0, 0) : vec3(0, 0, 1);
  return glm::normalize(glm::cross(v, other));
}

Axes sum(const Axes& a, const Axes& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

Axes unit(const Axes& v) {
  const float4 scale = broadcast(1.0f) / sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  return {v.x * scale, v.y * scale, v.z * scale};
}

// As primary_ray, step by step: the same rays to the bit.
void four_rays(const CameraFrame& frame, const vec2* pixels, Ray* rays) {
  const float4 first = load4(&pixels[0].x), second = load4(&pixels[2].x);
  const float4 column = __builtin_shufflevector(first, second, 0, 2, 4, 6);
  const float4 row = __builtin_shufflevector(first, second, 1, 3, 5, 7);
  const float4 one = broadcast(1.0f), two = broadcast(2.0f);
  const float4 across =
      (column / broadcast(frame.resolution.x) * two - one) * broadcast(frame.half_size.x);
  const float4 up =
      (row / broadcast(frame.resolution.y) * two - one) * broadcast(-frame.half_size.y);
  const Axes right_of = four_times(frame.right), up_of = four_times(frame.up);
  const Axes offset{right_of.x * across + up_of.x * up, right_of.y * across + up_of.y * up,
                    right_of.z * across + up_of.z * up};
  Axes origin = four_times(frame.eye), direction = four_times(frame.forward);
  if (frame.orthographic) {
    origin = sum(origin, offset);
  } else {
    direction = unit(sum(direction, offset));
  }
  const Ray usual;
  const std::array<float4, 4> origins = rows(origin, usual.t_min);
  const std::array<float4, 4> directions = rows(direction, usual.t_max);
  for (size_t i = 0; i < 4; ++i)
    rays[i] = std::bit_cast<Ray>(std::array{origins[i], directions[i]});
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

void primary_rays(const CameraFrame& frame, std::span<const vec2> pixels, std::span<Ray> rays) {
  assert(pixels.size() == rays.size());
  size_t i = 0;
  for (; i + 4 <= pixels.size(); i += 4)
    four_rays(frame, &pixels[i], &rays[i]);
  for (; i < pixels.size(); ++i)
    rays[i] = primary_ray(frame, pixels[i]);
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
