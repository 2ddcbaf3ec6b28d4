// Draws the bars.
#include "ui/plot.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

struct Area {
  ImVec2 lo, hi;
};

float height_of(double value, double most, bool logarithmic, float room) {
  if (most <= 0.0 || value <= 0.0) return 0.0f;
  const double part = logarithmic ? std::log1p(value) / std::log1p(most) : value / most;
  return std::max(static_cast<float>(part) * room, 1.0f);
}

void draw_axis(ImDrawList& list, const Area& area, const Bars& bars) {
  const double length = bars.step * static_cast<double>(bars.heights.size());
  const float width = area.hi.x - area.lo.x;
  const int most = std::max(static_cast<int>(width / (4.0f * em())), 1);
  double step = tick_step(length, most);
  if (bars.whole) step = std::max(step, 1.0);
  const ImU32 dim = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  const double begin = std::ceil(bars.first / step) * step;
  const int ticks = static_cast<int>((bars.first + length - begin) / step) + 1;
  for (int i = 0; i < ticks; ++i) {
    const double tick = begin + i * step;
    const double offset = bars.whole ? 0.5 * bars.step : 0.0;
    const float x =
        std::floor(area.lo.x + width * static_cast<float>((tick + offset - bars.first) / length)) +
        0.5f;
    if (x > area.hi.x) break;
    list.AddLine({x, area.hi.y}, {x, area.hi.y + 0.25f * em()}, dim);
    const std::string text = short_number(tick);
    const float half = 0.5f * ImGui::CalcTextSize(text.c_str()).x;
    if (x + half <= area.hi.x + 0.5f * em()) {
      list.AddText({std::floor(x - half), std::floor(area.hi.y + 0.25f * em())}, dim, text.c_str());
    }
  }
}

}  // namespace

double tick_step(double length, int most) {
  if (!(length > 0.0) || most < 1) return 1.0;
  const double rough = length / most;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
    if (factor * power >= rough * (1.0 - 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

void plot_bars(const char* label, const Bars& bars, ImVec2 size, const char* help) {
  const ImVec2 rest = ImGui::GetContentRegionAvail();
  if (size.x <= 0.0f) size.x = rest.x;
  if (size.y <= 0.0f) size.y = std::max(rest.y, 7.0f * em());
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton(label, {std::max(size.x, 1.0f), std::max(size.y, 1.0f)});
  mark(label);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(at, {at.x + size.x, at.y + size.y}, true);
  const Area area = {{at.x + 0.5f * em(), at.y + 1.5f * em()},
                     {at.x + size.x - 0.5f * em(), at.y + size.y - 1.6f * em()}};
  const double most =
      bars.heights.empty() ? 0.0 : *std::max_element(bars.heights.begin(), bars.heights.end());
  list.AddText({at.x + 0.5f * em(), at.y}, ImGui::GetColorU32(ImGuiCol_Text), bars.title.c_str());
  if (bars.logarithmic) {
    const float width = ImGui::CalcTextSize("log").x;
    const float title = ImGui::CalcTextSize(bars.title.c_str()).x + em();
    if (area.lo.x + title + width < area.hi.x) {
      list.AddText({area.hi.x - width, at.y}, ImGui::GetColorU32(ImGuiCol_TextDisabled), "log");
    }
  }
  list.AddRectFilled(area.lo, area.hi, ImGui::GetColorU32(ImGuiCol_FrameBg), 2.0f);
  if (most <= 0.0) {
    list.AddText({area.lo.x + 0.5f * em(), area.lo.y + 0.5f * em()},
                 ImGui::GetColorU32(ImGuiCol_TextDisabled), "nothing to show yet");
    list.PopClipRect();
    return;
  }
  const float width = (area.hi.x - area.lo.x) / static_cast<float>(bars.heights.size());
  const float room = area.hi.y - area.lo.y - 0.3f * em();
  int under = -1;
  if (ImGui::IsItemHovered()) {
    under = static_cast<int>((ImGui::GetIO().MousePos.x - area.lo.x) / width);
    if (under < 0 || under >= static_cast<int>(bars.heights.size())) under = -1;
  }
  for (size_t i = 0; i < bars.heights.size(); ++i) {
    const float height = height_of(bars.heights[i], most, bars.logarithmic, room);
    if (height == 0.0f) continue;
    const float x = area.lo.x + width * static_cast<float>(i);
    const ImGuiCol color =
        static_cast<int>(i) == under ? ImGuiCol_PlotHistogramHovered : ImGuiCol_PlotHistogram;
    list.AddRectFilled({x, area.hi.y - height}, {x + std::max(width - 1.0f, 1.0f), area.hi.y},
                       ImGui::GetColorU32(color));
  }
  draw_axis(list, area, bars);
  list.PopClipRect();
  if (under < 0) {
    tooltip(help);
    return;
  }
  const double from = bars.first + bars.step * under;
  const std::string place = bars.whole ? fmt::format("{} {}", short_number(from), bars.unit)
                                       : fmt::format("{} to {} {}", short_number(from),
                                                     short_number(from + bars.step), bars.unit);
  tooltip(fmt::format("{}: {} {}\n\n{}", place, grouped(static_cast<uint64_t>(bars.heights[under])),
                      bars.what, help));
}

}  // namespace ui
