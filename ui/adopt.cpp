// What the workspace takes over from the pipeline: the look of a new scene, warnings and errors.
#include <algorithm>
#include <memory>
#include <span>

#include "ui/workspace_state.h"

namespace ui {
namespace {

constexpr size_t max_messages = 1000;

SceneFigures figures_of(const tracer::Scene& scene) {
  SceneFigures figures;
  for (const tracer::Mesh& mesh : scene.meshes)
    figures.triangles += mesh.triangles.size();
  for (const tracer::Instance& instance : scene.instances) {
    figures.instanced_triangles += scene.meshes[instance.mesh].triangles.size();
    figures.moves |= instance.motion != tracer::Motion();
  }
  return figures;
}

// Whether nodes have the same numbers: refitted trees keep theirs, and their references.
bool have_same_nodes(std::span<const std::shared_ptr<const tracer::Blas>> now,
                     std::span<const std::shared_ptr<const tracer::Blas>> before) {
  return std::equal(now.begin(), now.end(), before.begin(), before.end(),
                    [](const auto& a, const auto& b) {
                      return a == b || (a->tree.nodes.size() == b->tree.nodes.size() &&
                                        a->tree.references == b->tree.references);
                    });
}

void note_scene(UiState& state, const tracer::Snapshot& snapshot) {
  state.scene_generation = snapshot.scene_generation;
  state.scene = figures_of(*snapshot.scene);
  state.selection = {};
  state.hovered = state.was_hovered = {};
  state.edited_material = tracer::none;
  post(state, Severity::info, "Loaded " + snapshot.scene->name);
  for (const std::string& warning : snapshot.scene->warnings) {
    post(state, Severity::warning, warning);
  }
}

// A scene that cannot be loaded: back to the one that is still shown.
void go_back(Edited& edited, UiState& state, const tracer::Snapshot& snapshot) {
  History& history = state.history;
  if (history.now > 0 && history.states[history.now].source == edited.settings.source) {
    history.states.resize(history.now);
    --history.now;
  }
  tracer::Settings good = snapshot.settings;
  if (!history.states.empty() && history.states[history.now].source == good.source &&
      history.states[history.now].look) {  // with all edits
    good = history.states[history.now];
  }
  edited.settings.source = good.source;
  if (edited.settings.look) return;  // only the sky was to be another one
  edited.settings.look = good.look;
  edited.settings.time = good.time;
  state.kept_camera.reset();
}

}  // namespace

void post(UiState& state, Severity severity, std::string text) {
  if (severity == Severity::error) state.banner = text;
  state.messages.push_back({severity, std::move(text)});
  if (state.messages.size() > max_messages) state.messages.erase(state.messages.begin());
}

void open_scene(Edited& edited, UiState& state, tracer::SceneSource source) {
  edited.settings.source = std::move(source);
  edited.settings.look.reset();
  edited.settings.time = 0.0f;
  state.playing = false;
  state.kept_camera.reset();
}

void adopt(Edited& edited, UiState& state, const tracer::Snapshot& snapshot) {
  const bool news = snapshot.error != state.last_error;
  state.last_error = snapshot.error;
  tracer::Settings& settings = edited.settings;
  const bool failed = snapshot.scene && snapshot.failed_source == settings.source;
  if (!snapshot.error.empty() && (news || failed)) post(state, Severity::error, snapshot.error);
  if (!snapshot.scene) return;
  if (snapshot.bvh && snapshot.bvh->blases != state.blases) {
    const bool same = have_same_nodes(snapshot.bvh->blases, state.blases);
    state.blases = snapshot.bvh->blases;
    if (!same) {
      state.selection.node.reset();
      state.box_filter = {};
    }
  }
  if (failed) go_back(edited, state, snapshot);
  if (snapshot.scene_generation != state.scene_generation) note_scene(state, snapshot);
  if (!settings.look && snapshot.settings.look && snapshot.settings.source == settings.source) {
    settings.look = snapshot.settings.look;
    if (state.kept_camera) settings.look->camera = *state.kept_camera;
    state.kept_camera.reset();
    History& history = state.history;
    if (!history.states.empty() && history.states[history.now].source == settings.source &&
        !history.states[history.now].look) {
      history.states[history.now].look = settings.look;
    }
  }
}

}  // namespace ui
