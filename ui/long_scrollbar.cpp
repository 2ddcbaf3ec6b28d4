// Draws the bar and moves it.
#include "ui/long_scrollbar.h"

#include <algorithm>
#include <cmath>

#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

constexpr double rows_a_notch = 3.0;  // of the wheel

}  // namespace

void long_scrollbar(const char* label, double& top, const LongList& list, ImVec2 at, ImVec2 size,
                    const char* help) {
  const double last = std::max(list.rows - list.page, 0.0);
  const ImGuiIO& io = ImGui::GetIO();
  if (io.MouseWheel != 0.0f && ImGui::IsWindowHovered(ImGuiHoveredFlags_ChildWindows) &&
      ImGui::IsMouseHoveringRect(list.lo, list.hi, false)) {
    top = std::round(top) - rows_a_notch * static_cast<double>(io.MouseWheel);
  }
  ImGui::SetCursorScreenPos(at);
  ImGui::InvisibleButton(label, {std::max(size.x, 1.0f), std::max(size.y, 1.0f)});
  mark(label);
  const double room = std::max(static_cast<double>(size.y), 1.0);
  const double part = list.rows > 0.0 ? std::min(list.page / list.rows, 1.0) : 1.0;
  const double grip =
      std::clamp(part * room, std::min(1.5 * static_cast<double>(em()), room), room);
  const double way = room - grip;
  const bool held = ImGui::IsItemActive();
  if (held && way > 0.0) {
    const double mouse = static_cast<double>(io.MousePos.y - at.y);
    const double begin = last > 0.0 ? way * top / last : 0.0;
    if (ImGui::IsItemActivated() && (mouse < begin || mouse > begin + grip)) {
      top = (mouse - 0.5 * grip) / way * last;  // a click beside the grip brings it there
    } else {
      top += static_cast<double>(io.MouseDelta.y) / way * last;
    }
  }
  top = std::clamp(top, 0.0, last);
  if (last <= 0.0) return;
  tooltip(help);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 end = {at.x + size.x, at.y + size.y};
  draw.AddRectFilled(at, end, ImGui::GetColorU32(ImGuiCol_ScrollbarBg), 3.0f);
  const ImGuiCol color = held                     ? ImGuiCol_ScrollbarGrabActive
                         : ImGui::IsItemHovered() ? ImGuiCol_ScrollbarGrabHovered
                                                  : ImGuiCol_ScrollbarGrab;
  const float from = at.y + static_cast<float>(way * top / last);
  draw.AddRectFilled({at.x + 2.0f, from}, {end.x - 2.0f, from + static_cast<float>(grip)},
                     ImGui::GetColorU32(color), 3.0f);
}

}  // namespace ui
