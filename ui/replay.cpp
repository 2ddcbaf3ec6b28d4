// The replayed build.
#include "ui/replay.h"

#include <algorithm>
#include <cmath>

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
  const size_t next = std::min(state.step + size_t(whole), step_count(replay));
  if (next == step_count(replay)) state.playing = false;
  if (next != state.step) go_to_build_step(frame, next);
}

}  // namespace

const tracer::Replay* shown_replay(const Frame& frame) {
  const auto& result = frame.work.replay.result;
  const tracer::SceneBvh& bvh = *frame.snapshot.bvh;
  const uint32_t mesh = frame.state.replay.mesh;
  if (!result || !result->bvh || result->mesh != mesh || result->log.nodes.empty()) return nullptr;
  const bool same = mesh == tracer::none
                        ? result->bvh == frame.snapshot.bvh
                        : mesh < bvh.blases.size() && result->bvh->blases[mesh] == bvh.blases[mesh];
  return same ? result.get() : nullptr;
}

void go_to_build_step(Frame& frame, size_t step) {
  const tracer::Replay* replay = shown_replay(frame);
  if (replay == nullptr) return;
  ReplayState& state = frame.state.replay;
  state.step = std::min(step, step_count(*replay));
  frame.state.selection.node.reset();
  const uint32_t made = state.step > 0 ? node_of(*replay, state.step - 1) : tracer::none;
  if (made == tracer::none || replay->same[made] == tracer::none) return;
  frame.state.selection.node = NodePlace{state.mesh, replay->same[made]};
}

void follow_replay(Frame& frame) {
  ReplayState& state = frame.state.replay;
  const size_t meshes = frame.snapshot.bvh->blases.size();
  if (!state.chosen || (state.mesh != tracer::none && state.mesh >= meshes)) {
    state.mesh = meshes > 0 ? 0 : tracer::none;
    state.chosen = true;
  }
  frame.requests.replay = state.mesh;
  state.drawn_in = ImGui::GetFrameCount();
  const tracer::Replay* replay = shown_replay(frame);
  if (replay == nullptr) return;
  if (state.of.get() != replay) {  // another tree: its whole build is over
    state.of = frame.work.replay.result;
    state.step = step_count(*replay);
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
