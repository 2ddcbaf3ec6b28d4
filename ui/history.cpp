// A list of settings and the place in it.
#include "ui/history.h"

namespace ui {
namespace {

bool differs_in_camera_only(const tracer::Settings& a, const tracer::Settings& b) {
  if (!a.look || !b.look || a.look->camera == b.look->camera) return false;
  tracer::Settings moved = a;
  moved.look->camera = b.look->camera;
  return moved == b;
}

// What changes by itself becomes part of the present state.
void follow_own_changes(const Edited& edited, UiState& state) {
  tracer::Settings& present = state.history.states[state.history.now];
  if (state.picture_size != PictureSize::fixed) {
    present.render.width = edited.settings.render.width;
    present.render.height = edited.settings.render.height;
  }
  if (state.playing) present.time = edited.settings.time;
}

void take_over(Edited& edited, UiState& state, const tracer::Settings* settings) {
  if (settings == nullptr) return;
  const tracer::RenderOptions shown = edited.settings.render;
  edited.settings = *settings;
  if (state.picture_size != PictureSize::fixed) {
    edited.settings.render.width = shown.width;
    edited.settings.render.height = shown.height;
  }
  state.playing = false;
}

}  // namespace

void record(History& history, const tracer::Settings& settings, double seconds) {
  if (history.states.empty()) {
    history.states.push_back(settings);
    history.now = 0;
    return;
  }
  if (history.states[history.now] == settings) return;
  const bool camera_only = differs_in_camera_only(history.states[history.now], settings);
  const bool latest = history.now + 1 == history.states.size();
  if (camera_only && history.camera_only && latest && seconds - history.time < 1.0) {
    history.states[history.now] = settings;
  } else {
    history.states.resize(history.now + 1);
    history.states.push_back(settings);
    if (history.states.size() > max_states) history.states.erase(history.states.begin());
    history.now = history.states.size() - 1;
  }
  history.camera_only = camera_only;
  history.time = seconds;
}

bool can_undo(const History& history) {
  return history.now > 0;
}

bool can_redo(const History& history) {
  return history.now + 1 < history.states.size();
}

const tracer::Settings* undo(History& history) {
  if (!can_undo(history)) return nullptr;
  history.camera_only = false;
  return &history.states[--history.now];
}

const tracer::Settings* redo(History& history) {
  if (!can_redo(history)) return nullptr;
  history.camera_only = false;
  return &history.states[++history.now];
}

void update_history(Edited& edited, UiState& state) {
  History& history = state.history;
  if (history.states.empty()) {
    if (edited.settings.look) record(history, edited.settings, ImGui::GetTime());
    return;
  }
  if (ImGui::IsAnyItemActive() || state.viewport.drag != ViewportDrag::none) return;
  follow_own_changes(edited, state);
  record(history, edited.settings, ImGui::GetTime());
}

void undo(Edited& edited, UiState& state) {
  if (!state.history.states.empty()) {  // an edit that has not ended yet is undone too
    follow_own_changes(edited, state);
    record(state.history, edited.settings, ImGui::GetTime());
  }
  take_over(edited, state, undo(state.history));
}

void redo(Edited& edited, UiState& state) {
  take_over(edited, state, redo(state.history));
}

}  // namespace ui
