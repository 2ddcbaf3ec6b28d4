// The curves of a node's split candidates, and the builders' choices.
#include "ui/node_splits.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "tracer/choice.h"
#include "ui/plot.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::NodeSplits;
using tracer::SplitChoice;
using tracer::SplitCurve;

constexpr ImU32 objects_color = IM_COL32(120, 190, 255, 255);
constexpr ImU32 space_color = IM_COL32(255, 170, 70, 255);
constexpr ImU32 leaf_color = IM_COL32(170, 210, 150, 200);
constexpr ImU32 tree_color = IM_COL32(255, 255, 255, 255);
constexpr std::array<ImU32, 5> builder_colors = {
    IM_COL32(230, 120, 200, 255), IM_COL32(170, 140, 255, 255), IM_COL32(110, 220, 120, 255),
    IM_COL32(255, 230, 90, 255), IM_COL32(255, 120, 90, 255)};
constexpr std::array<const char*, 3> axis_names = {"X", "Y", "Z"};

constexpr const char* curve_help =
    "Cost of splitting the node at each place of the axis, for a ray that enters it, with children "
    "counted as leaves: Ct + Ci (A(left) N(left) + A(right) N(right)) / A(node). Blue: triangles "
    "go whole to the side of their boxes' centres. Orange: those that the plane meets are cut, and "
    "count on both sides. Green line: the cost as a leaf, Ci N. White line: where the tree is "
    "split; dots: where the builders would split it.";

ImU32 color_of(const NodeSplits& splits, const SplitChoice& choice) {
  for (size_t i = 0; i < splits.builders.size(); ++i) {
    if (splits.builders[i].id == choice.id) return builder_colors[i % builder_colors.size()];
  }
  return tree_color;
}

struct Plot {
  ImVec2 lo, hi;
  double x_lo, x_hi;
  CostRange costs;

  float x(double at) const {
    return lo.x + static_cast<float>((at - x_lo) / (x_hi - x_lo)) * (hi.x - lo.x);
  }
  float y(double cost) const {
    return hi.y - static_cast<float>((cost - costs.lo) / (costs.hi - costs.lo)) * (hi.y - lo.y);
  }
};

// Without the places where a side is empty.
void draw_curve(ImDrawList& list, const Plot& plot, const SplitCurve& curve,
                const std::vector<double>& costs, ImU32 color) {
  std::vector<ImVec2> points;
  const auto flush = [&] {
    if (points.size() == 1) list.AddCircleFilled(points[0], 1.5f, color);
    list.AddPolyline(points.data(), static_cast<int>(points.size()), color, 0, 1.5f);
    points.clear();
  };
  for (size_t i = 0; i < costs.size(); ++i) {
    if (std::isnan(costs[i])) {
      flush();
    } else {
      points.emplace_back(plot.x(curve.at[i]), plot.y(costs[i]));
    }
  }
  flush();
}

void draw_axes(ImDrawList& list, const Plot& plot, int axis) {
  const ImU32 dim = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  const ImU32 grid = IM_COL32(255, 255, 255, 22);
  const float height = plot.hi.y - plot.lo.y, width = plot.hi.x - plot.lo.x;
  const double step = tick_step(plot.costs.hi - plot.costs.lo,
                                std::max(static_cast<int>(height / (1.2f * em())), 1));
  for (double tick = std::ceil(plot.costs.lo / step) * step; tick <= plot.costs.hi; tick += step) {
    const float y = std::floor(plot.y(tick)) + 0.5f;
    list.AddLine({plot.lo.x, y}, {plot.hi.x, y}, grid);
    const std::string text = short_number(tick);
    list.AddText({plot.lo.x - ImGui::CalcTextSize(text.c_str()).x - 0.3f * em(), y - 0.55f * em()},
                 dim, text.c_str());
  }
  const double places =
      tick_step(plot.x_hi - plot.x_lo, std::max(static_cast<int>(width / (5.0f * em())), 1));
  for (double tick = std::ceil(plot.x_lo / places) * places; tick <= plot.x_hi; tick += places) {
    const float x = std::floor(plot.x(tick)) + 0.5f;
    list.AddLine({x, plot.lo.y}, {x, plot.hi.y}, grid);
    const std::string text = short_number(std::abs(tick) < 1e-9 * places ? 0.0 : tick);
    const float half = 0.5f * ImGui::CalcTextSize(text.c_str()).x;
    list.AddText({std::floor(std::min(x - half, plot.hi.x - 2.0f * half)), plot.hi.y + 1.0f}, dim,
                 text.c_str());
  }
  list.AddText({plot.lo.x - 1.0f * em(), plot.hi.y + 1.0f}, ImGui::GetColorU32(ImGuiCol_Text),
               axis_names[static_cast<size_t>(axis)]);
}

