// The frame loop of the tests.
#include "driver.h"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tracer/render/colorize.h"

namespace ui {
namespace {

#if IMGUI_VERSION_NUM >= 19200
// Says that the textures ImGui asks for are there.
void take_textures() {
  for (ImTextureData* texture : ImGui::GetPlatformIO().Textures) {
    if (texture->Status == ImTextureStatus_WantDestroy) {
      texture->SetStatus(ImTextureStatus_Destroyed);
    } else if (texture->Status != ImTextureStatus_OK) {
      texture->SetTexID(1);
      texture->SetStatus(ImTextureStatus_OK);
    }
  }
}
#endif

}  // namespace

Driver::Driver(std::string_view scene, ImVec2 display) : display_(display) {
  context_ = ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.UserData = &items;
  apply_style(1.0f);
#if IMGUI_VERSION_NUM >= 19200
  io.BackendFlags |= ImGuiBackendFlags_RendererHasTextures;
#else
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
#endif
#if IMGUI_VERSION_NUM >= 18700
  io.ConfigInputTrickleEventQueue = false;
#else
  io.KeyMap[ImGuiKey_Enter] = 1;
  io.KeyMap[ImGuiKey_Backspace] = 2;
  io.KeyMap[ImGuiKey_A] = 3;
#endif
  snapshot = pipeline_.snapshot();
  state.picture_size = PictureSize::fixed;
  edited.settings.render.width = 160;
  edited.settings.render.height = 120;
  edited.settings.render.samples = 1;
  if (!scene.empty()) {
    edited.settings.source = tracer::parse_scene_source(scene);
    trace();
  }
  frame(3);
}

Driver::~Driver() {
  ImGui::DestroyContext(context_);
}

void Driver::trace() {
  pipeline_.run(edited.settings, {}, {});
  snapshot = pipeline_.snapshot();
  adopt(edited, state, *snapshot);
  has_picture = snapshot->film.width > 0;
  if (has_picture) picture = tracer::colorize(*snapshot, edited.view);
}

void Driver::send(ImVec2 mouse) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = display_;
  io.DeltaTime = 1.0f / 60.0f;
#if IMGUI_VERSION_NUM >= 18700
  io.AddMousePosEvent(mouse.x, mouse.y);
  for (int i = 0; i < 3; ++i)
    io.AddMouseButtonEvent(i, down_[i]);
  if (wheel_ != 0.0f) io.AddMouseWheelEvent(0.0f, wheel_);
  io.AddKeyEvent(ImGuiMod_Shift, shift);
  io.AddKeyEvent(ImGuiMod_Ctrl, control);
  io.AddKeyEvent(ImGuiKey_Enter, enter_);
#else
  io.MousePos = mouse;
  for (int i = 0; i < 3; ++i)
    io.MouseDown[i] = down_[i];
  io.MouseWheel = wheel_;
  io.KeyShift = shift;
  io.KeyCtrl = control;
  io.KeysDown[1] = enter_;
#endif
  wheel_ = 0.0f;
}

void Driver::frame(int count) {
  for (int i = 0; i < count; ++i) {
    send(mouse_);
    ImGui::NewFrame();
    adopt(edited, state, *snapshot);
    Frame now{
        *snapshot, has_picture ? &picture : nullptr, {}, 16.0f, keys_, edited, state, requests,
        work};
    draw_workspace(now);
    ImGui::Render();
#if IMGUI_VERSION_NUM >= 19200
    take_textures();
#endif
    keys_.clear();
  }
}

void Driver::show(std::string_view panel) {
  show_panel(state.layout, panel);
  frame(3);
}

bool Driver::is_there(const std::string& label) {
  const auto found = items.items.find(label);
  return found != items.items.end() && found->second.frame + 1 >= ImGui::GetFrameCount();
}

Item Driver::find(const std::string& label) {
  for (int i = 0; i < 60; ++i) {
    if (is_there(label)) {
      items.scroll_to = label;
      frame(3);
      items.scroll_to.clear();
      return items.items[label];
    }
    frame();
  }
  ADD_FAILURE() << "no item '" << label << "' on the screen";
  return {};
}

