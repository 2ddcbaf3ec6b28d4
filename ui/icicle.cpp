#include "ui/icicle.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "ui/node_words.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::Icicle;
using tracer::IcicleCell;
using tracer::IcicleLevel;

constexpr ImU32 bright = IM_COL32(255, 200, 60, 255);
constexpr ImU32 pale = IM_COL32(255, 255, 255, 200);
constexpr float least_gap = 4.0f;  // pixels: wider cells have a line between them
constexpr double least_part = 256.0 / tracer::icicle_width;  // that can be zoomed to

struct Canvas {
  ImVec2 lo, size;
  float row;     // height of a level
  float scroll;  // pixels that are above the upper border
};

float top_of(const Canvas& canvas, size_t level) {
  return std::floor(canvas.lo.y - canvas.scroll + canvas.row * static_cast<float>(level));
}

void show_part(IcicleState& state, double from, double to) {
  const double length = std::clamp(to - from, least_part, 1.0);
  state.from = std::clamp(0.5 * (from + to - length), 0.0, 1.0 - length);
  state.to = state.from + length;
}

void keep_cells(IcicleState& state, const std::shared_ptr<const Icicle>& icicle, int pixels) {
  if (state.cells_of == icicle && state.cells_from == state.from && state.cells_to == state.to &&
      state.cells_pixels == pixels) {
    return;
  }
  state.cells_of = icicle;
  state.cells_from = state.from;
  state.cells_to = state.to;
  state.cells_pixels = pixels;
  state.cells.resize(icicle->levels.size());
  for (size_t i = 0; i < icicle->levels.size(); ++i)
    state.cells[i] = tracer::icicle_cells(*icicle, i, state.from, state.to, pixels);
}

void draw_level(const Canvas& canvas, const IcicleLevel& level, size_t index,
                const std::vector<IcicleCell>& cells, const tracer::MeasureColors& colors,
                float alpha) {
  if (cells.empty()) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float top = top_of(canvas, index);
  const float bottom = top_of(canvas, index + 1) - (canvas.row >= 4.0f ? 1.0f : 0.0f);
  const ImU32 mask = static_cast<ImU32>(alpha * 255.0f) << 24 | 0xffffffu;
  const int count = static_cast<int>(cells.size());
  list.PrimReserve(6 * count, 4 * count);
  int drawn = 0;
  for (size_t i = 0; i < cells.size(); ++drawn) {
    const ImU32 color = colors(level.values[cells[i].place]) & mask;
    const float x0 = cells[i].x0;
    float x1 = cells[i].x1;
    // Columns of one colour are one rectangle: what is drawn costs more than looking for them.
    const bool gap = x1 - x0 >= least_gap;
    for (++i; !gap && i < cells.size() && cells[i].x0 <= x1; ++i) {
      if (cells[i].x1 - cells[i].x0 >= least_gap) break;
      if ((colors(level.values[cells[i].place]) & mask) != color) break;
      x1 = cells[i].x1;
    }
    list.PrimRect({canvas.lo.x + x0, top}, {canvas.lo.x + x1 - (gap ? 1.0f : 0.0f), bottom}, color);
  }
  list.PrimUnreserve(6 * (count - drawn), 4 * (count - drawn));
}

// The rectangle of a node; nothing if it is outside of what is shown.
std::optional<Item> rectangle(const Canvas& canvas, const Icicle& icicle, const IcicleState& state,
                              uint32_t node) {
  const std::optional<uint32_t> place = tracer::icicle_place(icicle, node);
  if (!place) return {};
  const auto& table = *tracer::table_of(*icicle.inspection, icicle.options.mesh);
  const size_t depth = table.nodes[node].depth;
  const IcicleLevel& level = icicle.levels[depth];
  const auto x = [&](uint32_t at) {
    const double part = (at / tracer::icicle_width - state.from) / (state.to - state.from);
    return static_cast<float>(part * static_cast<double>(canvas.size.x));
  };
  const float x0 = std::max(x(level.begin[*place]), 0.0f);
  const float x1 = std::min(x(level.end[*place]), canvas.size.x);
  if (x1 < 0.0f || x0 > canvas.size.x) return {};
  Item item;
  item.lo = {canvas.lo.x + x0, top_of(canvas, depth)};
  item.hi = {canvas.lo.x + std::max(x1, x0 + 1.0f), top_of(canvas, depth + 1)};
  return item;
}

