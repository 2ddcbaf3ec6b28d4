// What is loaded: counts, parameters, meshes, instances, textures, warnings.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tracer/choice.h"
#include "tracer/scene/builtin.h"
#include "ui/actions.h"
#include "ui/panels.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::SceneParameter;
using tracer::SceneParameterRow;

double value_of(const std::vector<SceneParameter>& parameters, const SceneParameterRow& row) {
  for (const SceneParameter& parameter : parameters) {
    if (parameter.id == row.id) return parameter.value;
  }
  return row.default_value;
}

void set_value(std::vector<SceneParameter>& parameters, const SceneParameterRow& row,
               double value) {
  for (SceneParameter& parameter : parameters) {
    if (parameter.id != row.id) continue;
    parameter.value = value;
    return;
  }
  parameters.push_back({std::string(row.id), value});
}

bool is_whole(const SceneParameterRow& row) {
  return row.min == std::floor(row.min) && row.max == std::floor(row.max) &&
         row.default_value == std::floor(row.default_value) && row.max - row.min > 3.0;
}

bool draw_parameter(const SceneParameterRow& row, double& value) {
  const std::string label(row.label), help(row.help);
  const bool wide = row.min > 0.0 && row.max / row.min >= 1000.0;
  if (is_whole(row)) {
    int number = static_cast<int>(value);
    const bool changed = slider(label.c_str(), number, static_cast<int>(row.min),
                                static_cast<int>(row.max), help.c_str(), wide);
    if (changed) value = number;
    return changed;
  }
  float number = static_cast<float>(value);
  const bool changed = slider(label.c_str(), number, static_cast<float>(row.min),
                              static_cast<float>(row.max), help.c_str(), "%.4g", wide);
  if (changed) value = std::clamp(static_cast<double>(number), row.min, row.max);
  return changed;
}

// The camera stays when a scene is made anew with other parameters.
void remake(Frame& frame, std::vector<SceneParameter> parameters) {
  tracer::Settings& settings = frame.edited.settings;
  if (settings.source.parameters == parameters) return;
  if (settings.look) frame.state.kept_camera = settings.look->camera;
  settings.source.parameters = std::move(parameters);
  settings.look.reset();
}

// A scene is made when the hand lets go, not at each step of a slider.
void draw_parameters(Frame& frame) {
  const tracer::SceneSource& source = frame.edited.settings.source;
  const auto* row = tracer::find_row(tracer::builtin_scenes(), source.name);
  if (row == nullptr) return;
  hint(row->help);
  if (row->parameters.empty()) return;
  heading("Parameters");
  const Scope scope("parameters");
  std::vector<SceneParameter>& edited = frame.state.parameters;
  bool active = false, ended = false;
  for (const SceneParameterRow& parameter : row->parameters) {
    double value = value_of(edited.empty() ? source.parameters : edited, parameter);
    if (draw_parameter(parameter, value)) {
      if (edited.empty()) edited = source.parameters;
      set_value(edited, parameter, value);
    }
    active |= ImGui::IsItemActive();
    ended |= ImGui::IsItemDeactivatedAfterEdit();
  }
  if (ended && !edited.empty()) remake(frame, edited);
  if (!active) edited.clear();
  if (button("Default parameters", "The scene as it is first offered")) remake(frame, {});
}

void draw_counts(const tracer::Scene& scene, const SceneFigures& figures) {
  heading("Counts");
  const Scope scope("counts");
  text_row("Meshes", grouped(scene.meshes.size()), "Each has a tree of its own (a BLAS)");
  text_row("Instances", grouped(scene.instances.size()), "Meshes placed in the world");
  text_row("Triangles", grouped(figures.triangles), "Of the meshes, each counted once");
  text_row("Instanced", grouped(figures.instanced_triangles),
           "Triangles of all instances together");
  text_row("Materials", grouped(scene.materials.size()), "See the Materials panel");
  text_row("Textures", grouped(scene.textures.size()), "Images on surfaces");
  const tracer::TriangleCounts& counts = scene.counts;
  if (counts.degenerate + counts.non_finite + counts.bad_index == 0) return;
  text_row("Read", grouped(counts.read), "Triangles in the file");
  text_row("Degenerate", grouped(counts.degenerate), "Left out: without area");
  text_row("Not finite", grouped(counts.non_finite), "Left out: a corner is NaN or infinite");
  text_row("Bad index", grouped(counts.bad_index), "Left out: a corner does not exist");
}

