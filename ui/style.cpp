// Colours, sizes and fonts.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <imgui.h>
#if __has_include(<imgui_freetype.h>)
#include <imgui_freetype.h>
#else
#include <misc/freetype/imgui_freetype.h>
#endif

#include "ui/workspace_state.h"

namespace ui {
namespace {

namespace fs = std::filesystem;

// The folders that hold `fonts/`, after the XDG base directory specification.
std::vector<fs::path> data_folders() {
  std::vector<fs::path> folders;
  if (const char* home = std::getenv("HOME")) folders.emplace_back(fs::path(home) / ".local/share");
  const char* listed = std::getenv("XDG_DATA_DIRS");
  std::string list = listed != nullptr && *listed != '\0' ? listed : "/usr/local/share:/usr/share";
  list += ":/usr/share";
  size_t begin = 0;
  while (begin < list.size()) {
    const size_t end = std::min(list.find(':', begin), list.size());
    if (end > begin) folders.emplace_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  return folders;
}

// The first of the fonts that is installed, or an empty path.
fs::path find_font(std::initializer_list<const char*> names) {
  for (const char* name : names) {
    for (const fs::path& folder : data_folders()) {
      fs::path file = folder / "fonts" / name;
      std::error_code error;
      if (fs::is_regular_file(file, error)) return file;
    }
  }
  return {};
}

// Pairs of first and last code point; ImGui keeps the pointer until the atlas is built.
constexpr ImWchar text_ranges[] = {0x0020, 0x024F, 0x0370, 0x03FF, 0x0400, 0x052F, 0x2000,
                                   0x206F, 0x20A0, 0x20BF, 0x2100, 0x214F, 0};
constexpr ImWchar symbol_ranges[] = {0x2070, 0x209F, 0x2190, 0x21FF, 0x2200, 0x22FF,
                                     0x2300, 0x23FF, 0x25A0, 0x26FF, 0};

void load_fonts(float scale) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
#if IMGUI_VERSION_NUM >= 19200
  atlas.SetFontLoader(ImGuiFreeType::GetFontLoader());
#else
  atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
#endif
  const float size = std::floor(15.0f * scale);
  const fs::path dejavu = find_font({"truetype/dejavu/DejaVuSans.ttf"});
  fs::path text = find_font({"truetype/roboto/unhinted/RobotoTTF/Roboto-Regular.ttf",
                             "truetype/roboto/Roboto-Regular.ttf"});
  if (text.empty()) text = dejavu;
  if (text.empty()) {
    ImFontConfig config;
    config.SizePixels = std::floor(13.0f * scale);
    atlas.AddFontDefault(&config);
    return;
  }
  atlas.AddFontFromFileTTF(text.c_str(), size, nullptr, text_ranges);
  if (!dejavu.empty()) {  // arrows and mathematical signs, which Roboto lacks
    ImFontConfig config;
    config.MergeMode = true;
    atlas.AddFontFromFileTTF(dejavu.c_str(), std::floor(14.0f * scale), &config, symbol_ranges);
  }
}

ImVec4 grey(float value, float alpha = 1.0f) {
  return {value, value * 1.02f, value * 1.06f, alpha};
}

void set_colors(ImGuiStyle& style) {
  ImGui::StyleColorsDark(&style);
  const ImVec4 accent = {0.22f, 0.50f, 0.78f, 1.0f};
  const ImVec4 accent_bright = {0.30f, 0.60f, 0.90f, 1.0f};
  const ImVec4 accent_dim = {0.18f, 0.34f, 0.52f, 1.0f};
  ImVec4* c = style.Colors;
  c[ImGuiCol_Text] = grey(0.89f);
  c[ImGuiCol_TextDisabled] = grey(0.56f);
  c[ImGuiCol_WindowBg] = grey(0.085f);
  c[ImGuiCol_ChildBg] = grey(0.115f);
  c[ImGuiCol_PopupBg] = grey(0.135f, 0.98f);
  c[ImGuiCol_MenuBarBg] = grey(0.085f);
  c[ImGuiCol_Border] = grey(0.24f);
  c[ImGuiCol_FrameBg] = grey(0.185f);
  c[ImGuiCol_FrameBgHovered] = grey(0.24f);
  c[ImGuiCol_FrameBgActive] = grey(0.28f);
  c[ImGuiCol_Button] = grey(0.22f);
  c[ImGuiCol_ButtonHovered] = accent_dim;
  c[ImGuiCol_ButtonActive] = accent;
  c[ImGuiCol_Header] = grey(0.20f);
  c[ImGuiCol_HeaderHovered] = accent_dim;
  c[ImGuiCol_HeaderActive] = accent;
  c[ImGuiCol_SliderGrab] = accent;
  c[ImGuiCol_SliderGrabActive] = accent_bright;
  c[ImGuiCol_CheckMark] = accent_bright;
  c[ImGuiCol_Separator] = grey(0.22f);
  c[ImGuiCol_SeparatorHovered] = accent;
  c[ImGuiCol_SeparatorActive] = accent_bright;
  c[ImGuiCol_Tab] = grey(0.135f);
  c[ImGuiCol_TabHovered] = accent_dim;
  c[ImGuiCol_PlotHistogram] = accent;
  c[ImGuiCol_PlotHistogramHovered] = accent_bright;
  c[ImGuiCol_TableHeaderBg] = grey(0.16f);
  c[ImGuiCol_TableBorderStrong] = grey(0.22f);
  c[ImGuiCol_TableBorderLight] = grey(0.18f);
  c[ImGuiCol_TableRowBgAlt] = {1.0f, 1.0f, 1.0f, 0.025f};
  c[ImGuiCol_ScrollbarBg] = grey(0.10f, 0.0f);
  c[ImGuiCol_TextSelectedBg] = accent_dim;
  c[ImGuiCol_TitleBg] = grey(0.10f);
  c[ImGuiCol_TitleBgActive] = grey(0.16f);
  c[ImGuiCol_ModalWindowDimBg] = {0.0f, 0.0f, 0.0f, 0.45f};
#if IMGUI_VERSION_NUM >= 19090
  c[ImGuiCol_TabSelected] = grey(0.22f);
  c[ImGuiCol_TabDimmed] = grey(0.135f);
  c[ImGuiCol_TabDimmedSelected] = grey(0.22f);
#else
  c[ImGuiCol_TabActive] = grey(0.22f);
  c[ImGuiCol_TabUnfocused] = grey(0.135f);
  c[ImGuiCol_TabUnfocusedActive] = grey(0.22f);
#endif
}

}  // namespace

void apply_style(float scale) {
  scale = std::clamp(scale, 0.5f, 4.0f);
  ImGuiStyle style;
  set_colors(style);
  style.WindowPadding = {8, 8};
  style.FramePadding = {6, 3};
  style.ItemSpacing = {6, 5};
  style.ItemInnerSpacing = {6, 4};
  style.CellPadding = {5, 2};
  style.IndentSpacing = 14;
  style.ScrollbarSize = 12;
  style.GrabMinSize = 10;
  style.WindowRounding = 4;
  style.ChildRounding = 4;
  style.FrameRounding = 3;
  style.PopupRounding = 4;
  style.GrabRounding = 3;
  style.TabRounding = 4;
  style.ScrollbarRounding = 6;
  style.ChildBorderSize = 0;
  style.WindowBorderSize = 1;
  style.ScaleAllSizes(scale);
  ImGui::GetStyle() = style;
  load_fonts(scale);
}

}  // namespace ui
