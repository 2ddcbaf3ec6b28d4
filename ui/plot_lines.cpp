// Draws the curves.
#include "ui/plot_lines.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "ui/plot.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

// From values to the screen.
struct PlotArea {
  ImVec2 lo, hi;
  double x_lo, x_hi, y_hi;

  float x(double at) const {
    return lo.x + (hi.x - lo.x) * static_cast<float>((at - x_lo) / (x_hi - x_lo));
  }
  float y(double value) const { return hi.y - (hi.y - lo.y) * static_cast<float>(value / y_hi); }
};

double largest(const LinePlot& plot) {
  double most = 0.0;
  for (const Line& line : plot.lines) {
    for (const double value : line.values)
      most = std::max(most, value);
  }
  return most;
}

void draw_value_axis(ImDrawList& list, const PlotArea& to) {
  const ImU32 dim = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  const ImU32 grid = ImGui::GetColorU32(ImGuiCol_Border, 0.5f);
  const int most = std::max(static_cast<int>((to.hi.y - to.lo.y) / (1.6f * em())), 1);
  const double step = tick_step(to.y_hi, most);
  for (int i = 0; i * step <= to.y_hi * (1.0 + 1e-9); ++i) {
    const float y = std::floor(to.y(i * step)) + 0.5f;
    list.AddLine({to.lo.x, y}, {to.hi.x, y}, grid);
    const std::string text = short_number(i * step);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    list.AddText({std::floor(to.lo.x - size.x - 0.3f * em()), std::floor(y - 0.5f * size.y)}, dim,
                 text.c_str());
  }
}

void draw_place_axis(ImDrawList& list, const PlotArea& to, const std::string& unit) {
  const ImU32 dim = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  const int most = std::max(static_cast<int>((to.hi.x - to.lo.x) / (4.0f * em())), 2);
  const double step = tick_step(to.x_hi - to.x_lo, most);
  const double begin = std::ceil(to.x_lo / step - 1e-9);
  for (int i = 0; (begin + i) * step <= to.x_hi * (1.0 + 1e-9); ++i) {
    const double tick = (begin + i) * step;
    const float x = std::floor(to.x(tick)) + 0.5f;
    list.AddLine({x, to.hi.y}, {x, to.hi.y + 0.25f * em()}, dim);
    const std::string text = short_number(tick) + (i == 0 ? " " + unit : "");
    const float half = 0.5f * ImGui::CalcTextSize(short_number(tick).c_str()).x;
    const float last = to.hi.x - ImGui::CalcTextSize(text.c_str()).x;  // nothing is cut off
    list.AddText({std::floor(std::min(x - half, last)), std::floor(to.hi.y + 0.25f * em())}, dim,
                 text.c_str());
  }
}

void draw_dashed(ImDrawList& list, float x, float from, float to, ImU32 color) {
  const float dash = 0.3f * em();
  for (float y = from; y < to; y += 2.0f * dash)
    list.AddLine({x, y}, {x, std::min(y + dash, to)}, color, 1.5f);
}

void draw_line(ImDrawList& list, const PlotArea& to, const Line& line, std::span<const double> at) {
  const size_t count = std::min(line.values.size(), at.size());
  std::vector<ImVec2> points(count);
  for (size_t i = 0; i < count; ++i)
    points[i] = {to.x(at[i]), to.y(line.values[i])};
  if (count == 1) list.AddCircleFilled(points[0], 0.15f * em(), line.color);
  list.AddPolyline(points.data(), static_cast<int>(count), line.color, 0, 1.6f);
}

// The place nearest to the mouse.
size_t nearest(const LinePlot& plot, double at) {
  size_t best = 0;
  for (size_t i = 1; i < plot.at.size(); ++i) {
    if (std::abs(plot.at[i] - at) < std::abs(plot.at[best] - at)) best = i;
  }
  return best;
}

