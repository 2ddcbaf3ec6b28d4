#include "app/window/gl_picture.h"

#include <algorithm>

namespace app {

tracer::Image shrunk(const tracer::Image& image, int max_side) {
  const int step = (std::max(image.width, image.height) + max_side - 1) / max_side;
  tracer::Image result{(image.width + step - 1) / step, (image.height + step - 1) / step, {}};
  result.pixels.reserve(size_t(result.width) * result.height);
  for (int y = 0; y < image.height; y += step) {
    for (int x = 0; x < image.width; x += step) {
      result.pixels.push_back(image.pixels[size_t(y) * image.width + x]);
    }
  }
  return result;
}

GlPicture::~GlPicture() {
  glDeleteTextures(1, &name_);
}

void GlPicture::upload(const tracer::Image& image) {
  GLint max_side = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &max_side);
  if (std::max(image.width, image.height) > max_side) {
    upload(shrunk(image, max_side));
    return;
  }
  if (name_ == 0) glGenTextures(1, &name_);
  glBindTexture(GL_TEXTURE_2D, name_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  if (image.width != width_ || image.height != height_) {
    width_ = image.width;
    height_ = image.height;
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_, height_, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 image.pixels.data());
    // Enlarged pixels stay visible as pixels: they are what is looked at.
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  } else {
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE,
                    image.pixels.data());
  }
  glBindTexture(GL_TEXTURE_2D, 0);
}

ImTextureID GlPicture::texture() const {
  return (ImTextureID)(intptr_t)name_;  // a pointer before ImGui 1.91.4, an integer since
}

}  // namespace app
