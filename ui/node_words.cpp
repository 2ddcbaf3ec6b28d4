// Words about nodes, and the selection of one.
#include "ui/node_words.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "ui/registry.h"

namespace ui {

std::string tree_name(const Frame& frame, uint32_t mesh) {
  if (mesh == tracer::none) return "TLAS";
  const bool known = frame.snapshot.scene && mesh < frame.snapshot.scene->meshes.size();
  const std::string name = known ? frame.snapshot.scene->meshes[mesh].name : std::string();
  return fmt::format("mesh {}{}{}", mesh, name.empty() ? "" : " ", name);
}

std::string instance_name(const Frame& frame, uint32_t instance) {
  const bool known = frame.snapshot.scene && instance < frame.snapshot.scene->instances.size();
  const std::string name = known ? frame.snapshot.scene->instances[instance].name : std::string();
  return fmt::format("instance {}{}{}", instance, name.empty() ? "" : " ", name);
}

std::string entry_name(const Frame& frame, const tracer::TreeTable& table, size_t place) {
  const std::string name = instance_name(frame, table.references[place]);
  if (table.entries.empty() || table.entries[place] == 0) return name;
  return fmt::format("{} from node {}", name, table.entries[place]);
}

std::string node_name(const tracer::TreeTable& table, uint32_t node) {
  return fmt::format("{} {}", is_leaf(table.nodes[node]) ? "leaf" : "node", node);
}

std::string measure_label(const tracer::NodeMeasureRow& measure, const tracer::TreeTable& table) {
  if (!table.tlas || measure.id != "references") return std::string(measure.label);
  return table.entries.empty() ? "Instances" : "Parts";
}

std::string measure_text(const tracer::NodeMeasureRow& measure, double value) {
  if (std::isnan(value)) return "-";
  const std::string unit = measure.unit.empty() ? "" : fmt::format(" {}", measure.unit);
  if (measure.digits == 0) {
    return grouped(static_cast<uint64_t>(std::llround(std::max(value, 0.0)))) + unit;
  }
  const double least = 0.5 * std::pow(10.0, -measure.digits);
  if (value != 0.0 && std::abs(value) < least) return fmt::format("{:.1e}{}", value, unit);
  return fmt::format("{:.{}f}{}", value, measure.digits, unit);
}

std::shared_ptr<const tracer::TreeTable> newest_table(const Frame& frame, uint32_t mesh) {
  const auto& known = frame.work.inspection.result;
  if (!known) return nullptr;
  if (mesh == tracer::none) return known->tlas;
  return mesh < known->blases.size() ? known->blases[mesh] : nullptr;
}

std::shared_ptr<const tracer::TreeTable> table_of(const Frame& frame, uint32_t mesh) {
  const auto& known = frame.work.inspection.result;
  const auto& bvh = frame.snapshot.bvh;
  if (!known || !known->bvh || !bvh) return nullptr;
  const bool same = mesh == tracer::none
                        ? known->bvh == bvh
                        : mesh < bvh->blases.size() && mesh < known->bvh->blases.size() &&
                              known->bvh->blases[mesh] == bvh->blases[mesh];
  return same ? newest_table(frame, mesh) : nullptr;
}

std::vector<Choice> ray_choices() {
  std::vector<Choice> choices = {{"all", "All rays", "Rays of every class together"}};
  for (const Choice& choice : choices_of(tracer::ray_classes()))
    choices.push_back(choice);
  return choices;
}

int ray_class_index(std::string_view id) {
  const auto rows = tracer::ray_classes();
  return static_cast<int>(
      std::find_if(rows.begin(), rows.end(), [&](const auto& row) { return row.id == id; }) -
      rows.begin());
}

void select_node(Frame& frame, const NodePlace& place) {
  const Selection before = frame.state.selection;
  Selection selection;
  selection.node = place;
  selection.pixel = before.pixel;
  if (place.mesh != tracer::none && frame.snapshot.bvh &&
      before.instance < frame.snapshot.bvh->instances.size() &&
      frame.snapshot.bvh->instances[before.instance].mesh == place.mesh) {
    selection.instance = before.instance;
  }
  frame.state.selection = selection;
}

void select_instance(Frame& frame, uint32_t instance) {
  Selection selection;
  selection.instance = instance;
  selection.pixel = frame.state.selection.pixel;
  frame.state.selection = selection;
}

uint32_t instance_of(const Frame& frame, uint32_t mesh) {
  if (!frame.snapshot.bvh) return tracer::none;
  const auto& instances = frame.snapshot.bvh->instances;
  const uint32_t selected = frame.state.selection.instance;
  if (selected < instances.size() && instances[selected].mesh == mesh) return selected;
  const auto first = std::find_if(instances.begin(), instances.end(),
                                  [&](const auto& instance) { return instance.mesh == mesh; });
  return first == instances.end() ? tracer::none : static_cast<uint32_t>(first - instances.begin());
}

void select_triangle(Frame& frame, uint32_t mesh, uint32_t triangle) {
  Selection selection;
  selection.instance = instance_of(frame, mesh);
  selection.triangle = triangle;
  selection.pixel = frame.state.selection.pixel;
  selection.node = frame.state.selection.node;
  frame.state.selection = selection;
}

void hover_node(Frame& frame, const NodePlace& place) {
  frame.state.hovered.node = place;
}

bool is_lit(const UiState& state, const NodePlace& place) {
  return state.hovered.node ? state.hovered.node == place : state.was_hovered.node == place;
}

bool link(const char* label, std::string_view text, const char* help) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size = ImGui::CalcTextSize(text.data(), text.data() + text.size());
  const bool pressed =
      ImGui::InvisibleButton(label, {std::max(size.x, 1.0f), std::max(size.y, 1.0f)});
  mark(label);
  const bool lit = ImGui::IsItemHovered();
  const ImU32 color = lit ? IM_COL32(190, 225, 255, 255) : IM_COL32(120, 190, 255, 255);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddText(at, color, text.data(), text.data() + text.size());
  const float y = std::floor(at.y + size.y) - 0.5f;
  if (lit) list.AddLine({at.x, y}, {at.x + size.x, y}, color);
  tooltip(help);
  return pressed;
}

}  // namespace ui
