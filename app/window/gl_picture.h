// The picture as a texture that panels show.
#pragma once

#include <imgui.h>

#include "app/window/gl.h"
#include "tracer/render/colorize.h"

namespace app {

// Every n-th pixel of every n-th row, with the smallest n that leaves no side above `max_side`.
tracer::Image shrunk(const tracer::Image& image, int max_side);

// Lives while its context is current.
class GlPicture {
 public:
  GlPicture() = default;
  GlPicture(const GlPicture&) = delete;
  GlPicture& operator=(const GlPicture&) = delete;
  ~GlPicture();

  // Copies the pixels; a picture above the driver's largest texture is shrunk for display.
  void upload(const tracer::Image& image);
  ImTextureID texture() const;

 private:
  GLuint name_ = 0;
  int width_ = 0;
  int height_ = 0;
};

}  // namespace app