void outline(const Canvas& canvas, const Icicle& icicle, const IcicleState& state, uint32_t node,
             ImU32 color, float width) {
  const std::optional<Item> item = rectangle(canvas, icicle, state, node);
  if (!item) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRect(item->lo, item->hi, IM_COL32(0, 0, 0, 200), 0.0f, 0, width + 2.0f);
  list.AddRect(item->lo, item->hi, color, 0.0f, 0, width);
}

bool is_shown(const Icicle& icicle, const std::optional<NodePlace>& place) {
  if (!place || place->mesh != icicle.options.mesh) return false;
  const auto* table = tracer::table_of(*icicle.inspection, place->mesh);
  return table != nullptr && place->node < table->nodes.size();
}

void draw_marks(const Frame& frame, const Canvas& canvas, const Icicle& icicle) {
  const IcicleState& state = frame.state.icicle;
  const auto& selected = frame.state.selection.node;
  if (is_shown(icicle, selected)) {
    const auto& table = *tracer::table_of(*icicle.inspection, selected->mesh);
    for (const uint32_t node : tracer::path_to(table, selected->node)) {
      const bool itself = node == selected->node;
      outline(canvas, icicle, state, node, itself ? bright : pale, itself ? 2.0f : 1.0f);
    }
    if (const auto item = rectangle(canvas, icicle, state, selected->node)) {
      mark("selected", item->lo, item->hi);
    }
  }
  const auto& hovered = frame.state.hovered.node;
  if (is_shown(icicle, hovered)) {
    outline(canvas, icicle, state, hovered->node, IM_COL32_WHITE, 1.0f);
  }
}

// The cell under the mouse, and in which level.
struct Under {
  size_t level = 0;
  IcicleCell cell;
};
std::optional<Under> under_mouse(const Canvas& canvas, const IcicleState& state) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const float row = (mouse.y - canvas.lo.y + canvas.scroll) / canvas.row;
  if (!(row >= 0.0f) || row >= static_cast<float>(state.cells.size())) return {};
  const auto level = static_cast<size_t>(row);
  const std::vector<IcicleCell>& cells = state.cells[level];
  const float x = mouse.x - canvas.lo.x;
  auto after = std::partition_point(cells.begin(), cells.end(),
                                    [&](const IcicleCell& cell) { return cell.x0 <= x; });
  // A column that stands for many nodes may reach into the cell beside it.
  for (int i = 0; i < 2 && after != cells.begin(); ++i) {
    --after;
    if (x < after->x1) return Under{level, *after};
  }
  return {};
}

void zoom(IcicleState& state, const Canvas& canvas, float steps) {
  const double length = state.to - state.from;
  const double part = std::clamp(
      static_cast<double>((ImGui::GetIO().MousePos.x - canvas.lo.x) / canvas.size.x), 0.0, 1.0);
  const double at = state.from + part * length;
  const double next =
      std::clamp(length * std::pow(0.8, static_cast<double>(steps)), least_part, 1.0);
  const double from = std::clamp(at - part * next, 0.0, 1.0 - next);
  state.from = from;
  state.to = from + next;
}

void pan(IcicleState& state, const Canvas& canvas, float most_scroll) {
  const ImVec2 moved = ImGui::GetIO().MouseDelta;
  const ImVec2 all = ImGui::GetMouseDragDelta(0, 3.0f);
  if (all.x == 0.0f && all.y == 0.0f) return;
  state.dragged = true;
  const double length = state.to - state.from;
  const double step = -static_cast<double>(moved.x / canvas.size.x) * length;
  state.from = std::clamp(state.from + step, 0.0, 1.0 - length);
  state.to = state.from + length;
  state.scroll = std::clamp(state.scroll - moved.y, 0.0f, most_scroll);
}

