// Lines and convex faces with a nearness, drawn into rows of an image and held against the nearness
// of what the film has hit.
#pragma once

#include <array>
#include <span>

#include "tracer/math/types.h"
#include "tracer/render/image.h"

namespace tracer {

// x and y in pixels; z the nearness, which is a linear function of x and y along lines and on
// faces: 1 / distance along the view direction, of an orthographic camera minus that distance.
struct ScreenLine {
  vec3 from, to;
};

struct ScreenFace {
  std::array<vec2, 5> corners;  // convex; a quad cut by the near plane
  int count = 0;
  vec3 plane{0.0f};  // nearness = x * plane.x + y * plane.y + plane.z
  float cover = 0.0f;
};

// Rows [y0, y1) of an image, and the least nearness at which each of their pixels is not hidden.
struct Band {
  Image& image;
  int y0 = 0, y1 = 0;
  std::span<const float> limits;  // empty: nothing is hidden
};

struct Ink {
  uint32_t color = 0;
  float cover = 1.0f;
  float hidden_cover = 1.0f;  // behind a surface
};

// Antialiased, `width` pixels wide.
void draw_line(const Band& band, const ScreenLine& line, float width, const Ink& ink);
void draw_face(const Band& band, const ScreenFace& face, const Ink& ink);

// Cuts a line at the borders of the image, `margin` pixels outside; false if nothing is left.
bool clip(ScreenLine& line, float width, float height, float margin);

}  // namespace tracer
