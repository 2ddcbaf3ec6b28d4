// The camera: a pinhole or an orthographic view.
#pragma once

#include <optional>
#include <span>

#include "tracer/math/box.h"
#include "tracer/math/ray.h"

namespace tracer {

struct Camera {
  vec3 eye{0.0f, 0.0f, 5.0f};
  vec3 target{0.0f};
  vec3 up{0.0f, 1.0f, 0.0f};
  float fov_degrees = 45.0f;  // vertical, 1..170
  bool orthographic = false;  // then the visible height is what the fov shows at the target

  bool operator==(const Camera&) const = default;
};

// The camera with everything derived that a ray needs.
struct CameraFrame {
  vec3 eye, right, up, forward;  // orthonormal
  vec2 half_size;                // of the image plane at distance 1 (orthographic: at any distance)
  vec2 resolution;               // pixels
  bool orthographic = false;
};

CameraFrame frame(const Camera& camera, int width, int height);

// The ray through a point of the image in pixels, (0,0) the upper left corner, (0.5,0.5) the centre
// of the first pixel. The direction has unit length.
Ray primary_ray(const CameraFrame& frame, vec2 pixel);

// The same for each point, into a span of the same length.
void primary_rays(const CameraFrame& frame, std::span<const vec2> pixels, std::span<Ray> rays);

// Where a point of the world is in the image (pixels) and its distance along the view direction;
// nothing if it is behind a perspective camera.
struct Projected {
  vec2 pixel;
  float depth;
};
std::optional<Projected> project(const CameraFrame& frame, vec3 point);

// The same view direction, from where the whole box is in the picture.
Camera framed_on(Camera camera, const Box& box, float aspect);

}  // namespace tracer
