// The replayed build.
#include "ui/replay.h"

#include <algorithm>
#include <cmath>

#include "tracer/analyze/inspection.h"

namespace ui {
namespace {

constexpr size_t most_boxes = 400;  // drawn

void play(Frame& frame, const tracer::Replay& replay) {
  ReplayState& state = frame.state.replay;
  if (!state.playing) return;
  frame.state.animating = true;
  state.due += state.speed * ImGui::GetIO().DeltaTime;
  const double whole = std::floor(double(state.due));
  state.due -= float(whole);
  const size_t next = std::min(state.step + size_t(whole), replay.order.size());
  if (next == replay.order.size()) state.playing = false;
  if (next != state.step) go_to_build_step(frame, next);
}

}  // namespace

const tracer::Replay* shown_replay(const Frame& frame) {
  const auto& result = frame.work.replay.result;
  const auto& inspection = frame.work.inspection.result;
  if (!result || !result->table || !inspection || inspection->bvh != frame.snapshot.bvh) {
    return nullptr;
  }
  const bool same = result->table.get() == table_of(*inspection, frame.state.replay.mesh);
  return same && !result->table->nodes.empty() ? result.get() : nullptr;
}

void go_to_build_step(Frame& frame, size_t step) {
  const tracer::Replay* replay = shown_replay(frame);
  if (replay == nullptr) return;
  ReplayState& state = frame.state.replay;
  state.step = std::min(step, replay->order.size());
  if (state.step == 0) {
    frame.state.selection.node.reset();
  } else {
    frame.state.selection.node = NodePlace{state.mesh, replay->order[state.step - 1]};
  }
}

void follow_replay(Frame& frame) {
  ReplayState& state = frame.state.replay;
  const size_t meshes = frame.snapshot.bvh->blases.size();
  if (!state.chosen || (state.mesh != tracer::none && state.mesh >= meshes)) {
    state.mesh = meshes > 0 ? 0 : tracer::none;
    state.chosen = true;
  }
  frame.requests.inspect = true;
  frame.requests.replay = state.mesh;
  state.drawn_in = ImGui::GetFrameCount();
  const tracer::Replay* replay = shown_replay(frame);
  if (replay == nullptr) return;
  if (state.of != replay->table) {  // another tree: its whole build is over
    state.of = replay->table;
    state.step = replay->order.size();
    state.playing = false;
    state.boxes_at = SIZE_MAX;
  }
  play(frame, *replay);
  if (state.boxes_at != state.step) {
    state.boxes = boxes_after(*replay, state.step, most_boxes);
    state.boxes_at = state.step;
  }
}

}  // namespace ui
