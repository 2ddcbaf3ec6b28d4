// Draws the rows that are on the screen, and does what is clicked there.
#include "ui/tree_list.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tracer/choice.h"
#include "ui/long_scrollbar.h"
#include "ui/registry.h"
#include "ui/tree_menu.h"

namespace ui {
namespace {

using tracer::NodeMeasureRow;
using tracer::TreeFacts;

constexpr ImU32 lit_color = IM_COL32(90, 230, 255, 60);  // as the hovered box in the viewport
constexpr ImU32 share_color = IM_COL32(90, 150, 220, 70);

// One row, with what the panel knows of it.
struct Row {
  size_t at;           // in TreeRows
  uint32_t node;       // or the leaf that the reference is in
  uint32_t reference;  // triangle or instance; none: the row is a node
  uint32_t place;      // of the reference, in TreeTable
  const TreeFacts& facts;
  bool current;

  bool is_node() const { return reference == tracer::none; }
};

NodePlace place_of(const Frame& frame, const Row& row) {
  return {frame.state.tree.mesh, row.node};
}

std::vector<const NodeMeasureRow*> columns_of(const TreeState& state) {
  std::vector<const NodeMeasureRow*> columns;
  for (const std::string& id : state.columns) {
    if (const NodeMeasureRow* row = tracer::find_row(tracer::node_measures(), id)) {
      columns.push_back(row);
    }
  }
  return columns;
}

std::string row_name(const Frame& frame, const Row& row) {
  if (row.is_node()) return node_name(*row.facts.table, row.node);
  if (row.facts.table->tlas) return entry_name(frame, *row.facts.table, row.place);
  return fmt::format("triangle {}", row.reference);
}

bool is_selected(const Frame& frame, const Row& row) {
  const Selection& selection = frame.state.selection;
  if (!row.current) return false;
  if (row.is_node()) return selection.node == place_of(frame, row);
  if (row.facts.table->tlas) return selection.instance == row.reference;
  return selection.triangle == row.reference &&
         instance_of(frame, frame.state.tree.mesh) == selection.instance;
}

bool is_row_lit(const Frame& frame, const Row& row) {
  if (!row.current) return false;
  const UiState& state = frame.state;
  if (row.is_node()) return is_lit(state, place_of(frame, row));
  const bool now = state.hovered.instance != tracer::none;
  const Selection& hovered = now ? state.hovered : state.was_hovered;
  if (row.facts.table->tlas) return hovered.instance == row.reference && !hovered.node;
  return hovered.triangle == row.reference;
}

void set_open(Frame& frame, const Row& row, bool open) {
  TreeState& state = frame.state.tree;
  if (open) {
    open_row(state.rows, row.facts, sibling_order(state), row.at);
  } else {
    close_row(state.rows, row.facts, row.at);
  }
}

void click(Frame& frame, const Row& row, bool twice) {
  if (!row.current) return;
  TreeState& state = frame.state.tree;
  if (row.is_node()) {
    select_node(frame, place_of(frame, row));
    if (twice) set_open(frame, row, !state.rows.open[row.node]);
  } else if (!row.facts.table->tlas) {
    select_triangle(frame, state.mesh, row.reference);
  } else if (twice) {
    go_into(frame, row.reference);
  } else {
    select_instance(frame, row.reference);
  }
  state.revealed = frame.state.selection;  // the list stays where it is
}

void hover(Frame& frame, const Row& row) {
  if (!row.current) return;
  Selection& hovered = frame.state.hovered;
  if (row.is_node()) {
    hover_node(frame, place_of(frame, row));
  } else if (row.facts.table->tlas) {
    hovered.instance = row.reference;
  } else {
    hovered.instance = instance_of(frame, frame.state.tree.mesh);
    hovered.triangle = row.reference;
  }
}

std::string help_of(const Frame& frame, const Row& row) {
  if (row.is_node()) {
    return node_text(frame, row.facts, place_of(frame, row)) +
           "\nA click selects it, a double click opens it, a right click has more.";
  }
  if (row.facts.table->tlas) {
    return "A click selects the instance, a double click goes into the tree of its mesh.";
  }
  return "A click selects the triangle.";
}

void draw_arrow(ImDrawList& list, ImVec2 middle, float size, bool open) {
  const ImU32 color = ImGui::GetColorU32(ImGuiCol_Text);
  if (open) {
    list.AddTriangleFilled({middle.x - size, middle.y - 0.6f * size},
                           {middle.x + size, middle.y - 0.6f * size},
                           {middle.x, middle.y + 0.8f * size}, color);
  } else {
    list.AddTriangleFilled({middle.x - 0.6f * size, middle.y - size},
                           {middle.x + 0.8f * size, middle.y},
                           {middle.x - 0.6f * size, middle.y + size}, color);
  }
}

ImU32 text_color(const Frame& frame, const Row& row) {
  const NodePlace place = place_of(frame, row);
  const BoxFilter& filter = frame.state.box_filter;
  if (row.is_node() && is_hidden(filter, place)) {
    return ImGui::GetColorU32(ImGuiCol_TextDisabled);
  }
  if (row.is_node() && filter.isolated == place) return IM_COL32(90, 230, 255, 255);
  const bool leaf = !row.is_node() || is_leaf(row.facts.table->nodes[row.node]);
  return leaf ? IM_COL32(170, 210, 150, 255) : ImGui::GetColorU32(ImGuiCol_Text);
}

// The first cell: indent, arrow, name. The whole line is one item.
void draw_name(Frame& frame, const Row& row, float indent) {
  TreeState& state = frame.state.tree;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float line = ImGui::GetTextLineHeight();
  const ImVec2 arrow_lo = {at.x + indent, at.y}, arrow_hi = {arrow_lo.x + line, at.y + line};
  const ImGuiSelectableFlags flags =
      ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowDoubleClick;
  const bool pressed = ImGui::Selectable("##row", is_selected(frame, row), flags);
  mark("row");
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (ImGui::IsItemHovered()) hover(frame, row);
  const bool on_arrow = row.is_node() && mouse.x >= arrow_lo.x && mouse.x < arrow_hi.x;
  const bool open = row.is_node() && state.rows.open[row.node];
  const bool asked = ImGui::IsItemClicked(ImGuiMouseButton_Right);
  if (!on_arrow) tooltip(help_of(frame, row));
  if (is_row_lit(frame, row)) ImGui::TableSetBgColor(ImGuiTableBgTarget_RowBg1, lit_color);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (row.is_node()) {
    draw_arrow(list, {arrow_lo.x + 0.5f * line, at.y + 0.5f * line}, 0.26f * line, open);
    mark("arrow", arrow_lo, arrow_hi);
  }
  const std::string name = row_name(frame, row);
  list.AddText({arrow_hi.x + 0.2f * em(), at.y}, text_color(frame, row), name.c_str());
  if (pressed && on_arrow) {
    set_open(frame, row, !open);
  } else if (pressed) {
    click(frame, row, ImGui::IsMouseDoubleClicked(0));
  }
  if (asked) state.menu_row = state.rows.rows[row.at];
}

void draw_value(const NodeMeasureRow& measure, const TreeFacts& facts, uint32_t node) {
  const double value = measure.value(facts, node);
  const std::string text = std::isnan(value) ? std::string("-") : measure_text(measure, value);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float room = ImGui::GetContentRegionAvail().x;
  if (measure.unit == "%" && value > 0.0) {
    const float width = room * static_cast<float>(std::min(0.01 * value, 1.0));
    ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + width, at.y + ImGui::GetTextLineHeight()},
                                              share_color, 2.0f);
  }
  const float width = ImGui::CalcTextSize(text.c_str()).x;
  ImGui::SetCursorScreenPos({at.x + std::max(room - width, 0.0f), at.y});
  cell_text(text);
}

