#include "app/window/gui.h"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "app/window/gl.h"
#include "ui/workspace_state.h"

namespace app {

Gui::Gui(float scale) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::GetIO().LogFilename = nullptr;
  ImGui_ImplOpenGL3_Init("#version 330 core");
  set_scale(scale);
}

Gui::~Gui() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext();
}

void Gui::set_scale(float scale) {
  if (scale == scale_) return;
  scale_ = scale;
  ui::apply_style(scale);
#if IMGUI_VERSION_NUM < 19200
  ImGui_ImplOpenGL3_DestroyDeviceObjects();  // the next frame makes the font texture anew
#endif
}

void Gui::begin_frame() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
}

void Gui::end_frame(int framebuffer_width, int framebuffer_height) {
  ImGui::Render();
  glViewport(0, 0, framebuffer_width, framebuffer_height);
  // The workspace draws no background of its own: without a GPU each layer of the screen costs
  // several milliseconds.
  const ImVec4 background = ImGui::GetStyle().Colors[ImGuiCol_WindowBg];
  glClearColor(background.x, background.y, background.z, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace app
