// Draws the lists; only the rows in sight, since a ray can have a hundred thousand steps.
#include "ui/ray_tables.h"

#include <fmt/format.h>

#include "tracer/analyze/ray_words.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::Counters;
using tracer::LoggedRay;
using tracer::RayLog;
using tracer::RayPlace;
using tracer::Step;
using tracer::StepKind;

constexpr ImGuiTableFlags list_flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY |
                                       ImGuiTableFlags_ScrollX | ImGuiTableFlags_SizingFixedFit |
                                       ImGuiTableFlags_BordersInnerV | ImGuiTableFlags_Resizable;

struct CounterColumn {
  const char* label;
  uint32_t Counters::*member;
};
constexpr CounterColumn counter_columns[] = {{"Nodes", &Counters::nodes},
                                             {"Leaves", &Counters::leaves},
                                             {"Triangles", &Counters::triangles},
                                             {"Instances", &Counters::instances}};

std::string counter_help(uint32_t Counters::*member) {
  for (const tracer::CounterRow& row : tracer::counters()) {
    if (row.member == member) return fmt::format("{}: {}", row.label, row.help);
  }
  return "";
}

void headers(std::span<const std::pair<const char*, std::string>> columns) {
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (const auto& [label, help] : columns) {
    ImGui::TableNextColumn();
    ImGui::TableHeader(label);
    mark(std::string("column ") + label);
    tooltip(help);
  }
}

void draw_counters(const Counters& now, const Counters* before) {
  for (const CounterColumn& column : counter_columns) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(grouped(now.*column.member).c_str());
    if (before == nullptr) continue;
    const int64_t change = int64_t{now.*column.member} - int64_t{before->*column.member};
    ImGui::SameLine(0, 0.4f * em());
    if (change == 0) {
      ImGui::TextDisabled("=");
    } else {
      const ImVec4 color =
          change < 0 ? ImVec4(0.45f, 0.85f, 0.60f, 1.0f) : ImVec4(0.98f, 0.60f, 0.45f, 1.0f);
      ImGui::TextColored(color, "%+lld", static_cast<long long>(change));
    }
    tooltip(fmt::format("Before: {}. Behind the number: now less before.",
                        grouped(before->*column.member)));
  }
}

std::string ray_help(const LoggedRay& ray, const LoggedRay* before) {
  const tracer::RayClassRow& row = tracer::ray_classes()[static_cast<size_t>(ray.cast.ray_class)];
  std::string text =
      fmt::format("{}: {}\nBounces before it: {}\nHit: {}\n{} steps", row.label, row.help,
                  ray.cast.bounce, tracer::hit_words(ray.cast), grouped(ray.steps.size()));
  if (before != nullptr) text += fmt::format(" (before: {})", grouped(before->steps.size()));
  return text + "\n\nA click follows this ray.";
}

void draw_ray_row(Frame& frame, const RayView& view, const RayPlace& place) {
  RayState& state = frame.state.ray;
  const LoggedRay& ray = view.now->rays[place.ray];
  const LoggedRay* before = view.before ? &view.before->rays[place.ray] : nullptr;
  const Scope scope("ray", place.ray);
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  const float indent = static_cast<float>(place.level) * 0.8f * em();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const std::string name(tracer::ray_classes()[static_cast<size_t>(ray.cast.ray_class)].id);
  if (ImGui::Selectable("##ray", state.ray == place.ray, ImGuiSelectableFlags_SpanAllColumns)) {
    choose_ray(frame, place.ray);
  }
  mark("row");
  tooltip(ray_help(ray, before));
  if (ImGui::IsItemHovered()) state.hovered_ray = place.ray;
  ImGui::GetWindowDrawList()->AddCircleFilled(
      {at.x + indent + 0.4f * em(), at.y + 0.5f * ImGui::GetTextLineHeight()}, 0.28f * em(),
      ray_color(ray.cast.ray_class));
  ImGui::SameLine(0, 0);
  ImGui::SetCursorScreenPos({at.x + indent + em(), at.y});
  ImGui::TextUnformatted(name.c_str());
  draw_counters(ray.counters, before != nullptr ? &before->counters : nullptr);
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(tracer::hit_words(ray.cast).c_str());
}

void draw_sum_row(const RayView& view) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(fmt::format("all {} rays", view.now->rays.size()).c_str());
  mark("sum");
  tooltip("The sum over all rays of the pixel; without supersampling it is what heat maps show");
  const Counters before = view.before ? tracer::counted(*view.before) : Counters();
  draw_counters(tracer::counted(*view.now), view.before ? &before : nullptr);
  ImGui::TableNextColumn();
}

