// Dear ImGui's context, drawn with OpenGL; the window and the screenshot share it.
#pragma once

namespace app {

// One at a time, while its OpenGL context is current. Writes no file of ImGui's own.
class Gui {
 public:
  explicit Gui(float scale);
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;
  ~Gui();

  void set_scale(float scale);  // between frames
  void begin_frame();           // after the display size and the input have been set
  void end_frame(int framebuffer_width, int framebuffer_height);  // draws

 private:
  float scale_ = 0.0f;
};

}  // namespace app