void use_mouse(Frame& frame, const Icicle& icicle, const Canvas& canvas, float most_scroll) {
  IcicleState& state = frame.state.icicle;
  if (ImGui::IsItemActivated()) state.dragged = false;
  if (ImGui::IsItemActive()) pan(state, canvas, most_scroll);
  const bool released = ImGui::IsItemDeactivated() && !state.dragged;
  if (!ImGui::IsItemHovered()) return;
  if (ImGui::GetIO().MouseWheel != 0.0f) zoom(state, canvas, ImGui::GetIO().MouseWheel);
  const std::optional<Under> under = under_mouse(canvas, state);
  if (!under || state.dragged) {
    if (!under) {
      tooltip(
          "A level below the other, the root on top. The wheel zooms, a drag moves, a click "
          "selects a node, a double click fills the width with it.");
    }
    return;
  }
  const IcicleLevel& level = icicle.levels[under->level];
  const NodePlace place{icicle.options.mesh, level.nodes[under->cell.place]};
  frame.state.hovered.node = place;
  if (ImGui::IsMouseDoubleClicked(0)) {
    const double begin = level.begin[under->cell.place] / tracer::icicle_width;
    const double end = level.end[under->cell.place] / tracer::icicle_width;
    show_part(state, begin, end);
    state.dragged = true;  // its release selects nothing new
    return;
  }
  if (released) choose_node(frame, place);
  std::string text = node_text(icicle, place.node);
  if (under->cell.count > 1) {
    text += fmt::format(
        "\n\nthe {} of {} nodes that share this column of pixels",
        icicle.measure->scale == tracer::MeasureScale::diverging ? "most extreme" : "largest",
        grouped(under->cell.count));
  }
  tooltip(fmt::format("{}\n\n{}: {}", text, icicle.measure->label, icicle.measure->help));
}

std::string value_text(double value, const tracer::NodeMeasureRow& measure) {
  if (std::isnan(value)) return "none";
  if (measure.scale == tracer::MeasureScale::category) return value > 0.5 ? "leaf" : "inner node";
  const std::string number = measure.digits == 0 ? grouped(static_cast<uint64_t>(value))
                                                 : fmt::format("{:.{}f}", value, measure.digits);
  return measure.unit.empty() ? number : fmt::format("{} {}", number, measure.unit);
}

}  // namespace

void choose_node(Frame& frame, const NodePlace& place) {
  select_node(frame, place);
  frame.state.icicle.selected = place;  // chosen here: the tree is already shown
}

std::string node_text(const Icicle& icicle, uint32_t node) {
  const uint32_t mesh = icicle.options.mesh;
  const auto& table = *tracer::table_of(*icicle.inspection, mesh);
  node = holder(table, node);
  const tracer::TableNode& row = table.nodes[node];
  const size_t place = tracer::icicle_place(icicle, node).value_or(0);
  const double value = double(icicle.levels[row.depth].values[place]);
  return fmt::format("node {} of {}, {}\nlevel {}\n{}: {}\n{}: {}", node,
                     mesh == tracer::none ? "the TLAS" : fmt::format("mesh {}", mesh),
                     tracer::is_leaf(row) ? "a leaf" : "an inner node", row.depth,
                     references_name(table), grouped(row.references), icicle.measure->label,
                     value_text(value, *icicle.measure));
}

