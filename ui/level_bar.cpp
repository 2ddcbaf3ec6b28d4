#include "ui/level_bar.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <imgui.h>

#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

void draw_segments(ImVec2 at, ImVec2 size, int first, int last, int levels, int under) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float width = size.x / static_cast<float>(levels);
  const float text = ImGui::CalcTextSize("00").x + 0.3f * em();
  const int step = std::max(1, static_cast<int>(std::ceil(text / width)));  // of the numbers
  const float gap = width > 6.0f ? 1.0f : 0.0f;
  for (int i = 0; i < levels; ++i) {
    const float x0 = std::floor(at.x + width * static_cast<float>(i));
    const float x1 = std::floor(at.x + width * static_cast<float>(i + 1)) - gap;
    const bool chosen = i >= first && i <= last;
    const ImGuiCol color = chosen       ? ImGuiCol_SliderGrab
                           : i == under ? ImGuiCol_FrameBgHovered
                                        : ImGuiCol_FrameBg;
    list.AddRectFilled({x0, at.y}, {std::max(x1, x0 + 1.0f), at.y + size.y},
                       ImGui::GetColorU32(color), gap > 0.0f ? 2.0f : 0.0f);
  }
  for (int i = 0; i < levels; ++i) {  // over their neighbours
    const float x0 = std::floor(at.x + width * static_cast<float>(i));
    const float x1 = std::floor(at.x + width * static_cast<float>(i + 1)) - gap;
    if (i % step != 0 || static_cast<float>(i) * width + text > size.x + 0.5f * em()) continue;
    const std::string number = std::to_string(i);
    const float shift = step == 1 ? 0.5f * (x1 - x0 - ImGui::CalcTextSize(number.c_str()).x) : 1.0f;
    list.AddText({std::floor(x0 + shift), std::floor(at.y + 0.5f * (size.y - em()))},
                 ImGui::GetColorU32(ImGuiCol_Text), number.c_str());
  }
}

}  // namespace

bool level_bar(const char* label, int& first, int& last, int levels, const char* help) {
  row_label(label, help);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size = {std::max(ImGui::CalcItemWidth(), 1.0f), ImGui::GetFrameHeight()};
  levels = std::max(levels, 1);
  ImGui::InvisibleButton(label, size);
  mark(label);
  const Scope scope(label);
  for (int i = 0; i < levels; ++i) {
    const float width = size.x / static_cast<float>(levels);
    mark("level " + std::to_string(i), {at.x + width * static_cast<float>(i), at.y},
         {at.x + width * static_cast<float>(i + 1), at.y + size.y});
  }
  const float part = (ImGui::GetIO().MousePos.x - at.x) / size.x;
  const int under = std::clamp(static_cast<int>(part * static_cast<float>(levels)), 0, levels - 1);
  ImGuiStorage& kept = *ImGui::GetStateStorage();
  const ImGuiID id = ImGui::GetID("anchor");
  const int was_first = first, was_last = last;
  if (ImGui::IsItemActivated()) {
    const bool extend = ImGui::GetIO().KeyShift;
    kept.SetInt(id, !extend ? under : under < first ? last : first);
  }
  if (ImGui::IsItemActive()) {
    const int anchor = kept.GetInt(id);
    first = std::min(anchor, under);
    last = std::max(anchor, under);
  }
  const bool hovered = ImGui::IsItemHovered();
  if (hovered) tooltip(help);
  draw_segments(at, size, first, last, levels, hovered ? under : -1);
  return first != was_first || last != was_last;
}

}  // namespace ui
