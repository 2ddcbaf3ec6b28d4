#include "app/window/gl.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "tracer/error.h"

namespace app {
namespace {

#ifndef NDEBUG
void GLAD_API_PTR print_message(GLenum, GLenum type, GLuint, GLenum severity, GLsizei,
                                const GLchar* text, const void*) {
  if (severity == GL_DEBUG_SEVERITY_NOTIFICATION) return;
  std::fprintf(stderr, "OpenGL %s: %s\n", type == GL_DEBUG_TYPE_ERROR ? "error" : "message", text);
}

void report_errors() {
  if (GLAD_GL_KHR_debug == 0) return;
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(print_message, nullptr);
}
#endif

}  // namespace

void load_gl(GLADloadfunc get_address) {
  const int version = gladLoadGL(get_address);
  const int major = GLAD_VERSION_MAJOR(version);
  const int minor = GLAD_VERSION_MINOR(version);
  if (major * 10 + minor < 33) {
    throw tracer::Error(
        fmt::format("OpenGL 3.3 is needed, and the driver has {}.{}", major, minor));
  }
#ifndef NDEBUG
  report_errors();
#endif
}

tracer::Image read_framebuffer(int width, int height) {
  tracer::Image image{width, height, {}};
  image.pixels.resize(size_t(width) * height);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data());
  // OpenGL's row 0 is the lowest one. What shines through is not part of a picture.
  for (int y = 0; y < height / 2; ++y) {
    std::swap_ranges(image.pixels.begin() + ptrdiff_t(y) * width,
                     image.pixels.begin() + ptrdiff_t(y + 1) * width,
                     image.pixels.begin() + ptrdiff_t(height - 1 - y) * width);
  }
  for (uint32_t& pixel : image.pixels)
    pixel |= 0xff000000u;
  return image;
}

}  // namespace app