ImVec2 Driver::middle(const std::string& label) {
  const Item item = find(label);
  return {0.5f * (item.lo.x + item.hi.x), 0.5f * (item.lo.y + item.hi.y)};
}

void Driver::move_to(ImVec2 at) {
  mouse_ = at;
  frame(2);
}

void Driver::click_at(ImVec2 at, int button) {
  move_to(at);
  down_[button] = true;
  frame(2);
  down_[button] = false;
  frame(2);
}

void Driver::drag(ImVec2 from, ImVec2 to, int button) {
  move_to(from);
  down_[button] = true;
  frame(2);
  for (int i = 1; i <= 8; ++i) {
    const float part = static_cast<float>(i) / 8.0f;
    mouse_ = {from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)};
    frame();
  }
  frame();
  down_[button] = false;
  frame(2);
}

void Driver::hover(const std::string& label) {
  move_to(middle(label));
}

void Driver::click(const std::string& label, int button) {
  frame(30);  // so that two clicks are not a double click
  click_at(middle(label), button);
}

void Driver::double_click(const std::string& label) {
  frame(30);
  const ImVec2 at = middle(label);
  click_at(at);
  click_at(at);
}

void Driver::drag(const std::string& label, float x, float y, int button) {
  frame(30);
  const ImVec2 at = middle(label);
  drag(at, {at.x + x, at.y + y}, button);
}

void Driver::choose(const std::string& combo, const std::string& id) {
  click(combo);
  click(combo + "/" + id);
}

void Driver::menu(std::initializer_list<const char*> path) {
  std::string label = "menu";
  const char* last = *(path.end() - 1);
  for (const char* step : path) {
    label += std::string("/") + step;
    // A submenu opens when the mouse rests on it.
    const bool submenu = step != *path.begin() && step != last;
    if (submenu) {
      hover(label);
      frame(30);
    } else {
      click(label);
    }
  }
}

void Driver::press(int key, bool with_control, bool with_shift) {
  keys_.push_back({key, with_control, with_shift, false});
  frame(2);
}

void Driver::hold(int key, bool is_down) {
  state.held[static_cast<size_t>(key)] = is_down;
  if (is_down) keys_.push_back({key, control, shift, false});
}

void Driver::type(std::string_view text) {
  for (const char letter : text) {
    if (letter == '\n') {
      enter_ = true;
      frame();
      enter_ = false;
    } else {
      ImGui::GetIO().AddInputCharacter(static_cast<unsigned>(letter));
    }
    frame();
  }
  frame();
}

void Driver::wheel(float steps) {
  wheel_ = steps;
  frame(2);
}

std::string Driver::digest() const {
  const char* clipboard = ImGui::GetClipboardText();
  return layout_to_json(state) +
         fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}",
                     state.playing, state.play_speed, state.material_filter, state.instance_filter,
                     state.bookmarks.size(), state.bookmark_name, state.messages.size(),
                     state.message_filter, state.show_keys, state.show_about, state.browser.visible,
                     state.edited_material, state.selection.instance, state.selection.triangle,
                     state.selection.light, state.selection.material, state.banner,
                     clipboard != nullptr ? clipboard : "", requests.open.value_or(""),
                     requests.save_picture.value_or(""), requests.screenshot, requests.cancel,
                     requests.quit) +
         fmt::format("{} {}", state.builders.rows.size(), requests.check_trees) +
         fmt::format(" {} {} {} {} {} {}", state.timeline.from, state.timeline.to,
                     state.timeline.own_range, state.timeline.loop, state.timeline.frames,
                     state.timeline.width) +
         fmt::format(" {} {} {} {} {}", state.tree.mesh, state.tree.search.text,
                     state.tree.search.kind, state.tree.sort, state.tree.rows.rows.size()) +
         fmt::format(" {} {}", state.selection.node ? state.selection.node->mesh : 0,
                     state.selection.node ? state.selection.node->node : tracer::none) +
         fmt::format(" {} {} {} {} {}", state.icicle.drawing, state.icicle.width,
                     state.icicle.color, state.icicle.logarithmic, state.icicle.mesh) +
         fmt::format(" {} {} {}", state.hot.ray_class, state.hot.with_cause, state.replay.mesh);
}

}  // namespace ui
