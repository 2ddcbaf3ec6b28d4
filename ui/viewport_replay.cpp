// The boxes of a replayed build, over the picture.
#include <algorithm>

#include "ui/pick.h"
#include "ui/replay.h"
#include "ui/viewport.h"

namespace ui {
namespace {

constexpr ImU32 waiting = IM_COL32(205, 212, 222, 90);
constexpr ImU32 parent = IM_COL32(255, 200, 60, 255);
constexpr ImU32 children[] = {IM_COL32(90, 200, 255, 255), IM_COL32(140, 230, 120, 255)};

}  // namespace

void draw_replay(Frame& frame) {
  const ReplayState& state = frame.state.replay;
  const tracer::Replay* replay = shown_replay(frame);
  if (replay == nullptr || state.drawn_in < ImGui::GetFrameCount() - 1) return;
  if (state.step == replay->order.size() && !state.playing) return;  // over: the tree as it is
  const tracer::CameraFrame camera = film_frame(frame.snapshot);
  const auto box = [&](uint32_t node, ImU32 color, float width) {
    const auto placed =
        node_corners(frame.snapshot, {state.mesh, node}, frame.state.selection.instance);
    if (!placed.empty()) world_box(frame, camera, placed.front(), color, width);
  };
  for (const uint32_t node : state.boxes)
    box(node, waiting, 1.0f);
  if (state.step == 0) return;
  const uint32_t made = replay->order[state.step - 1];
  const tracer::TableNode& row = replay->table->nodes[made];
  for (uint32_t child = row.first; child < row.first + row.children; ++child)
    box(child, children[(child - row.first) % std::size(children)], 2.0f);
  box(made, parent, 2.0f);
}

}  // namespace ui