std::string values_at(const LinePlot& plot, size_t place) {
  std::string text = fmt::format("{} {}", short_number(plot.at[place]), plot.axis_unit);
  for (const Line& line : plot.lines) {
    if (place >= line.values.size()) continue;
    text += fmt::format("\n{}: {} {}", line.name, short_number(line.values[place]), plot.unit);
  }
  return text;
}

}  // namespace

std::optional<double> plot_lines(const char* label, const LinePlot& plot, ImVec2 size,
                                 const char* help) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton(label, {std::max(size.x, 1.0f), std::max(size.y, 1.0f)});
  mark(label);
  const bool hovered = ImGui::IsItemHovered();
  const bool held = ImGui::IsItemActive();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(at, {at.x + size.x, at.y + size.y}, true);
  const double most = largest(plot);
  const std::string widest = short_number(most > 0.0 ? 1.05 * most : 1000.0);
  const float room = std::max(ImGui::CalcTextSize(widest.c_str()).x, 2.0f * em());
  const PlotArea to = {{at.x + room + 0.8f * em(), at.y + 1.5f * em()},
                       {at.x + size.x - 0.8f * em(), at.y + size.y - 1.6f * em()},
                       plot.lo,
                       std::max(plot.hi, plot.lo + 1e-6),
                       most > 0.0 ? 1.08 * most : 1.0};
  const std::string title = plot.title + (plot.unit.empty() ? "" : ", " + plot.unit);
  list.AddText({at.x + 0.3f * em(), at.y}, ImGui::GetColorU32(ImGuiCol_Text), title.c_str());
  list.AddRectFilled(to.lo, to.hi, ImGui::GetColorU32(ImGuiCol_FrameBg), 2.0f);
  if (most > 0.0) {
    draw_value_axis(list, to);
  } else {
    list.AddText({to.lo.x + 0.5f * em(), to.lo.y + 0.5f * em()},
                 ImGui::GetColorU32(ImGuiCol_TextDisabled), "not measured");
  }
  draw_place_axis(list, to, plot.axis_unit);
  const ImU32 bright = ImGui::GetColorU32(ImGuiCol_Text);
  list.PushClipRect(to.lo, to.hi, true);
  for (const PlotMark& mark_of : plot.marks) {
    const float x = std::floor(to.x(mark_of.at)) + 0.5f;
    draw_dashed(list, x, to.lo.y, to.hi.y, IM_COL32(255, 235, 120, 220));
    const float width = ImGui::CalcTextSize(mark_of.what.c_str()).x;
    const bool left = x + width + em() > to.hi.x;
    list.AddText({left ? x - width - 0.3f * em() : x + 0.3f * em(), to.lo.y},
                 IM_COL32(255, 235, 120, 255), mark_of.what.c_str());
  }
  for (const Line& line : plot.lines)
    draw_line(list, to, line, plot.at);
  if (plot.now) {
    const float x = std::floor(to.x(*plot.now)) + 0.5f;
    list.AddLine({x, to.lo.y}, {x, to.hi.y}, bright);
  }
  const double under =
      to.x_lo + (to.x_hi - to.x_lo) * static_cast<double>((ImGui::GetIO().MousePos.x - to.lo.x) /
                                                          std::max(to.hi.x - to.lo.x, 1.0f));
  if (hovered && !plot.at.empty()) {
    const size_t place = nearest(plot, under);
    for (const Line& line : plot.lines) {
      if (place >= line.values.size()) continue;
      list.AddCircleFilled({to.x(plot.at[place]), to.y(line.values[place])}, 0.2f * em(),
                           line.color);
    }
    tooltip(fmt::format("{}\n\n{}", values_at(plot, place), help));
  } else {
    tooltip(help);
  }
  list.PopClipRect();
  list.PopClipRect();
  if (!held) return std::nullopt;
  return std::clamp(under, to.x_lo, to.x_hi);
}

}  // namespace ui