void draw_choices(ImDrawList& list, const Plot& plot, const NodeSplits& splits, int axis,
                  std::string_view lit) {
  if (splits.tree.axis == axis) {
    const float x = std::floor(plot.x(splits.tree.at)) + 0.5f;
    list.AddLine({x, plot.lo.y}, {x, plot.hi.y}, tree_color, lit == splits.tree.id ? 2.5f : 1.3f);
  }
  for (const SplitChoice& choice : splits.builders) {
    if (choice.axis != axis || std::isnan(choice.cost)) continue;
    const ImVec2 at = {plot.x(choice.at), plot.y(std::min(choice.cost, plot.costs.hi))};
    const float radius = (lit == choice.id ? 0.4f : 0.24f) * em();
    list.AddCircleFilled(at, radius + 1.0f, IM_COL32(0, 0, 0, 200));
    list.AddCircleFilled(at, radius, color_of(splits, choice));
  }
}

std::string values_at(const SplitCurve& curve, int axis, size_t place) {
  const auto cost = [](double value) {
    return std::isnan(value) ? std::string("a side is empty") : short_number(value);
  };
  std::string text = fmt::format("{} = {}\nwhole: {}", axis_names[static_cast<size_t>(axis)],
                                 short_number(curve.at[place]), cost(curve.objects[place]));
  if (!curve.space.empty()) text += fmt::format("\ncut: {}", cost(curve.space[place]));
  return text;
}

void draw_axis_plot(const NodeSplits& splits, int axis, const CostRange& costs,
                    std::string_view lit) {
  const SplitCurve& curve = splits.axes[static_cast<size_t>(axis)];
  const std::string label = fmt::format("cost on {}", axis_names[static_cast<size_t>(axis)]);
  if (curve.at.empty()) {
    hint(fmt::format("{}: the box is flat there.", axis_names[static_cast<size_t>(axis)]));
    return;
  }
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size = {std::max(ImGui::GetContentRegionAvail().x, 8.0f * em()), 7.0f * em()};
  ImGui::InvisibleButton(label.c_str(), size);
  mark(label);
  const float room = ImGui::CalcTextSize(short_number(costs.hi).c_str()).x + 0.6f * em();
  const double step = curve.at.size() > 1 ? curve.at[1] - curve.at[0] : 1.0;
  const Plot plot = {{at.x + std::max(room, 2.5f * em()), at.y},
                     {at.x + size.x - 0.4f * em(), at.y + size.y - 1.3f * em()},
                     curve.at.front() - step,
                     curve.at.back() + step,
                     costs};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(plot.lo, plot.hi, ImGui::GetColorU32(ImGuiCol_FrameBg), 2.0f);
  draw_axes(list, plot, axis);
  list.PushClipRect(plot.lo, plot.hi, true);
  const float leaf = plot.y(splits.leaf_cost);
  list.AddLine({plot.lo.x, leaf}, {plot.hi.x, leaf}, leaf_color);
  draw_curve(list, plot, curve, curve.space, space_color);
  draw_curve(list, plot, curve, curve.objects, objects_color);
  draw_choices(list, plot, splits, axis, lit);
  if (ImGui::IsItemHovered()) {
    const float mouse = ImGui::GetIO().MousePos.x;
    const double under = plot.x_lo + (plot.x_hi - plot.x_lo) *
                                         static_cast<double>((mouse - plot.lo.x) /
                                                             std::max(plot.hi.x - plot.lo.x, 1.0f));
    const auto place =
        static_cast<size_t>(std::clamp(std::llround((under - curve.at.front()) / step), 0ll,
                                       static_cast<long long>(curve.at.size()) - 1));
    const float x = plot.x(curve.at[place]);
    list.AddLine({x, plot.lo.y}, {x, plot.hi.y}, IM_COL32(255, 255, 255, 60));
    tooltip(values_at(curve, axis, place) + "\n\n" + curve_help);
  }
  list.PopClipRect();
}