void draw_warnings(const tracer::Scene& scene) {
  if (scene.warnings.empty()) return;
  heading("Warnings");
  ImGui::PushStyleColor(ImGuiCol_Text, {0.98f, 0.80f, 0.36f, 1.0f});
  for (const std::string& warning : scene.warnings)
    ImGui::TextWrapped("%s", warning.c_str());
  ImGui::PopStyleColor();
}

// A list of `count` rows with room for at most eight.
template <class Row>
void draw_list(const char* id, size_t count, const Row& row) {
  const float rows = std::clamp(static_cast<float>(count), 1.0f, 8.0f) + 0.6f;
  if (ImGui::BeginChild(id, {0, rows * ImGui::GetTextLineHeightWithSpacing()}, true)) {
    const Scope scope(id);
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(count));
    while (clipper.Step()) {
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
        row(static_cast<uint32_t>(i));
    }
  }
  ImGui::EndChild();
}

void draw_meshes(const tracer::Scene& scene) {
  heading("Meshes");
  draw_list("meshes", scene.meshes.size(), [&](uint32_t i) {
    const tracer::Mesh& mesh = scene.meshes[i];
    ImGui::Text("%u  %s", i, mesh.name.c_str());
    tooltip(fmt::format("{} triangles, {} corners, {}", grouped(mesh.triangles.size()),
                        grouped(mesh.positions.size()),
                        mesh.uvs.empty() ? "no texture coordinates" : "texture coordinates"));
    ImGui::SameLine();
    hint(grouped(mesh.triangles.size()), "Triangles of the mesh");
  });
}

// Searched only when the filter or the scene has changed: there may be a million.
const std::vector<uint32_t>& matching_instances(UiState& state, const tracer::Scene& scene) {
  FilteredRows& found = state.instance_rows;
  if (found.scene_generation == state.scene_generation && found.filter == state.instance_filter) {
    return found.rows;
  }
  found = {state.instance_filter, state.scene_generation, {}};
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    if (scene.instances[i].name.find(found.filter) != std::string::npos) found.rows.push_back(i);
  }
  return found.rows;
}

void draw_instances(Frame& frame, const tracer::Scene& scene) {
  heading("Instances");
  input("Filter", frame.state.instance_filter, "part of a name",
        "Show the instances with this name");
  const std::vector<uint32_t>& found = matching_instances(frame.state, scene);
  hint(fmt::format("{} of {} instances", grouped(found.size()), grouped(scene.instances.size())),
       "Those that the filter leaves, of all there are");
  draw_list("instances", found.size(), [&](uint32_t row) {
    const uint32_t i = found[row];
    const tracer::Instance& instance = scene.instances[i];
    const std::string label = fmt::format("{}  {}###{}", i, instance.name, i);
    if (ImGui::Selectable(label.c_str(), frame.state.selection.instance == i)) {
      frame.state.selection = {};
      frame.state.selection.instance = i;
    }
    mark(std::to_string(i));
    if (ImGui::IsItemHovered()) frame.state.hovered.instance = i;
    tooltip(fmt::format("Mesh {} ({}). A click selects it; F focuses on it", instance.mesh,
                        scene.meshes[instance.mesh].name));
  });
}

void draw_textures(const tracer::Scene& scene) {
  if (scene.textures.empty()) return;
  heading("Textures");
  draw_list("textures", scene.textures.size(), [&](uint32_t i) {
    const tracer::Texture& texture = scene.textures[i];
    ImGui::Text("%s", texture.name.c_str());
    ImGui::SameLine();
    hint(fmt::format("{} x {}", texture.width, texture.height), "Width and height in pixels");
  });
}

}  // namespace

void draw_scene(Frame& frame) {
  const tracer::SceneSource& source = frame.edited.settings.source;
  heading("Source");
  std::vector<Choice> choices = choices_of(tracer::builtin_scenes());
  const bool builtin = tracer::find_row(tracer::builtin_scenes(), source.name) != nullptr;
  std::string chosen = source.name;
  if (!builtin) choices.push_back({source.name, source.name, "The opened file"});
  if (combo("Scene", chosen, std::span<const Choice>(choices), "Built-in scenes; or open a file")) {
    frame.requests.open = chosen;
  }
  if (button("Open scene...", "Open a scene from a file (Ctrl+O)")) {
    browse(frame, FilePurpose::open_scene);
  }
  draw_parameters(frame);
  if (!frame.snapshot.scene) {
    hint("Nothing is loaded yet.");
    return;
  }
  const tracer::Scene& scene = *frame.snapshot.scene;
  draw_warnings(scene);
  draw_counts(scene, frame.state.scene);
  draw_instances(frame, scene);
  draw_meshes(scene);
  draw_textures(scene);
}

}  // namespace ui