std::string distance(bool known, float t) {
  return known ? short_number(t) : std::string("-");
}

void draw_step_row(Frame& frame, const LoggedRay& ray, uint32_t index) {
  RayState& state = frame.state.ray;
  const Step& step = ray.steps[index];
  const Scope scope("step", index);
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  if (ImGui::Selectable(std::to_string(index + 1).c_str(), state.step == index,
                        ImGuiSelectableFlags_SpanAllColumns)) {
    state.playing = false;
    go_to_step(frame, index);
    state.reveal = false;
  }
  mark("row");
  if (ImGui::IsItemHovered()) state.hovered_step = index;
  const bool box = step.kind == StepKind::node || step.kind == StepKind::leaf;
  const auto cell = [](const std::string& text) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(text.c_str());
  };
  cell(tracer::what(step));
  ImGui::TableNextColumn();
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(step_look(step).color), "%s",
                     std::string(tracer::name(step.result)).c_str());
  cell(distance(box || step.result == tracer::StepResult::hit, step.t_entry));
  cell(distance(box, step.t_exit));
  cell(distance(step.t_best < tracer::infinity, step.t_best));
  cell(step.instance == tracer::none ? std::string("TLAS") : fmt::format("{}", step.instance));
  cell(std::to_string(step.depth));
  cell(std::to_string(step.stack.size()));
  cell(tracer::why(ray, index));
}

}  // namespace

void draw_ray_list(Frame& frame, const RayView& view, ImVec2 size) {
  std::vector<std::pair<const char*, std::string>> columns = {
      {"Ray",
       "The rays of the sample through the pixel's centre; a ray stands below the one from "
       "whose hit it was cast"}};
  for (const CounterColumn& column : counter_columns)
    columns.emplace_back(column.label, counter_help(column.member));
  columns.emplace_back("Hit",
                       "What it hit, and at which distance; t is in lengths of its "
                       "direction, so a shadow ray is at the light at 1");
  if (!ImGui::BeginTable("rays", static_cast<int>(columns.size()), list_flags, size)) return;
  ImGui::TableSetupScrollFreeze(1, 1);
  for (const auto& column : columns)
    ImGui::TableSetupColumn(column.first);
  headers(columns);
  const std::vector<RayPlace> tree = tracer::ray_tree(*view.now);
  if (tree.size() > 1) draw_sum_row(view);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(tree.size()));
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
      draw_ray_row(frame, view, tree[static_cast<size_t>(i)]);
  }
  ImGui::EndTable();
}

void draw_step_list(Frame& frame, const RayView& view, ImVec2 size) {
  const LoggedRay* ray = stepped_ray(frame, view);
  if (ray == nullptr) return;
  const std::pair<const char*, std::string> columns[] = {
      {"Step", "In the order of the traversal"},
      {"What",
       "A node or leaf by its index in the tree, a triangle by its index in the mesh, an "
       "instance by its index in the scene"},
      {"Result", "Entered, missed, behind the nearest hit; of a triangle: tested or hit"},
      {"Entry t",
       "Where the ray enters the node's box, in lengths of the ray's direction; of a "
       "triangle where it is hit"},
      {"Exit t", "Where the ray leaves the node's box"},
      {"Best t", "The nearest hit so far, or the ray's end, after the step"},
      {"Tree", "The instance whose tree it is, or the TLAS"},
      {"Depth", "Edges from the root of its tree; of a triangle or instance that of its leaf"},
      {"Stack", "Nodes that wait in the same tree"},
      {"Why", "The reason"}};
  constexpr int count = static_cast<int>(std::size(columns));
  if (!ImGui::BeginTable("steps", count, list_flags, size)) return;
  ImGui::TableSetupScrollFreeze(1, 1);
  for (const auto& column : columns)
    ImGui::TableSetupColumn(column.first);
  headers(columns);
  const float line = ImGui::GetTextLineHeight() + 2.0f * ImGui::GetStyle().CellPadding.y;
  if (frame.state.ray.reveal) {
    const float middle = (static_cast<float>(frame.state.ray.step) + 1.5f) * line;
    ImGui::SetScrollY(std::max(middle - 0.5f * ImGui::GetWindowHeight(), 0.0f));
    frame.state.ray.reveal = false;
  }
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(ray->steps.size()), line);
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
      draw_step_row(frame, *ray, static_cast<uint32_t>(i));
  }
  ImGui::EndTable();
}

}  // namespace ui
