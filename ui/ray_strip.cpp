// Draws the strip.
#include "ui/ray_strip.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tracer/analyze/ray_words.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::LoggedRay;
using tracer::Step;
using tracer::StepKind;

// From steps to the screen.
struct StripArea {
  ImVec2 lo, hi;
  size_t steps;
  uint32_t rows;

  float x(size_t step) const {
    return lo.x + (hi.x - lo.x) * static_cast<float>(step) / static_cast<float>(steps);
  }
  float y(uint32_t row) const {
    return lo.y + (hi.y - lo.y) * static_cast<float>(row) / static_cast<float>(rows);
  }
  uint32_t step_at(float at) const {
    const float part = std::clamp((at - lo.x) / (hi.x - lo.x), 0.0f, 1.0f);
    return static_cast<uint32_t>(
        std::min(static_cast<size_t>(part * static_cast<float>(steps)), steps - 1));
  }
};

// Where several steps share a place, the most telling one is seen.
int importance(const Step& step) {
  constexpr int by_look[] = {4, 5, 3, 1, 2, 6, 7};
  return by_look[&step_look(step) - step_looks().data()];
}

// The parts of the strip that are in an instance's tree.
void draw_levels(ImDrawList& list, const StripArea& area, const LoggedRay& ray) {
  for (size_t i = 0; i < ray.steps.size();) {
    size_t end = i + 1;
    while (end < ray.steps.size() && ray.steps[end].instance == ray.steps[i].instance)
      ++end;
    if (ray.steps[i].instance != tracer::none) {
      list.AddRectFilled({std::floor(area.x(i)), area.lo.y},
                         {std::max(std::floor(area.x(end)), std::floor(area.x(i)) + 1), area.hi.y},
                         IM_COL32(255, 255, 255, 14));
    }
    i = end;
  }
}

void draw_cell(ImDrawList& list, const StripArea& area, size_t from, size_t to, uint32_t row,
               ImU32 color) {
  const float left = std::floor(area.x(from));
  const float right = std::max(std::floor(area.x(to)), left + 1.0f);
  const float gap = right - left > 4.0f ? 1.0f : 0.0f;
  const float top = std::floor(area.y(row));
  const float bottom = std::max(std::floor(area.y(row + 1)), top + 2.0f);
  list.AddRectFilled({left, top}, {right - gap, bottom - (bottom - top > 4.0f ? 1.0f : 0.0f)},
                     color);
}

// One cell for each step. Where there are more steps than fit, they share columns, and neighbours
// that look alike one rectangle: a draw list holds 65536 corners at most.
void draw_cells(ImDrawList& list, const StripArea& area, const LoggedRay& ray,
                const std::vector<uint32_t>& rows) {
  constexpr float narrowest = 2.0f;  // pixels of a column
  const auto fitting = static_cast<size_t>(std::max((area.hi.x - area.lo.x) / narrowest, 1.0f));
  const size_t columns = std::min(area.steps, fitting);
  const auto begin = [&](size_t column) { return column * area.steps / columns; };
  std::vector<const Step*> seen(columns * area.rows);  // row by row
  for (size_t column = 0; column < columns; ++column) {
    for (size_t i = begin(column); i < begin(column + 1); ++i) {
      const Step*& cell = seen[rows[i] * columns + column];
      if (cell == nullptr || importance(ray.steps[i]) > importance(*cell)) cell = &ray.steps[i];
    }
  }
  const bool shared = columns < area.steps;
  for (uint32_t row = 0; row < area.rows; ++row) {
    const auto look = [&](size_t column) {
      const Step* step = seen[row * columns + column];
      return step != nullptr ? &step_look(*step) : nullptr;
    };
    for (size_t column = 0; column < columns;) {
      size_t end = column + 1;
      while (shared && end < columns && look(end) == look(column))
        ++end;
      if (look(column) != nullptr) {
        draw_cell(list, area, begin(column), begin(end), row, look(column)->color);
      }
      column = end;
    }
  }
}

// Marks above the steps of the selected node.
void draw_marks(ImDrawList& list, const StripArea& area, const RayStrip& strip) {
  if (!strip.lit_node) return;
  for (size_t i = 0; i < strip.ray.steps.size(); ++i) {
    const Step& step = strip.ray.steps[i];
    if (step.kind == StepKind::triangle || step.kind == StepKind::instance ||
        step.id != strip.lit_node->node ||
        node_of(strip.log, strip.ray, static_cast<uint32_t>(i)) != strip.lit_node) {
      continue;
    }
    const float x = std::floor(0.5f * (area.x(i) + area.x(i + 1)));
    const float size = 0.25f * em();
    list.AddTriangleFilled({x - size, area.lo.y - size}, {x + size, area.lo.y - size},
                           {x, area.lo.y}, IM_COL32(90, 230, 255, 255));
  }
}

void draw_place(ImDrawList& list, const StripArea& area, uint32_t step, uint32_t row, ImU32 color) {
  const float left = std::floor(area.x(step));
  const float right = std::max(std::floor(area.x(step + 1)), left + 2.0f);
  const float middle = std::floor(0.5f * (left + right)) + 0.5f;
  list.AddLine({middle, area.lo.y}, {middle, area.hi.y}, (color & 0x00ffffffu) | 0x80000000u);
  const float top = std::floor(area.y(row));
  const float bottom = std::max(std::floor(area.y(row + 1)), top + 3.0f);
  list.AddRect({left - 1.0f, top - 1.0f}, {right, bottom}, color, 0.0f, 0, 1.5f);
}

