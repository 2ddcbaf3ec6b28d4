// The table of the Builders panel.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <imgui.h>

#include "ui/comparison.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::BuildState;
using tracer::ComparedBuild;

std::string state_text(const Frame& frame, const ComparedBuild& row) {
  if (row.state == BuildState::failed) return row.error;
  if (row.state == BuildState::done) return "";
  if (frame.work.comparison.running) return "waiting";
  const std::string& error = frame.work.comparison.error;
  return error.empty() ? "stopped before it was measured" : error;
}

constexpr int name_column = 1;  // after the one with the buttons
constexpr int first_figure = 2;
int predicted_column() {
  return first_figure + static_cast<int>(tracer::comparison_columns().size());
}

double value_of(const ComparedBuild& row, int column, const ComparableRows& comparable) {
  if (column == predicted_column()) {
    return predicted_cost(comparable, row);
  }
  return tracer::comparison_columns()[column - first_figure].value(row);
}

// Rows by the chosen column; those without figures come last.
std::vector<size_t> sorted(const BuildersState& state, const ComparableRows& comparable) {
  std::vector<size_t> order(state.rows.size());
  std::iota(order.begin(), order.end(), size_t{0});
  const ImGuiTableSortSpecs* specs = ImGui::TableGetSortSpecs();
  if (specs == nullptr || specs->SpecsCount == 0) return order;
  const int column = specs->Specs[0].ColumnIndex;
  const bool down = specs->Specs[0].SortDirection == ImGuiSortDirection_Descending;
  const auto less = [&](size_t a, size_t b) {
    const ComparedBuild &x = state.rows[a], &y = state.rows[b];
    const bool known_x = x.state == BuildState::done, known_y = y.state == BuildState::done;
    if (column == name_column) {
      return down ? describe(y.options) < describe(x.options)
                  : describe(x.options) < describe(y.options);
    }
    if (known_x != known_y) return known_x;
    if (!known_x) return false;
    const double value_x = value_of(x, column, comparable),
                 value_y = value_of(y, column, comparable);
    return down ? value_y < value_x : value_x < value_y;
  };
  std::stable_sort(order.begin(), order.end(), less);
  return order;
}

void number(const std::string& text) {
  const float width = ImGui::CalcTextSize(text.c_str()).x;
  const float room = ImGui::GetContentRegionAvail().x;
  if (width < room) ImGui::SetCursorPosX(std::floor(ImGui::GetCursorPosX() + room - width));
  ImGui::TextUnformatted(text.c_str());
}

std::string cell_text(double value, int decimals) {
  return decimals == 0 ? grouped(static_cast<uint64_t>(value))
                       : fmt::format("{:.{}f}", value, decimals);
}

void draw_figures(const ComparedBuild& row, const ComparableRows& comparable, bool is_comparable) {
  for (const tracer::ComparisonColumn& column : tracer::comparison_columns()) {
    ImGui::TableNextColumn();
    number(cell_text(column.value(row), column.decimals));
    if (column.id == "epo") {
      tooltip(fmt::format("{:.4f} \u00b1 {:.4f} (one standard error)", row.epo,
                          row.epo_standard_error));
    } else if (column.id == "build_ms") {
      tooltip(fmt::format("{:.3f} ms, the median of {} builds", row.build_ms, row.builds));
    } else {
      tooltip(fmt::format("{} {}", column.value(row), column.unit));
    }
  }
  ImGui::TableNextColumn();
  if (comparable.blend && is_comparable) {
    number(fmt::format("{:.2f}", value_of(row, predicted_column(), comparable)));
  }
}

// False if the row is to be removed.
bool draw_row(Frame& frame, size_t index, const ComparableRows& comparable, int& under) {
  BuildersState& state = frame.state.builders;
  const ComparedBuild& row = state.rows[index];
  const std::string name = describe(row.options);
  const Scope scope(name);
  const auto place = std::find(comparable.rows.begin(), comparable.rows.end(), index);
  const bool is_comparable = place != comparable.rows.end();
  const bool front = is_comparable && comparable.front[place - comparable.rows.begin()];
  const bool present = row.options == frame.edited.settings.build;
  ImGui::TableNextRow();
  if (state.hovered == static_cast<int>(index)) {
    ImGui::TableSetBgColor(ImGuiTableBgTarget_RowBg1, ImGui::GetColorU32(ImGuiCol_HeaderHovered));
  }
  ImGui::TableNextColumn();
  const bool remove = ImGui::SmallButton("x");
  mark("Remove");
  tooltip("Remove this row");
  ImGui::TableNextColumn();
  if (front) ImGui::PushStyleColor(ImGuiCol_Text, {1.0f, 0.78f, 0.24f, 1.0f});
  const bool clicked = ImGui::Selectable(
      name.c_str(), present,
      ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowItemOverlap);
  if (front) ImGui::PopStyleColor();
  mark("row");
  if (ImGui::IsItemHovered()) under = static_cast<int>(index);
  if (clicked) use_options(frame, row);
  if (ImGui::IsItemHovered() &&
      ImGui::TableGetColumnFlags(name_column) & ImGuiTableColumnFlags_IsHovered) {
    tooltip(std::string(present ? "The present options."
                                : "A click builds the scene with these options.") +
            (front ? " No other build is better in both build time and cost." : ""));
  }
  if (row.state == BuildState::done) {
    if (!is_comparable) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.45f);
    draw_figures(row, comparable, is_comparable);
    if (!is_comparable) ImGui::PopStyleVar();
  } else {
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", state_text(frame, row).c_str());
    mark("state");
  }
  return !remove;
}

void draw_headers() {
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  const auto header = [](std::string_view label, std::string_view help) {
    ImGui::TableNextColumn();
    ImGui::TableHeader(std::string(label).c_str());
    mark(label);
    tooltip(help);
  };
  const Scope scope("header");
  ImGui::TableNextColumn();
  header(
      "Build options",
      "Builder, optimizer, and what is not as by default. Bright: on the Pareto front, that is no "
      "other build is better in both build time and cost");
  for (const tracer::ComparisonColumn& column : tracer::comparison_columns()) {
    header(column.unit.empty() ? std::string(column.label)
                               : fmt::format("{} {}", column.label, column.unit),
           column.help);
  }
  header("Predicted", blend_help);
}

}  // namespace

int draw_comparison_table(Frame& frame, const ComparableRows& comparable, ImVec2 size) {
  int under = -1;
  BuildersState& state = frame.state.builders;
  const ImGuiTableFlags flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV |
                                ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_ScrollX |
                                ImGuiTableFlags_ScrollY | ImGuiTableFlags_Sortable |
                                ImGuiTableFlags_SortTristate;
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, ImVec2(0.25f * em(), 0.1f * em()));
  const bool open = ImGui::BeginTable("builds", predicted_column() + 1, flags, size);
  ImGui::PopStyleVar();
  if (!open) return under;
  ImGui::TableSetupScrollFreeze(first_figure, 1);
  ImGui::TableSetupColumn("remove", ImGuiTableColumnFlags_NoSort);
  ImGui::TableSetupColumn("name");
  for (int i = first_figure; i <= predicted_column(); ++i)
    ImGui::TableSetupColumn(std::to_string(i).c_str());
  draw_headers();
  std::optional<size_t> removed;
  for (const size_t index : sorted(state, comparable)) {
    if (!draw_row(frame, index, comparable, under)) removed = index;
  }
  ImGui::EndTable();
  if (removed) state.rows.erase(state.rows.begin() + static_cast<std::ptrdiff_t>(*removed));
  return under;
}

}  // namespace ui
