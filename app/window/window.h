// The window: the only place that knows GLFW.
#pragma once

#include <bitset>
#include <string>
#include <vector>

#include "tracer/math/types.h"
#include "ui/workspace.h"

struct GLFWwindow;

namespace app {

// One at a time, on the main thread. Its OpenGL context is current while it lives.
class Window {
 public:
  // Width and height in points. Throws tracer::Error if there is no display or no OpenGL 3.3.
  Window(const char* title, int width, int height);
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window();

  void attach_gui();  // once ImGui's context exists; ImGui then gets its input from the window
  void detach_gui();  // before ImGui's context goes

  bool closing() const;
  void set_title(const std::string& title);
  tracer::ivec2 size() const;         // points
  tracer::ivec2 framebuffer() const;  // pixels; 0 x 0 while minimised
  float content_scale() const;        // what the screen asks for, 1 on an ordinary one

  // Handles events; waits for one up to `seconds` (0: not at all).
  void handle_events(double seconds);
  static void wake();  // ends the waiting, from any thread

  // What happened since the last call.
  bool take_happened();  // any input, or a change of the window
  std::vector<ui::KeyPress> take_keys();
  std::vector<std::string> take_dropped();  // file names
  std::bitset<ui::key_count> held() const { return held_; }

  void begin_frame();  // before Gui::begin_frame
  void show();         // what was drawn

 private:
  void install_callbacks();
  void on_key(int key, int scancode, int action, int modifiers);

  GLFWwindow* window_ = nullptr;
  bool happened_ = true;
  std::vector<ui::KeyPress> keys_;
  std::vector<std::string> dropped_;
  std::bitset<ui::key_count> held_;
};

}  // namespace app
