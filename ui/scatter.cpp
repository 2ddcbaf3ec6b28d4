#include "ui/scatter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "ui/plot.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

constexpr ImU32 bright = IM_COL32(255, 200, 60, 255);
constexpr ImU32 plain = IM_COL32(104, 156, 214, 255);

struct Axis {
  double lo = 0.0, hi = 1.0;  // of the shown part
  bool logarithmic = false;
  float from = 0.0f, to = 0.0f;  // on the screen

  float place(double value) const {
    const double part =
        logarithmic ? std::log(value / lo) / std::log(hi / lo) : (value - lo) / (hi - lo);
    return from + static_cast<float>(part) * (to - from);
  }
};

// With some room on both sides.
Axis axis_over(std::span<const ScatterPoint> points, double ScatterPoint::*member,
               bool logarithmic) {
  Axis axis;
  axis.logarithmic = logarithmic;
  axis.lo = axis.hi = points[0].*member;
  for (const ScatterPoint& point : points) {
    axis.lo = std::min(axis.lo, point.*member);
    axis.hi = std::max(axis.hi, point.*member);
  }
  if (logarithmic) {
    const double factor = std::max(std::pow(axis.hi / axis.lo, 0.08), 1.15);
    axis.lo /= factor;
    axis.hi *= factor;
  } else {
    const double room = std::max({0.12 * (axis.hi - axis.lo), 0.02 * std::abs(axis.hi), 1e-9});
    axis.lo -= room;
    axis.hi += room;
  }
  return axis;
}

std::vector<double> ticks(const Axis& axis, int most) {
  std::vector<double> values;
  if (!axis.logarithmic) {
    const double step = tick_step(axis.hi - axis.lo, most);
    for (double tick = std::ceil(axis.lo / step) * step; tick <= axis.hi; tick += step)
      values.push_back(std::abs(tick) < 1e-9 * step ? 0.0 : tick);
    return values;
  }
  // 1, 2 and 5 times powers of ten, or powers alone where those are too many.
  for (const bool all : {true, false}) {
    values.clear();
    for (double power = std::pow(10.0, std::floor(std::log10(axis.lo))); power <= axis.hi;
         power *= 10.0) {
      for (const double factor : {1.0, 2.0, 5.0}) {
        const bool inside = factor * power >= axis.lo && factor * power <= axis.hi;
        if (inside && (all || factor == 1.0)) values.push_back(factor * power);
      }
    }
    if (static_cast<int>(values.size()) <= most) break;
  }
  return values;
}

// Names and numbers below and to the left of the area; thin lines inside.
void draw_axes(ImDrawList& list, const Scatter& scatter, const Axis& x, const Axis& y) {
  const ImU32 dim = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  const ImU32 line = ImGui::GetColorU32(ImGuiCol_Separator, 0.6f);
  list.AddRectFilled({x.from, y.to}, {x.to, y.from}, ImGui::GetColorU32(ImGuiCol_FrameBg), 2.0f);
  for (const double tick :
       ticks(x, std::max(static_cast<int>((x.to - x.from) / (3.5f * em())), 2))) {
    const float at = std::floor(x.place(tick)) + 0.5f;
    const std::string text = short_number(tick);
    const float half = 0.5f * ImGui::CalcTextSize(text.c_str()).x;
    list.AddLine({at, y.to}, {at, y.from}, line);
    list.AddText({std::floor(at - half), y.from + 0.1f * em()}, dim, text.c_str());
  }
  for (const double tick :
       ticks(y, std::max(static_cast<int>((y.from - y.to) / (2.0f * em())), 2))) {
    const float at = std::floor(y.place(tick)) + 0.5f;
    const std::string text = short_number(tick);
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    list.AddLine({x.from, at}, {x.to, at}, line);
    list.AddText({std::floor(x.from - width - 0.4f * em()), at - 0.5f * em()}, dim, text.c_str());
  }
  const float width = ImGui::CalcTextSize(scatter.x_title.c_str()).x;
  list.AddText({std::floor(x.to - width), y.from + 1.15f * em()}, dim, scatter.x_title.c_str());
  list.AddText({std::floor(x.from - 3.2f * em()), std::floor(y.to - 1.25f * em())}, dim,
               scatter.y_title.c_str());
  if (!scatter.diagonal) return;
  const double lo = std::max(x.lo, y.lo), hi = std::min(x.hi, y.hi);
  if (lo < hi) list.AddLine({x.place(lo), y.place(lo)}, {x.place(hi), y.place(hi)}, dim, 1.5f);
}

// What no other point is better than: a line of steps from the left to the right.
void draw_front(ImDrawList& list, const Scatter& scatter, const Axis& x, const Axis& y) {
  std::vector<ImVec2> front;
  for (const ScatterPoint& point : scatter.points) {
    if (point.front) front.emplace_back(x.place(point.x), y.place(point.y));
  }
  std::sort(front.begin(), front.end(), [](ImVec2 a, ImVec2 b) { return a.x < b.x; });
  for (size_t i = 1; i < front.size(); ++i) {
    const ImVec2 corner(front[i].x, front[i - 1].y);
    list.AddLine(front[i - 1], corner, IM_COL32(255, 200, 60, 110), 1.5f);
    list.AddLine(corner, front[i], IM_COL32(255, 200, 60, 110), 1.5f);
  }
}

