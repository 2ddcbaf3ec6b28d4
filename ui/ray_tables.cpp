// Draws the lists; only the rows in sight, since a ray can have a hundred thousand steps.
#include "ui/ray_tables.h"

#include <algorithm>

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
                                       ImGuiTableFlags_SizingFixedFit |
                                       ImGuiTableFlags_BordersInnerV | ImGuiTableFlags_Resizable;

// Lists show as many columns as there is room for; the most important ones come first.
struct ListColumn {
  const char* label;
  std::string help;
  float width;  // that it needs, in text sizes
};

struct CounterColumn {
  const char* label;
  uint32_t Counters::*member;
};
constexpr CounterColumn counter_columns[] = {{"Nodes", &Counters::nodes},
                                             {"Tests", &Counters::triangles},
                                             {"Leaves", &Counters::leaves},
                                             {"Instances", &Counters::instances}};

std::string counter_help(uint32_t Counters::*member) {
  for (const tracer::CounterRow& row : tracer::counters()) {
    if (row.member == member) return fmt::format("{}: {}", row.label, row.help);
  }
  return "";
}

int fitting(std::span<const ListColumn> columns, float width) {
  const float padding = 2.0f * ImGui::GetStyle().CellPadding.x + 1.0f;
  float left = width - ImGui::GetStyle().ScrollbarSize;
  int count = 0;
  for (const ListColumn& column : columns) {
    left -= column.width * em() + padding;
    if (left < 0.0f) break;
    ++count;
  }
  return std::max(count, 2);
}

bool begin_list(const char* id, std::span<const ListColumn> columns, ImVec2 size) {
  if (!ImGui::BeginTable(id, static_cast<int>(columns.size()), list_flags, size)) return false;
  ImGui::TableSetupScrollFreeze(0, 1);
  for (const ListColumn& column : columns) {
    const bool last = &column == &columns.back();
    ImGui::TableSetupColumn(
        column.label, last ? ImGuiTableColumnFlags_WidthStretch : ImGuiTableColumnFlags_WidthFixed,
        last ? 1.0f : column.width * em());
  }
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (const ListColumn& column : columns)
    header(column.label, column.help);
  return true;
}

void draw_counters(const Counters& now, const Counters* before, int count) {
  for (const CounterColumn& column :
       std::span(counter_columns)
           .first(std::min<size_t>(static_cast<size_t>(count), std::size(counter_columns)))) {
    cell(grouped(now.*column.member));
    if (before == nullptr) continue;
    const int64_t change = int64_t{now.*column.member} - int64_t{before->*column.member};
    ImGui::SameLine(0, 0.4f * em());
    const ImVec4 color = change == 0  ? ImGui::GetStyle().Colors[ImGuiCol_TextDisabled]
                         : change < 0 ? ImVec4(0.45f, 0.85f, 0.60f, 1.0f)
                                      : ImVec4(0.98f, 0.60f, 0.45f, 1.0f);
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    text(change == 0 ? "=" : fmt::format("{:+}", change),
         fmt::format("Before: {}. After the number: now less before.",
                     grouped(before->*column.member)));
    ImGui::PopStyleColor();
  }
}

std::string ray_help(const LoggedRay& ray, const LoggedRay* before) {
  const tracer::RayClassRow& row = tracer::ray_classes()[static_cast<size_t>(ray.cast.ray_class)];
  std::string text = fmt::format("{}: {}\nBounces before it: {}\nHit: {}", row.label, row.help,
                                 ray.cast.bounce, tracer::hit_words(ray.cast));
  for (const tracer::CounterRow& counter : tracer::counters()) {
    if (counter.member == &Counters::rays) continue;
    text += fmt::format("\n{}: {}", counter.label, ray.counters.*counter.member);
    if (before != nullptr) text += fmt::format(" (before: {})", before->counters.*counter.member);
  }
  text += fmt::format("\nSteps: {}", ray.steps.size());
  if (before != nullptr) text += fmt::format(" (before: {})", before->steps.size());
  return text + "\n\nA click follows this ray.";
}

void draw_ray_row(Frame& frame, const RayView& view, const RayPlace& place, int columns) {
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
  cell_text(name);
  draw_counters(ray.counters, before != nullptr ? &before->counters : nullptr, columns - 1);
  if (columns <= static_cast<int>(std::size(counter_columns)) + 1) return;
  cell(tracer::hit_words(ray.cast));
}

void draw_sum_row(const RayView& view, int columns) {
  ImGui::TableNextRow();
  cell(fmt::format("all {} rays", view.now->rays.size()));
  mark("sum");
  tooltip("The sum over all rays of the pixel; without supersampling it is what heat maps show");
  const Counters before = view.before ? tracer::counted(*view.before) : Counters();
  draw_counters(tracer::counted(*view.now), view.before ? &before : nullptr, columns - 1);
}

std::string distance(bool known, float t) {
  return known ? short_number(t) : std::string("-");
}

