// The boxes of a replayed build, over the picture.
#include <algorithm>

#include "ui/pick.h"
#include "ui/replay.h"
#include "ui/viewport.h"

namespace ui {
namespace {

constexpr ImU32 waiting = IM_COL32(205, 212, 222, 90);
constexpr ImU32 yellow = IM_COL32(255, 200, 60, 255);
constexpr ImU32 blue = IM_COL32(90, 200, 255, 255);
constexpr ImU32 green = IM_COL32(140, 230, 120, 255);

}  // namespace

void draw_replay(Frame& frame) {
  const ReplayState& state = frame.state.replay;
  const tracer::Replay* replay = shown_replay(frame);
  if (replay == nullptr || state.drawn_in < ImGui::GetFrameCount() - 1) return;
  if (state.step == step_count(*replay) && !state.playing) return;  // over: the tree as it is
  const tracer::CameraFrame camera = film_frame(frame.snapshot);
  const auto draw = [&](const tracer::Box& box, ImU32 color, float width) {
    const auto placed =
        mesh_corners(frame.snapshot, state.mesh, box, frame.state.selection.instance);
    if (!placed.empty()) world_box(frame, camera, placed.front(), color, width);
  };
  for (const tracer::Box& box : state.boxes)
    draw(box, waiting, 1.0f);
  if (state.step == 0) return;
  if (const tracer::TreeMove* move = move_of(*replay, state.step - 1)) {
    draw(move->left, green, 2.0f);
    draw(move->beside, blue, 2.0f);
    draw(move->moved, yellow, 2.0f);
    return;
  }
  const uint32_t made = node_of(*replay, state.step - 1);
  if (made == tracer::none) return;
  const tracer::BvhNode& node = replay->log.nodes[made];
  draw(box_of(replay->log.nodes[node.first]), blue, 2.0f);
  draw(box_of(replay->log.nodes[node.first + 1]), green, 2.0f);
  draw(box_of(node), yellow, 2.0f);
}

}  // namespace ui
