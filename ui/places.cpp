// Places in trees.
#include "ui/places.h"

#include <fmt/format.h>

#include "ui/node_words.h"
#include "ui/registry.h"

namespace ui {

bool tree_combo(const Frame& frame, const char* label, uint32_t& mesh, const char* help) {
  const std::string shown = tree_name(frame, mesh);
  const std::string id = std::string("##") + label;
  if (!ImGui::BeginCombo(id.c_str(), shown.c_str(), ImGuiComboFlags_HeightLarge)) {
    mark(label);
    tooltip(help);
    return false;
  }
  bool chosen = false;
  {
    const Scope scope(label);
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(frame.snapshot.bvh->blases.size()) + 1);
    while (clipper.Step()) {
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        const uint32_t tree = i == 0 ? tracer::none : static_cast<uint32_t>(i) - 1;
        ImGui::PushID(i);
        if (ImGui::Selectable(tree_name(frame, tree).c_str(), tree == mesh)) {
          mesh = tree;
          chosen = true;
        }
        mark(i == 0 ? std::string("tlas") : fmt::format("mesh {}", tree));
        ImGui::PopID();
      }
    }
    clipper.End();
  }
  ImGui::EndCombo();
  return chosen;
}

std::string place_name(const Frame& frame, uint32_t mesh, uint32_t node, uint32_t triangle) {
  std::string text = tree_name(frame, mesh);
  if (node != tracer::none) text += fmt::format(", node {}", node);
  if (triangle == tracer::none) return text;
  return text + fmt::format(", {} {}", mesh == tracer::none ? "instance" : "triangle", triangle);
}

void select_place(Frame& frame, uint32_t mesh, uint32_t node, uint32_t triangle) {
  Selection& selection = frame.state.selection;
  selection = {};
  if (triangle != tracer::none) {
    selection.instance = mesh == tracer::none ? triangle : instance_of(frame, mesh);
    if (mesh != tracer::none && selection.instance != tracer::none) selection.triangle = triangle;
  }
  if (node != tracer::none) selection.node = NodePlace{mesh, node};
}

}  // namespace ui