std::string plane_text(const SplitChoice& choice) {
  if (choice.leaf) return "a leaf";
  if (choice.children > 2) return fmt::format("{} children", choice.children);
  if (choice.axis < 0) return "no plane";
  return fmt::format("{} = {}{}", axis_names[static_cast<size_t>(choice.axis)],
                     short_number(choice.at), choice.space ? ", cut" : "");
}

std::string help_of(const NodeSplits& splits, const SplitChoice& choice) {
  std::string text;
  if (const auto* row = tracer::find_row(tracer::builders(), choice.id)) {
    text = fmt::format("{}: {}", row->label, row->help);
    if (choice.leaf && choice.axis >= 0 && !std::isnan(choice.cost)) {
      text += fmt::format(
          "\n\nIt makes a leaf of up to {} where no split is cheaper than {}; its best one is {} = "
          "{} for {}.",
          splits.max_leaf_size, short_number(splits.leaf_cost),
          axis_names[static_cast<size_t>(choice.axis)], short_number(choice.at),
          short_number(choice.cost));
    }
    if (choice.id == "sbvh") text += "\n\nIts budget for more references counts as unspent.";
  } else if (choice.leaf) {
    text = "The tree has a leaf here.";
  } else if (choice.children > 2) {
    text = fmt::format(
        "The node has {} children in this layout, told apart by several planes. Its cost is not "
        "that "
        "of one split.",
        choice.children);
  } else if (choice.axis < 0) {
    text =
        "The tree's own split. No plane of an axis tells its children apart: the builder "
        "clusters, or an optimizer has moved subtrees.";
  } else {
    text =
        "The tree's own split, recognised from its children. Of few triangles more than one "
        "axis may tell them apart.";
  }
  return text;
}

// What the lines of the plots are.
void draw_legend(bool cuts) {
  struct Entry {
    ImU32 color;
    const char* text;
  };
  for (const Entry& entry : {Entry{objects_color, "whole"}, Entry{space_color, "cut"},
                             Entry{leaf_color, "as a leaf"}, Entry{tree_color, "this tree"}}) {
    if (entry.color == space_color && !cuts) continue;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float y = std::floor(at.y + 0.55f * em());
    ImGui::GetWindowDrawList()->AddLine({at.x, y}, {at.x + em(), y}, entry.color, 2.0f);
    ImGui::SetCursorScreenPos({at.x + 1.3f * em(), at.y});
    text(entry.text, curve_help);
    ImGui::SameLine(0.0f, em());
  }
  ImGui::NewLine();
}

// Lights the builder's dot up while the mouse is over its row.
bool draw_choice(const NodeSplits& splits, const SplitChoice& choice, double best) {
  const Scope scope(choice.id);
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float line = ImGui::GetTextLineHeight();
  ImGui::Selectable("##row", false, ImGuiSelectableFlags_SpanAllColumns);
  mark("row");
  const bool hovered = ImGui::IsItemHovered();
  tooltip(help_of(splits, choice));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddCircleFilled({at.x + 0.4f * line, at.y + 0.5f * line}, 0.24f * em(),
                       color_of(splits, choice));
  const bool own = choice.id == splits.tree.id;
  const auto* row = tracer::find_row(tracer::builders(), choice.id);
  const std::string name = own || row == nullptr ? "this tree" : std::string(row->id);
  list.AddText({at.x + line, at.y}, ImGui::GetColorU32(ImGuiCol_Text), name.c_str());
  cell(plane_text(choice));
  const double cost = choice.leaf ? splits.leaf_cost : choice.cost;
  const bool known = !std::isnan(cost);
  cell(known ? short_number(cost) : "-");
  cell(known && best > 0.0 && choice.children == 2
           ? fmt::format("{:+.1f} %", 100.0 * (cost / best - 1.0))
           : "");
  const bool split = !choice.leaf && choice.left + choice.right > 0;
  cell(split ? fmt::format("{} + {}", grouped(choice.left), grouped(choice.right)) : "");
  return hovered;
}