void draw_icicle_cells(Frame& frame, const std::shared_ptr<const Icicle>& icicle, ImVec2 size,
                       bool stale) {
  IcicleState& state = frame.state.icicle;
  const int pixels = std::max(static_cast<int>(size.x), 1);
  Canvas canvas;
  canvas.lo = ImGui::GetCursorScreenPos();
  canvas.lo = {std::floor(canvas.lo.x), std::floor(canvas.lo.y)};
  canvas.size = {static_cast<float>(pixels), std::max(std::floor(size.y), 1.0f)};
  const auto levels = static_cast<float>(icicle->levels.size());
  canvas.row = std::clamp(canvas.size.y / levels, 2.0f, 1.6f * em());
  const float most_scroll = std::max(levels * canvas.row - canvas.size.y, 0.0f);
  state.scroll = std::clamp(state.scroll, 0.0f, most_scroll);
  canvas.scroll = state.scroll;

  ImGui::InvisibleButton("cells", canvas.size);
  mark("cells");
  keep_cells(state, icicle, pixels);
  if (!stale) use_mouse(frame, *icicle, canvas, most_scroll);
  keep_cells(state, icicle, pixels);

  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 hi = {canvas.lo.x + canvas.size.x, canvas.lo.y + canvas.size.y};
  list.AddRectFilled(canvas.lo, hi, IM_COL32(14, 15, 17, 255));
  list.PushClipRect(canvas.lo, hi, true);
  const tracer::MeasureColors colors(icicle->measure->scale, icicle->range, state.logarithmic,
                                     tracer::counts(*icicle->measure));
  for (size_t i = 0; i < icicle->levels.size(); ++i) {
    draw_level(canvas, icicle->levels[i], i, state.cells[i], colors, stale ? 0.4f : 1.0f);
  }
  if (!stale) draw_marks(frame, canvas, *icicle);
  list.PopClipRect();
}

void draw_color_scale(const char* label, const Icicle& icicle, bool logarithmic, ImVec2 size,
                      const char* help) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton(label, size);
  mark(label);
  tooltip(help);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const tracer::MeasureScale scale = icicle.measure->scale;
  const tracer::MeasureColors colors(scale, icicle.range, logarithmic,
                                     tracer::counts(*icicle.measure));
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text);
  const float bar = 0.9f * em();
  if (scale == tracer::MeasureScale::category) {
    const char* names[] = {"inner", "leaf"};
    for (int i = 0; i < 2; ++i) {
      const float y = at.y + 1.4f * em() * static_cast<float>(i);
      list.AddRectFilled({at.x, y}, {at.x + bar, y + em()}, colors(static_cast<float>(i)));
      list.AddText({at.x + bar + 0.4f * em(), y}, ink, names[i]);
    }
    return;
  }
  const tracer::ValueScale values(icicle.range,
                                  logarithmic && scale == tracer::MeasureScale::sequential,
                                  tracer::counts(*icicle.measure));
  const float top = at.y + 0.5f * em(), bottom = at.y + size.y - 0.5f * em();
  const int steps = std::clamp(static_cast<int>(bottom - top), 2, 128);
  for (int i = 0; i < steps; ++i) {
    const float y0 = bottom - (bottom - top) * static_cast<float>(i) / static_cast<float>(steps);
    const float y1 =
        bottom - (bottom - top) * static_cast<float>(i + 1) / static_cast<float>(steps);
    const float part = (static_cast<float>(i) + 0.5f) / static_cast<float>(steps);
    list.AddRectFilled({at.x, std::floor(y1)}, {at.x + bar, std::floor(y0)},
                       colors(values.value(part)));
  }
  const int ticks = std::clamp(static_cast<int>((bottom - top) / (2.2f * em())), 1, 4);
  for (int i = 0; i <= ticks; ++i) {
    const float part = static_cast<float>(i) / static_cast<float>(ticks);
    const float y = std::floor(bottom - (bottom - top) * part);
    list.AddLine({at.x + bar, y}, {at.x + bar + 3.0f, y}, ink);
    const float value = values.value(part);
    const std::string text = short_number(static_cast<double>(std::abs(value) < 1e-6f ? 0 : value));
    list.AddText({at.x + bar + 0.4f * em(), std::floor(y - 0.5f * em())}, ink, text.c_str());
  }
}

}  // namespace ui
