#include "app/window/window.h"

#include <algorithm>
#include <utility>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>

#include "app/window/gl.h"
#include "app/window/keys.h"
#include "tracer/error.h"

namespace app {
namespace {

// The reason of the last failure in GLFW's words.
tracer::Error glfw_error(const char* what) {
  const char* reason = nullptr;
  glfwGetError(&reason);
  return tracer::Error(std::string(what) + (reason ? std::string(": ") + reason : ""));
}

Window& owner(GLFWwindow* window) {
  return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

}  // namespace

Window::Window(const char* title, int width, int height) {
  if (glfwInit() == GLFW_FALSE) throw glfw_error("no display");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
#ifndef NDEBUG
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
#endif
  window_ = glfwCreateWindow(width, height, title, nullptr, nullptr);
  if (window_ == nullptr) {
    const tracer::Error error = glfw_error("no window with OpenGL 3.3");
    glfwTerminate();
    throw error;
  }
  glfwMakeContextCurrent(window_);
  try {
    load_gl(glfwGetProcAddress);
  } catch (...) {
    glfwDestroyWindow(window_);
    glfwTerminate();
    throw;
  }
  glfwSwapInterval(1);
  glfwSetWindowSizeLimits(window_, 480, 320, GLFW_DONT_CARE, GLFW_DONT_CARE);
  glfwSetWindowUserPointer(window_, this);
  install_callbacks();
}

Window::~Window() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

// ImGui's backend calls the callbacks that it finds, so these come before attach_gui. ImGui 1.86
// looks at keys once a frame and misses quick taps: on_key queues them.
void Window::install_callbacks() {
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int scancode, int action, int modifiers) {
    owner(w).on_key(key, scancode, action, modifiers);
  });
  glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** names) {
    owner(w).happened_ = true;
    owner(w).dropped_.insert(owner(w).dropped_.end(), names, names + count);
  });
  glfwSetCursorPosCallback(window_,
                           [](GLFWwindow* w, double, double) { owner(w).happened_ = true; });
  glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int) { owner(w).happened_ = true; });
  glfwSetMouseButtonCallback(window_,
                             [](GLFWwindow* w, int, int, int) { owner(w).happened_ = true; });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double) { owner(w).happened_ = true; });
  glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned) { owner(w).happened_ = true; });
  glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int focused) {
    owner(w).happened_ = true;
    if (focused == GLFW_FALSE) owner(w).held_.reset();
  });
  glfwSetFramebufferSizeCallback(window_,
                                 [](GLFWwindow* w, int, int) { owner(w).happened_ = true; });
  glfwSetWindowContentScaleCallback(window_,
                                    [](GLFWwindow* w, float, float) { owner(w).happened_ = true; });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { owner(w).happened_ = true; });
  glfwSetWindowIconifyCallback(window_, [](GLFWwindow* w, int) { owner(w).happened_ = true; });
}

void Window::on_key(int key, int scancode, int action, int modifiers) {
  happened_ = true;
  const int code = key_code(key, glfwGetKeyName(key, scancode));
  held_.set(size_t(code), action != GLFW_RELEASE && code != ui::key_other);
  if (action != GLFW_PRESS) return;
  keys_.push_back({code, (modifiers & GLFW_MOD_CONTROL) != 0, (modifiers & GLFW_MOD_SHIFT) != 0,
                   (modifiers & GLFW_MOD_ALT) != 0});
}

void Window::attach_gui() {
  ImGui_ImplGlfw_InitForOpenGL(window_, true);
}

void Window::detach_gui() {
  ImGui_ImplGlfw_Shutdown();
}

bool Window::closing() const {
  return glfwWindowShouldClose(window_) == GLFW_TRUE;
}

void Window::set_title(const std::string& title) {
  glfwSetWindowTitle(window_, title.c_str());
}

tracer::ivec2 Window::size() const {
  tracer::ivec2 result(0);
  glfwGetWindowSize(window_, &result.x, &result.y);
  return result;
}

tracer::ivec2 Window::framebuffer() const {
  tracer::ivec2 result(0);
  if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_FALSE) {
    glfwGetFramebufferSize(window_, &result.x, &result.y);
  }
  return result;
}

float Window::content_scale() const {
  float x = 1.0f, y = 1.0f;
  glfwGetWindowContentScale(window_, &x, &y);
  // Where a point is several pixels, as on Wayland, ImGui scales its coordinates already.
  const int points = size().x, pixels = framebuffer().x;
  const float pixels_per_point = points > 0 && pixels > 0 ? float(pixels) / float(points) : 1.0f;
  return std::clamp(std::max(x, y) / pixels_per_point, 0.5f, 4.0f);
}

void Window::handle_events(double seconds) {
  if (seconds > 0.0) {
    glfwWaitEventsTimeout(seconds);
  } else {
    glfwPollEvents();
  }
}

void Window::wake() {
  glfwPostEmptyEvent();
}

bool Window::take_happened() {
  return std::exchange(happened_, false);
}

std::vector<ui::KeyPress> Window::take_keys() {
  return std::exchange(keys_, {});
}

std::vector<std::string> Window::take_dropped() {
  return std::exchange(dropped_, {});
}

void Window::begin_frame() {
  ImGui_ImplGlfw_NewFrame();
}

void Window::show() {
  glfwSwapBuffers(window_);
}

}  // namespace app