bool overlap(const ImVec4& a, const ImVec4& b) {
  return a.x < b.z && b.x < a.z && a.y < b.w && b.y < a.w;
}

// Beside their points, where there is room; the lit one always.
void draw_labels(ImDrawList& list, const Scatter& scatter, const Axis& x, const Axis& y, int lit) {
  std::vector<ImVec4> taken;
  for (const ScatterPoint& point : scatter.points) {
    const ImVec2 at(x.place(point.x), y.place(point.y));
    const float radius = 0.35f * em();
    taken.push_back({at.x - radius, at.y - radius, at.x + radius, at.y + radius});
  }
  std::vector<int> order;
  for (int i = 0; i < static_cast<int>(scatter.points.size()); ++i)
    order.push_back(i);
  const auto rank = [&](int i) { return i == lit ? 0 : scatter.points[i].front ? 1 : 2; };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return rank(a) < rank(b); });
  for (const int i : order) {
    const ScatterPoint& point = scatter.points[i];
    const ImVec2 at(x.place(point.x), y.place(point.y));
    const ImVec2 size = ImGui::CalcTextSize(point.label.c_str());
    const float gap = 0.6f * em();
    const ImVec2 places[] = {{at.x + gap, at.y - 0.5f * size.y},
                             {at.x - gap - size.x, at.y - 0.5f * size.y},
                             {at.x - 0.5f * size.x, at.y - gap - size.y},
                             {at.x - 0.5f * size.x, at.y + gap}};
    for (const ImVec2& place : places) {
      const ImVec4 box(place.x, place.y, place.x + size.x, place.y + size.y);
      const bool inside =
          box.x >= x.from && box.z <= x.to && box.y >= y.to - 0.2f * em() && box.w <= y.from;
      const bool free = std::none_of(taken.begin(), taken.end(),
                                     [&](const ImVec4& other) { return overlap(box, other); });
      if (i != lit && !(inside && free)) continue;
      if (i == lit && !inside) continue;
      if (i == lit) {
        list.AddRectFilled({box.x - 2, box.y - 1}, {box.z + 2, box.w + 1}, IM_COL32(0, 0, 0, 190),
                           2.0f);
      }
      taken.push_back(box);
      const ImU32 color = i == lit ? IM_COL32_WHITE : ImGui::GetColorU32(ImGuiCol_Text, 0.8f);
      list.AddText({std::floor(place.x), std::floor(place.y)}, color, point.label.c_str());
      break;
    }
  }
}

}  // namespace

ScatterMouse plot_scatter(const char* label, const Scatter& scatter, ImVec2 size,
                          const char* help) {
  ScatterMouse mouse;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton(label, {std::max(size.x, 1.0f), std::max(size.y, 1.0f)});
  mark(label);
  const bool hovered = ImGui::IsItemHovered();
  mouse.clicked = ImGui::IsItemClicked();
  if (scatter.points.empty() || size.x < 8.0f * em() || size.y < 5.0f * em()) return mouse;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(at, {at.x + size.x, at.y + size.y}, true);
  Axis x = axis_over(scatter.points, &ScatterPoint::x, scatter.logarithmic_x);
  Axis y = axis_over(scatter.points, &ScatterPoint::y, false);
  x.from = std::floor(at.x + 3.4f * em());
  x.to = std::floor(at.x + size.x - 0.5f * em());
  y.from = std::floor(at.y + size.y - 2.3f * em());
  y.to = std::floor(at.y + 1.4f * em());
  draw_axes(list, scatter, x, y);
  draw_front(list, scatter, x, y);

  float nearest = em() * em();
  for (int i = 0; i < static_cast<int>(scatter.points.size()); ++i) {
    const ImVec2 place(x.place(scatter.points[i].x), y.place(scatter.points[i].y));
    const ImVec2 cursor = ImGui::GetIO().MousePos;
    const float dx = place.x - cursor.x, dy = place.y - cursor.y;
    if (!hovered || dx * dx + dy * dy > nearest) continue;
    nearest = dx * dx + dy * dy;
    mouse.hovered = i;
  }
  mouse.clicked = mouse.clicked && mouse.hovered >= 0;
  const int lit = mouse.hovered >= 0 ? mouse.hovered : scatter.lit;
  const Scope scope(label);
  for (int i = 0; i < static_cast<int>(scatter.points.size()); ++i) {
    const ScatterPoint& point = scatter.points[i];
    const ImVec2 place(x.place(point.x), y.place(point.y));
    const float radius = (i == lit ? 0.42f : 0.3f) * em();
    list.AddCircleFilled(place, radius, point.front ? bright : plain);
    if (point.present || i == lit) list.AddCircle(place, radius + 2.0f, IM_COL32_WHITE, 0, 1.5f);
    mark(fmt::format("point {}", i + 1), {place.x - radius, place.y - radius},
         {place.x + radius, place.y + radius});
  }
  draw_labels(list, scatter, x, y, lit);
  list.PopClipRect();
  if (hovered && mouse.hovered < 0) {
    ImGui::SetCursorScreenPos(at);
    ImGui::Dummy(size);
    tooltip(help);
  }
  return mouse;
}

}  // namespace ui