// Where the deepest row on the screen would be too far to the right, all begin further left.
float indent_of(const TreeState& state, const TreeFacts& facts, size_t begin, size_t end,
                uint32_t& base) {
  uint32_t least = 255, most = 0;
  for (size_t i = begin; i < end; ++i) {
    const uint32_t row = state.rows.rows[i];
    if (is_reference(row)) continue;
    const uint32_t depth = facts.table->nodes[row].depth;
    least = std::min(least, depth);
    most = std::max(most, depth + 1u);
  }
  base = most > 10 && least < 255 ? least : 0;
  return std::min(0.7f * em(), 3.0f * em() / static_cast<float>(std::max(most - base, 1u)));
}

void draw_rows(Frame& frame, const TreeFacts& facts, bool current, size_t count) {
  TreeState& state = frame.state.tree;
  const std::vector<const NodeMeasureRow*> columns = columns_of(state);
  const auto begin = static_cast<size_t>(state.top);
  // What is on the screen by now: a click may open or close a row while it is drawn.
  const size_t end = std::min(begin + count, state.rows.rows.size());
  const std::vector<uint32_t> shown(state.rows.rows.begin() + static_cast<std::ptrdiff_t>(begin),
                                    state.rows.rows.begin() + static_cast<std::ptrdiff_t>(end));
  if (shown.empty()) return;
  uint32_t base = 0;
  const float step = indent_of(state, facts, begin, end, base);
  uint32_t node = node_of_row(state.rows, begin);
  for (size_t i = 0; i < shown.size(); ++i) {
    const bool reference = is_reference(shown[i]);
    if (!reference) node = shown[i];
    const uint32_t place = reference ? reference_place(shown[i]) : 0;
    const uint32_t id = reference ? facts.table->references[place] : tracer::none;
    const Row row{begin + i, node, id, place, facts, current};
    ImGui::PushID(static_cast<int>(shown[i]));
    {
      const Scope scope(reference
                            ? fmt::format("{} {}", facts.table->tlas ? "instance" : "triangle", id)
                            : fmt::format("node {}", node));
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      const uint32_t depth = facts.table->nodes[node].depth + (reference ? 1u : 0u);
      draw_name(frame, row, step * static_cast<float>(depth - std::min(base, depth)));
      for (const NodeMeasureRow* measure : columns) {
        if (ImGui::TableNextColumn() && row.is_node()) draw_value(*measure, facts, node);
      }
    }
    ImGui::PopID();
  }
}

