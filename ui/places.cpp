// Places in trees.
#include "ui/places.h"

#include <algorithm>

#include <fmt/format.h>

namespace ui {

std::string tree_name(const tracer::Snapshot& snapshot, uint32_t mesh) {
  if (!snapshot.scene || mesh >= snapshot.scene->meshes.size()) return "TLAS";
  const std::string& name = snapshot.scene->meshes[mesh].name;
  return fmt::format("mesh {}{}", mesh, name.empty() ? "" : " " + name);
}

std::string place_name(const tracer::Snapshot& snapshot, uint32_t mesh, uint32_t node,
                       uint32_t triangle) {
  std::string text = tree_name(snapshot, mesh);
  if (node != tracer::none) text += fmt::format(", node {}", node);
  if (triangle == tracer::none) return text;
  return text + fmt::format(", {} {}", mesh == tracer::none ? "instance" : "triangle", triangle);
}

void select_place(Frame& frame, uint32_t mesh, uint32_t node, uint32_t triangle) {
  Selection& selection = frame.state.selection;
  selection = {};
  if (node != tracer::none) selection.node = NodePlace{mesh, node};
  if (triangle == tracer::none) return;
  const auto& instances = frame.snapshot.bvh->instances;
  if (mesh == tracer::none) {
    if (triangle < instances.size()) selection.instance = triangle;
    return;
  }
  const auto first = std::find_if(instances.begin(), instances.end(),
                                  [&](const auto& instance) { return instance.mesh == mesh; });
  if (first == instances.end()) return;
  selection.instance = static_cast<uint32_t>(first - instances.begin());
  selection.triangle = triangle;
}

}  // namespace ui