struct Column {
  const char *label, *help;
};
constexpr Column columns[] = {
    {"Who", "The split that the tree has, and what each builder would have done with this node"},
    {"Plane", "Axis and coordinate; 'cut': triangles that it meets go to both sides in parts"},
    {"Cost", "Ct + Ci (A(left) N(left) + A(right) N(right)) / A(node), or Ci N of a leaf"},
    {"To best", "How much more it costs than the cheapest of them"},
    {"Sides", "Triangles or instances on the left and on the right"},
};

double best_cost(const NodeSplits& splits) {
  double best = std::isnan(splits.tree.cost) ? splits.leaf_cost : splits.tree.cost;
  if (splits.tree.leaf || splits.tree.children > 2) best = splits.leaf_cost;
  for (const SplitChoice& choice : splits.builders) {
    const double cost = choice.leaf ? splits.leaf_cost : choice.cost;
    if (cost < best) best = cost;
  }
  return best;
}

// The builder whose row is under the mouse.
std::string_view draw_table(const NodeSplits& splits) {
  std::string_view lit;
  const ImGuiTableFlags flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit |
                                ImGuiTableFlags_BordersInnerV | ImGuiTableFlags_ScrollX;
  const float line = ImGui::GetTextLineHeight() + 2.0f * ImGui::GetStyle().CellPadding.y;
  const float rows =
      static_cast<float>(splits.builders.size()) + 2.0f;  // and the tree's, and the header
  const float height = rows * line + ImGui::GetStyle().ScrollbarSize + 4.0f;
  if (!ImGui::BeginTable("choices", 5, flags, {0.0f, height})) return lit;
  for (const Column& column : columns) {
    const bool names = &column == columns;  // their texts are drawn, not laid out
    ImGui::TableSetupColumn(column.label, ImGuiTableColumnFlags_WidthFixed,
                            names ? 5.2f * em() : 0.0f);
  }
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (const Column& column : columns)
    header(column.label, column.help);
  const double best = best_cost(splits);
  if (draw_choice(splits, splits.tree, best)) lit = splits.tree.id;
  for (const SplitChoice& choice : splits.builders) {
    if (draw_choice(splits, choice, best)) lit = choice.id;
  }
  ImGui::EndTable();
  return lit;
}

}  // namespace

CostRange cost_range(const NodeSplits& splits) {
  double least = splits.leaf_cost, most = splits.leaf_cost;
  const auto take = [&](double cost) {
    if (std::isnan(cost)) return;
    least = std::min(least, cost);
    most = std::max(most, cost);
  };
  for (const SplitCurve& curve : splits.axes) {
    for (const auto* costs : {&curve.objects, &curve.space}) {
      for (const double cost : *costs)
        take(cost);
    }
  }
  for (const SplitChoice& choice : splits.builders)
    take(choice.cost);
  const double pad = std::max(0.08 * (most - least), 1e-3 * most);
  return {std::max(least - pad, 0.0), most + pad};
}

void draw_node_splits(Frame& frame, const NodeSplits& splits) {
  if (splits.builders.empty()) {
    hint("There is nothing to split.");
    return;
  }
  const Scope scope("splits");
  frame.state.node.lit_choice = std::string(draw_table(splits));
  const CostRange costs = cost_range(splits);
  draw_legend(splits.mesh != tracer::none);
  for (int axis = 0; axis < 3; ++axis)
    draw_axis_plot(splits, axis, costs, frame.state.node.lit_choice);
  text_row("As a leaf", short_number(splits.leaf_cost),
           "Ci N: what the node would cost without a split");
}

}  // namespace ui