// A click orders siblings by the column, another one the other way round, a third one as in the
// tree.
void draw_header(TreeState& state, const NodeMeasureRow& measure) {
  const Scope scope("column");
  const bool sorted = state.sort == measure.id;
  const std::string name = measure_label(measure, *state.table);
  ImGui::TableHeader((name + (sorted ? "   " : "")).c_str());
  mark(measure.id);
  if (!measure.help.empty()) explain_column();
  const bool clicked = ImGui::IsItemClicked(ImGuiMouseButton_Left);
  tooltip(fmt::format("{}: {}{}\n\nA click orders siblings by it.", name, measure.help,
                      measure.unit.empty() ? "" : fmt::format(" ({})", measure.unit)));
  if (sorted) {
    const ImVec2 lo = ImGui::GetItemRectMin();
    const float line = ImGui::GetTextLineHeight();
    const float x = lo.x + ImGui::CalcTextSize(name.c_str()).x + 0.6f * em();
    const float size = 0.22f * em(), y = lo.y + 0.5f * line;
    const float sign = state.descending ? 1.0f : -1.0f;
    ImGui::GetWindowDrawList()->AddTriangleFilled(
        {x - size, y - 0.6f * sign * size}, {x + size, y - 0.6f * sign * size},
        {x, y + sign * size}, ImGui::GetColorU32(ImGuiCol_Text));
  }
  if (!clicked) return;
  if (!sorted) {
    state.sort = measure.id;
    state.descending = true;
  } else if (state.descending) {
    state.descending = false;
  } else {
    state.sort.clear();
  }
  if (state.figures.facts().table == state.table.get()) {
    sort_rows(state.rows, state.figures.facts(), sibling_order(state));
  }
}

