// Draws the bar and moves its ends.
#include "ui/range_bar.h"

#include <algorithm>
#include <cmath>

#include <imgui.h>

#include "tracer/choice.h"
#include "tracer/render/colormap.h"
#include "tracer/render/value_scale.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::ValueRange;

ImU32 packed(const tracer::vec3& color) {
  return ImGui::GetColorU32(ImVec4(color.x, color.y, color.z, 1.0f));
}

void draw_gradient(ImDrawList& list, ImVec2 lo, ImVec2 hi, const tracer::ColormapRow& map) {
  const int steps = std::clamp(static_cast<int>(hi.x - lo.x) / 3, 1, 96);
  for (int i = 0; i < steps; ++i) {
    const float from = static_cast<float>(i) / static_cast<float>(steps);
    const float to = static_cast<float>(i + 1) / static_cast<float>(steps);
    list.AddRectFilledMultiColor({lo.x + from * (hi.x - lo.x), lo.y},
                                 {lo.x + to * (hi.x - lo.x), hi.y}, packed(map.color(from)),
                                 packed(map.color(to)), packed(map.color(to)),
                                 packed(map.color(from)));
  }
}

// Heights by the logarithm: one bar of sky would flatten all others.
void draw_bars(ImDrawList& list, ImVec2 lo, ImVec2 hi, const std::vector<uint32_t>& bars) {
  const uint32_t most = bars.empty() ? 0 : *std::max_element(bars.begin(), bars.end());
  if (most == 0) return;
  const float width = (hi.x - lo.x) / static_cast<float>(bars.size());
  for (size_t i = 0; i < bars.size(); ++i) {
    if (bars[i] == 0) continue;
    const float height = std::log1p(static_cast<float>(bars[i])) /
                         std::log1p(static_cast<float>(most)) * (hi.y - lo.y);
    const float x = lo.x + width * static_cast<float>(i);
    list.AddRectFilled({x, hi.y - height}, {x + std::max(width - 1.0f, 1.0f), hi.y},
                       ImGui::GetColorU32(ImGuiCol_PlotHistogram));
  }
}

void draw_handle(ImDrawList& list, float x, float top, float bottom, bool lit) {
  const float half = 0.35f * em();
  const ImU32 color = lit ? IM_COL32(255, 255, 255, 255) : IM_COL32(210, 214, 220, 255);
  list.AddLine({x, top}, {x, bottom}, IM_COL32(0, 0, 0, 160), 4.0f);
  list.AddLine({x, top}, {x, bottom}, color, 2.0f);
  list.AddTriangleFilled({x - half, bottom + half}, {x + half, bottom + half}, {x, bottom - half},
                         color);
}

}  // namespace

bool range_bar(const char* label, ValueRange& range, const tracer::Picture& picture,
               const tracer::ViewOptions& options, const char* help) {
  const tracer::ColormapRow* map = tracer::find_row(tracer::colormaps(), options.colormap);
  if (map == nullptr) return false;
  const float margin = 0.4f * em();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size = {std::max(ImGui::GetContentRegionAvail().x, 4.0f * margin), 4.4f * em()};
  ImGui::InvisibleButton(label, size);
  mark(label);

  // All values of the picture, and the shown ones; does not change under the hand.
  ImGuiStorage& kept = *ImGui::GetStateStorage();
  const ImGuiID id = ImGui::GetID(label);
  if (!ImGui::IsItemActive() || ImGui::IsItemActivated()) {
    kept.SetFloat(id + 1, std::min(range.lo, picture.histogram.range.lo));
    kept.SetFloat(id + 2, std::max(range.hi, picture.histogram.range.hi));
  }
  const ValueRange all = {kept.GetFloat(id + 1), kept.GetFloat(id + 2)};
  const tracer::ValueScale scale(all, options.logarithmic, picture.counts);
  const float left = at.x + margin, width = size.x - 2.0f * margin;
  const auto place = [&](float value) {
    return left + width * std::clamp(scale.position(value), 0.0f, 1.0f);
  };
  float lo = place(range.lo), hi = place(range.hi);
  if (all.hi <= all.lo) hi = left + width;

  bool changed = false;
  const float mouse = ImGui::GetIO().MousePos.x;
  if (ImGui::IsItemActivated()) {
    const bool upper = std::abs(mouse - hi) < std::abs(mouse - lo) || (lo == hi && mouse > hi);
    kept.SetBool(id + 3, upper);
  }
  const bool upper = kept.GetBool(id + 3);
  if (ImGui::IsItemActive() && all.hi > all.lo) {
    float value = scale.value(std::clamp((mouse - left) / width, 0.0f, 1.0f));
    if (picture.counts) value = std::round(value);
    ValueRange moved = range;
    (upper ? moved.hi : moved.lo) = value;
    if (moved.lo > moved.hi) (upper ? moved.hi : moved.lo) = upper ? moved.lo : moved.hi;
    changed = moved != range;
    range = moved;
    lo = place(range.lo);
    hi = place(range.hi);
  } else {
    tooltip(help);
  }

  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float top = at.y, middle = at.y + 2.8f * em(), bottom = at.y + 3.8f * em();
  list.AddRectFilled({left, top}, {left + width, bottom}, ImGui::GetColorU32(ImGuiCol_FrameBg), 2);
  draw_bars(list, {lo, top + 2.0f}, {hi, middle}, picture.histogram.bars);
  list.AddRectFilled({left, middle}, {lo, bottom}, packed(map->color(0.0f)));
  list.AddRectFilled({hi, middle}, {left + width, bottom}, packed(map->color(1.0f)));
  draw_gradient(list, {lo, middle}, {hi, bottom}, *map);
  draw_handle(list, lo, top, bottom, ImGui::IsItemActive() && !upper);
  draw_handle(list, hi, top, bottom, ImGui::IsItemActive() && upper);
  mark("lower end", {lo - 2.0f, top}, {lo + 2.0f, bottom});
  mark("upper end", {hi - 2.0f, top}, {hi + 2.0f, bottom});
  return changed;
}

}  // namespace ui
