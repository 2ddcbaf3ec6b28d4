// Orbit, pan, zoom, fly.
#include "ui/camera_control.h"

#include <algorithm>
#include <cmath>

namespace ui {
namespace {

using tracer::Camera;
using tracer::vec2;
using tracer::vec3;

constexpr float pole_margin = 0.01f;  // radians

vec3 unit_up(const Camera& camera) {
  const float length = glm::length(camera.up);
  return length > 0.0f ? camera.up / length : vec3(0.0f, 1.0f, 0.0f);
}

// Rotated about a unit axis (Rodrigues).
vec3 rotated(const vec3& v, const vec3& axis, float angle) {
  return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
         axis * glm::dot(axis, v) * (1.0f - std::cos(angle));
}

// A view vector turned about the up axis and then raised, never past a pole.
vec3 turned(const Camera& camera, const vec3& view, float right, float raise) {
  const vec3 up = unit_up(camera);
  const float length = glm::length(view);
  if (length == 0.0f) return view;
  vec3 direction = rotated(view / length, up, -right);
  vec3 side = glm::cross(direction, up);
  if (glm::length(side) < 1e-4f) {
    side = glm::cross(direction, std::abs(up.x) < 0.9f ? vec3(1, 0, 0) : vec3(0, 0, 1));
  }
  side = glm::normalize(side);
  const float height = std::asin(std::clamp(glm::dot(direction, up), -1.0f, 1.0f));
  const float limit = 0.5f * tracer::pi - pole_margin;
  const float wanted = std::clamp(height + raise, -limit, limit);
  return length * rotated(direction, side, wanted - height);
}

}  // namespace

Camera orbit(Camera camera, float right, float up) {
  camera.eye = camera.target - turned(camera, camera.target - camera.eye, right, up);
  return camera;
}

Camera look_around(Camera camera, float right, float up) {
  camera.target = camera.eye + turned(camera, camera.target - camera.eye, right, up);
  return camera;
}

Camera pan(Camera camera, vec2 pixels, int height) {
  const tracer::CameraFrame frame = tracer::frame(camera, height, height);
  const float distance = glm::length(camera.target - camera.eye);
  const float visible = 2.0f * distance * std::tan(0.5f * glm::radians(camera.fov_degrees));
  const float scale = visible / static_cast<float>(std::max(height, 1));
  const vec3 move = scale * (-pixels.x * frame.right + pixels.y * frame.up);
  camera.eye += move;
  camera.target += move;
  return camera;
}

Camera zoom_at(const Camera& camera, vec3 point, float factor, float nearest) {
  const float distance = glm::length(camera.target - camera.eye);
  if (distance == 0.0f || (factor < 1.0f && distance * factor < nearest)) return camera;
  Camera moved = camera;
  moved.eye = point + factor * (camera.eye - point);
  moved.target = point + factor * (camera.target - point);
  const bool finite = std::isfinite(glm::dot(moved.eye, moved.eye) + glm::length(moved.target));
  return finite && glm::length(moved.target - moved.eye) > 0.0f ? moved : camera;
}

Camera fly(Camera camera, vec3 move) {
  const tracer::CameraFrame frame = tracer::frame(camera, 1, 1);
  const vec3 step = move.x * frame.right + move.y * unit_up(camera) + move.z * frame.forward;
  camera.eye += step;
  camera.target += step;
  return camera;
}

Camera seen_along(Camera camera, vec3 direction) {
  const float distance = glm::length(camera.target - camera.eye);
  const vec3 view = glm::normalize(direction);
  const vec3 up = unit_up(camera);
  // Straight up or down: kept a little off the pole, so that "up" in the picture is defined.
  const float height = std::clamp(glm::dot(view, up), -1.0f, 1.0f);
  camera.eye = camera.target - distance * view;
  if (std::abs(height) > std::cos(pole_margin)) {
    const vec3 side = std::abs(up.z) < 0.9f ? vec3(0, 0, 1) : vec3(0, 1, 0);
    const vec3 level = glm::normalize(side - glm::dot(side, up) * up);
    const float tilt = 0.5f * tracer::pi - pole_margin;
    const float sign = height > 0.0f ? 1.0f : -1.0f;
    camera.eye = camera.target - distance * (sign * std::sin(tilt) * up - std::cos(tilt) * level);
  }
  return camera;
}

Camera focused_on(const Camera& camera, const tracer::Box& box, float aspect) {
  if (tracer::is_empty(box)) return camera;
  const vec3 size = tracer::extent(box);
  if (size.x + size.y + size.z > 0.0f) return tracer::framed_on(camera, box, aspect);
  const float distance = std::max(1.0f, 0.01f * glm::length(box.lo));
  const vec3 view = glm::normalize(camera.target - camera.eye);
  Camera moved = camera;
  moved.target = box.lo;
  moved.eye = box.lo - distance * view;
  return moved;
}

}  // namespace ui