void draw_headers(TreeState& state, const std::vector<const NodeMeasureRow*>& columns) {
  ImGui::TableSetupScrollFreeze(1, 0);
  ImGui::TableSetupColumn("Node", ImGuiTableColumnFlags_WidthFixed, 9.2f * em());
  for (const NodeMeasureRow* measure : columns) {
    const std::string label = measure_label(*measure, *state.table);
    const float width = std::max(ImGui::CalcTextSize(label.c_str()).x + 1.1f * em(), 4.1f * em());
    ImGui::TableSetupColumn(label.c_str(), ImGuiTableColumnFlags_WidthFixed, width);
  }
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  ImGui::TableNextColumn();
  ImGui::TableHeader("Node");
  tooltip("Nodes by their index in the tree, and below each leaf what it refers to");
  for (const NodeMeasureRow* measure : columns) {
    ImGui::PushID(measure);
    if (ImGui::TableNextColumn()) draw_header(state, *measure);
    ImGui::PopID();
  }
}

}  // namespace

SiblingOrder sibling_order(const TreeState& state) {
  return {tracer::find_row(tracer::node_measures(), state.sort), state.descending};
}

void show_tree(TreeState& state, uint32_t mesh) {
  state.mesh = mesh;
  state.top = 0.0;
  state.search.answer.clear();
  state.search.leaves.clear();
}

std::string node_text(const Frame& frame, const TreeFacts& facts, const NodePlace& place) {
  std::string text =
      fmt::format("{} of {}\n", node_name(*facts.table, place.node), tree_name(frame, place.mesh));
  for (const NodeMeasureRow& measure : tracer::node_measures()) {
    const double value = measure.value(facts, place.node);
    if (measure.id == "kind" || std::isnan(value)) continue;
    text +=
        fmt::format("{}: {}\n", measure_label(measure, *facts.table), measure_text(measure, value));
  }
  return text;
}

void draw_tree_list(Frame& frame, bool current) {
  TreeState& state = frame.state.tree;
  const TreeFacts& facts = state.figures.facts();
  const std::vector<const NodeMeasureRow*> columns = columns_of(state);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 area = ImGui::GetContentRegionAvail();
  const float bar = ImGui::GetStyle().ScrollbarSize;
  const float padding = ImGui::GetStyle().CellPadding.y;
  const float line = ImGui::GetTextLineHeight() + 2.0f * padding;
  const ImVec2 size = {std::max(area.x - bar - 2.0f, 1.0f), std::max(area.y, 4.0f * line)};
  const float room = size.y - line - ImGui::GetStyle().ScrollbarSize - 2.0f;
  state.page = std::max(std::floor(static_cast<double>(room / line)), 1.0);
  const auto rows = static_cast<double>(state.rows.rows.size());
  state.top = std::clamp(state.top, 0.0, std::max(rows - state.page, 0.0));
  state.menu_row = ImGui::IsPopupOpen("row menu") ? state.menu_row : tracer::none;
  const uint32_t menu_before = state.menu_row;
  const ImGuiTableFlags flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollX |
                                ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_Resizable |
                                ImGuiTableFlags_BordersInnerV;
  if (!current) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.5f);
  if (ImGui::BeginTable("nodes", 1 + static_cast<int>(columns.size()), flags, size)) {
    draw_headers(state, columns);
    draw_rows(frame, facts, current, static_cast<size_t>(state.page));
    ImGui::EndTable();
  }
  if (!current) ImGui::PopStyleVar();
  const LongList list{rows, state.page, at, {at.x + area.x, at.y + size.y}};
  long_scrollbar("Rows", state.top, list, {at.x + size.x + 2.0f, at.y}, {bar, size.y},
                 "Which part of the list is shown; the mouse wheel turns it, too");
  if (state.menu_row != menu_before) ImGui::OpenPopup("row menu");
  draw_tree_menu(frame, facts, current);
}

}  // namespace ui
