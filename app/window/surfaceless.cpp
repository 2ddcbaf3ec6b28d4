#include "app/window/surfaceless.h"

#include <string>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include "tracer/error.h"

namespace app {
namespace {

constexpr const char* advice =
    "; the commands render and report need no OpenGL, and Debian's packages libegl1, "
    "libegl-mesa0 and libgl1-mesa-dri bring a software driver";

bool initialised(EGLDisplay display) {
  return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE;
}

// Mesa draws without any device; other drivers offer their graphics cards.
EGLDisplay open_display() {
  const auto platform_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      eglGetProcAddress("eglGetPlatformDisplayEXT"));
  const auto query_devices =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  if (platform_display == nullptr) return EGL_NO_DISPLAY;
  EGLDisplay display =
      platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (initialised(display)) return display;
  EGLDeviceEXT device = nullptr;
  EGLint count = 0;
  if (query_devices == nullptr || query_devices(1, &device, &count) == EGL_FALSE || count == 0) {
    return EGL_NO_DISPLAY;
  }
  display = platform_display(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
  return initialised(display) ? display : EGL_NO_DISPLAY;
}

}  // namespace

Surfaceless::Surfaceless(int width, int height) {
  try {
    make_context();
    load_gl(reinterpret_cast<GLADloadfunc>(eglGetProcAddress));
    make_framebuffer(width, height);
  } catch (const tracer::Error& error) {
    release();
    throw tracer::Error(std::string("no OpenGL without a display: ") + error.what() + advice);
  }
}

Surfaceless::~Surfaceless() {
  release();
}

void Surfaceless::make_context() {
  display_ = open_display();
  if (display_ == EGL_NO_DISPLAY) throw tracer::Error("no EGL driver");
  const EGLint config_attributes[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                      EGL_NONE};
  const EGLint context_attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                       3,
                                       EGL_CONTEXT_MINOR_VERSION,
                                       3,
                                       EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                       EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                       EGL_NONE};
  EGLConfig config = nullptr;
  EGLint configs = 0;
  if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE ||
      eglChooseConfig(display_, config_attributes, &config, 1, &configs) == EGL_FALSE ||
      configs == 0) {
    throw tracer::Error("the EGL driver has no OpenGL");
  }
  context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, context_attributes);
  if (context_ == EGL_NO_CONTEXT ||
      eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE) {
    throw tracer::Error(
        fmt::format("the EGL driver makes no OpenGL 3.3 context (error {:#x})", eglGetError()));
  }
}

void Surfaceless::make_framebuffer(int width, int height) {
  GLint max_side = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &max_side);
  if (width > max_side || height > max_side) {
    throw tracer::Error(fmt::format("{}x{} pixels are more than the driver's {}x{}", width, height,
                                    max_side, max_side));
  }
  glGenFramebuffers(1, &framebuffer_);
  glGenRenderbuffers(1, &color_);
  glBindRenderbuffer(GL_RENDERBUFFER, color_);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color_);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw tracer::Error("the driver makes no framebuffer");
  }
}

void Surfaceless::release() {
  if (framebuffer_ != 0) glDeleteFramebuffers(1, &framebuffer_);
  if (color_ != 0) glDeleteRenderbuffers(1, &color_);
  if (display_ == EGL_NO_DISPLAY) return;
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
  eglTerminate(display_);
}

}  // namespace app
