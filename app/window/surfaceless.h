// An OpenGL context without a display, through EGL, with a framebuffer to draw into.
#pragma once

#include "app/window/gl.h"

namespace app {

// Current on the calling thread while it lives. Throws tracer::Error if the machine has no EGL
// driver for it, no OpenGL 3.3, or no framebuffer of that size.
class Surfaceless {
 public:
  Surfaceless(int width, int height);
  Surfaceless(const Surfaceless&) = delete;
  Surfaceless& operator=(const Surfaceless&) = delete;
  ~Surfaceless();

 private:
  void make_context();
  void make_framebuffer(int width, int height);
  void release();

  void* display_ = nullptr;
  void* context_ = nullptr;
  GLuint framebuffer_ = 0;
  GLuint color_ = 0;
};

}  // namespace app