std::string hover_words(const RayStrip& strip, uint32_t index) {
  const Step& step = strip.ray.steps[index];
  const std::string reason = tracer::why(strip.ray, index);
  std::string text = fmt::format("Step {} of {}\n{}: {}{}{}\n", index + 1, strip.ray.steps.size(),
                                 tracer::what(step), tracer::name(step.result),
                                 reason.empty() ? "" : ", ", reason);
  if (step.instance == tracer::none) {
    text += fmt::format("TLAS, depth {}", step.depth);
  } else {
    text += fmt::format("instance {}, depth {}", step.instance, step.depth);
  }
  if (step.kind == StepKind::node || step.kind == StepKind::leaf) {
    text += fmt::format("\nt {} to {}", short_number(step.t_entry), short_number(step.t_exit));
  }
  if (step.t_best < tracer::infinity) text += fmt::format("\nbest t {}", short_number(step.t_best));
  return text + "\n\nA click goes there.";
}

void draw_title(ImDrawList& list, ImVec2 at, const std::string& title) {
  const size_t end = std::min(title.find('\n'), title.size());
  list.AddText(at, ImGui::GetColorU32(ImGuiCol_Text), title.data(), title.data() + end);
  if (end == title.size()) return;
  list.AddText({at.x, at.y + ImGui::GetTextLineHeight()}, ImGui::GetColorU32(ImGuiCol_TextDisabled),
               title.data() + end + 1, title.data() + title.size());
}

void draw_depth_axis(ImDrawList& list, const StripArea& area) {
  const std::string last = std::to_string(area.rows - 1);
  const ImU32 dim = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  const float gap = 0.3f * em();
  const float line = ImGui::GetTextLineHeight();
  list.AddText({std::floor(area.lo.x - gap - ImGui::CalcTextSize("0").x), area.lo.y}, dim, "0");
  if (area.hi.y - area.lo.y < 2.0f * line) return;
  list.AddText({std::floor(area.lo.x - gap - ImGui::CalcTextSize(last.c_str()).x),
                std::floor(area.hi.y - line)},
               dim, last.c_str());
}

}  // namespace

std::vector<uint32_t> strip_depths(const LoggedRay& ray) {
  std::vector<uint32_t> rows;
  rows.reserve(ray.steps.size());
  uint32_t root = 0;  // row of the instance's root
  for (const Step& step : ray.steps) {
    uint32_t row = step.depth + (step.instance == tracer::none ? 0 : root);
    if (step.kind == StepKind::instance || step.kind == StepKind::triangle) ++row;
    if (step.kind == StepKind::instance) root = row + 1;
    rows.push_back(row);
  }
  return rows;
}

StripMouse draw_ray_strip(const char* label, const RayStrip& strip, ImVec2 size) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  size = {std::max(std::floor(size.x), 8.0f * em()), std::max(std::floor(size.y), 2.0f * em())};
  ImGui::InvisibleButton(label, size);
  mark(label);
  const bool hovered = ImGui::IsItemHovered();
  const bool held = ImGui::IsItemActive();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  float room = ImGui::CalcTextSize("00").x + 0.6f * em();
  if (!strip.title.empty()) room += ImGui::CalcTextSize(strip.title.c_str()).x + 0.8f * em();
  draw_title(list, at, strip.title);
  if (strip.ray.steps.empty()) return {};
  const std::vector<uint32_t> rows = strip_depths(strip.ray);
  const StripArea area = {{at.x + room, at.y + 0.25f * em()},
                          {at.x + size.x, at.y + size.y},
                          strip.ray.steps.size(),
                          *std::max_element(rows.begin(), rows.end()) + 1};
  list.AddRectFilled(area.lo, area.hi, ImGui::GetColorU32(ImGuiCol_FrameBg), 2.0f);
  draw_levels(list, area, strip.ray);
  draw_cells(list, area, strip.ray, rows);
  draw_marks(list, area, strip);
  draw_depth_axis(list, area);
  StripMouse mouse;
  const float x = ImGui::GetIO().MousePos.x;
  if (hovered && x >= area.lo.x) mouse.hovered = area.step_at(x);
  if (held) mouse.chosen = area.step_at(x);
  if (strip.now) draw_place(list, area, *strip.now, rows[*strip.now], IM_COL32_WHITE);
  const std::optional<uint32_t> lit = mouse.hovered ? mouse.hovered : strip.lit;
  if (lit && *lit < rows.size()) {
    draw_place(list, area, *lit, rows[*lit], IM_COL32(255, 200, 60, 255));
  }
  if (mouse.hovered) {
    tooltip(hover_words(strip, *mouse.hovered));
  } else {
    tooltip(
        "Every step of the ray: from left to right in its order, from top to bottom by the depth, "
        "first of the TLAS, then of the instance's tree (lighter), then triangles");
  }
  return mouse;
}

void draw_strip_legend() {
  const float end = ImGui::GetCursorScreenPos().x + ImGui::GetContentRegionAvail().x;
  bool first = true;
  for (const StepLook& look : step_looks()) {
    const float line = ImGui::GetTextLineHeight();
    const float width = 1.1f * em() + ImGui::CalcTextSize(look.label).x;
    if (!first) ImGui::SameLine(0, 1.1f * em());
    if (!first && ImGui::GetCursorScreenPos().x + width > end) ImGui::NewLine();
    first = false;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({at.x, std::floor(at.y + 0.2f * line)},
                       {at.x + 0.7f * em(), std::floor(at.y + 0.2f * line) + 0.7f * em()},
                       look.color, 2.0f);
    list.AddText({at.x + em(), at.y}, ImGui::GetColorU32(ImGuiCol_Text), look.label);
    ImGui::Dummy({width, line});
    mark(std::string("legend/") + look.label);
    tooltip(look.help);
  }
}

}  // namespace ui