using Cell = std::string (*)(const LoggedRay& ray, const Step& step, uint32_t index);
struct StepColumn {
  const char *label, *help;
  float width;
  Cell cell;
};

bool is_box(const Step& step) {
  return step.kind == StepKind::node || step.kind == StepKind::leaf;
}

const StepColumn step_columns[] = {
    {"Step", "In the order of the traversal", 2.4f,
     [](const LoggedRay&, const Step&, uint32_t index) { return std::to_string(index + 1); }},
    {"What",
     "A node or leaf by its index in the tree, a triangle by its index in the mesh, an instance by "
     "its index in the scene",
     7.0f, [](const LoggedRay&, const Step& step, uint32_t) { return tracer::what(step); }},
    {"Result", "Entered, missed, behind the nearest hit; of a triangle: tested or hit", 3.7f,
     [](const LoggedRay&, const Step& step, uint32_t) {
       return std::string(tracer::name(step.result));
     }},
    {"Entry t",
     "Where the ray enters the node's box, in lengths of the ray's direction; of a triangle where "
     "it is hit",
     3.6f,
     [](const LoggedRay&, const Step& step, uint32_t) {
       return distance(is_box(step) || step.result == tracer::StepResult::hit, step.t_entry);
     }},
    {"Best t", "The nearest hit so far, or the ray's end, after the step", 3.6f,
     [](const LoggedRay&, const Step& step, uint32_t) {
       return distance(step.t_best < tracer::infinity, step.t_best);
     }},
    {"Exit t", "Where the ray leaves the node's box", 3.6f,
     [](const LoggedRay&, const Step& step, uint32_t) {
       return distance(is_box(step), step.t_exit);
     }},
    {"Depth", "Edges from the root of its tree; of a triangle or instance that of its leaf", 2.9f,
     [](const LoggedRay&, const Step& step, uint32_t) { return std::to_string(step.depth); }},
    {"Tree", "The instance whose tree it is, or the TLAS", 3.2f,
     [](const LoggedRay&, const Step& step, uint32_t) {
       return step.instance == tracer::none ? std::string("TLAS") : std::to_string(step.instance);
     }},
    {"Stack", "Nodes that wait in the same tree", 2.9f,
     [](const LoggedRay&, const Step& step, uint32_t) {
       return std::to_string(step.stack.size());
     }},
    {"Why", "The reason", 17.0f,
     [](const LoggedRay& ray, const Step&, uint32_t index) { return tracer::why(ray, index); }},
};

void draw_step_row(Frame& frame, const RayLog& log, const LoggedRay& ray, uint32_t index,
                   size_t columns) {
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
  if (ImGui::IsItemHovered()) {
    state.hovered_step = index;
    tooltip(tracer::explain(*log.bvh, ray, index) + "\n\nA click goes there.");
  }
  for (const StepColumn& column : std::span(step_columns).first(columns).subspan(1)) {
    const bool is_result = &column == &step_columns[2];
    if (is_result) ImGui::PushStyleColor(ImGuiCol_Text, step_look(step).color);
    cell(column.cell(ray, step, index));
    if (is_result) ImGui::PopStyleColor();
  }
}

}  // namespace

void draw_ray_list(Frame& frame, const RayView& view, ImVec2 size) {
  std::vector<ListColumn> columns = {{"Ray",
                                      "The rays of the sample through the pixel's centre; a ray "
                                      "stands below the one from whose hit it was cast",
                                      6.2f}};
  for (const CounterColumn& column : counter_columns) {
    const float name = ImGui::CalcTextSize(column.label).x / em();
    columns.push_back(
        {column.label, counter_help(column.member), std::max(name, view.before ? 5.0f : 2.4f)});
  }
  columns.push_back({"Hit",
                     "What it hit, and at which distance; t is in lengths of its direction, so a "
                     "shadow ray is at the light at 1",
                     18.0f});
  const int count = fitting(columns, size.x);
  if (!begin_list("rays", std::span(columns).first(static_cast<size_t>(count)), size)) return;
  const std::vector<RayPlace> tree = tracer::ray_tree(*view.now);
  if (tree.size() > 1) draw_sum_row(view, count);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(tree.size()));
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
      draw_ray_row(frame, view, tree[static_cast<size_t>(i)], count);
  }
  ImGui::EndTable();
}

void draw_step_list(Frame& frame, const RayView& view, ImVec2 size) {
  const LoggedRay* ray = stepped_ray(frame, view);
  if (ray == nullptr) return;
  const RayLog& log = *stepped_log(frame, view);
  std::vector<ListColumn> columns;
  for (const StepColumn& column : step_columns)
    columns.push_back({column.label, column.help, column.width});
  const auto count = static_cast<size_t>(fitting(columns, size.x));
  if (!begin_list("steps", std::span(columns).first(count), size)) return;
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
      draw_step_row(frame, log, *ray, static_cast<uint32_t>(i), count);
  }
  ImGui::EndTable();
}

}  // namespace ui
