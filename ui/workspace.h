// The workspace: what one frame of it reads and edits. Panels are functions of a const snapshot and
// of values; they never trigger work.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <imgui.h>

#include "tracer/analyze/benchmark.h"
#include "tracer/analyze/comparison.h"
#include "tracer/analyze/hot_spots.h"
#include "tracer/analyze/icicle.h"
#include "tracer/analyze/measures.h"
#include "tracer/analyze/node_pixels.h"
#include "tracer/analyze/ray_log.h"
#include "tracer/analyze/replay.h"
#include "tracer/analyze/split_curves.h"
#include "tracer/analyze/timeline.h"
#include "tracer/analyze/validate.h"
#include "tracer/pipeline.h"
#include "tracer/render/colorize.h"
#include "ui/background.h"

namespace ui {

// What the user edits; the frame loop hands changed settings to the session and changed view
// options to the painter.
struct Edited {
  tracer::Settings settings;
  tracer::ViewOptions view;
  bool operator==(const Edited&) const = default;
};

using tracer::NodePlace;

// Selected or hovered things; lit up in every panel that can show them.
struct Selection {
  uint32_t instance = tracer::none;
  uint32_t triangle = tracer::none;
  std::optional<tracer::ivec2> pixel;
  uint32_t light = tracer::none;
  uint32_t material = tracer::none;
  std::optional<NodePlace> node;
  bool operator==(const Selection&) const = default;
};

// Keys in the order they were pressed: ImGui 1.86 samples keys once a frame and loses quick taps.
// Letters and digits are their upper-case ASCII code.
enum Key : int {
  key_escape = 256,
  key_f1,
  key_f5,
  key_f12,
  key_delete,
  key_space,
  key_left,
  key_right,
  key_home,
  key_end,
  key_other,
  key_count
};
struct KeyPress {
  int key = 0;
  bool control = false, shift = false, alt = false;
};

// A validation, and of what.
struct Checked {
  std::shared_ptr<const tracer::SceneBvh> bvh;
  tracer::Validation validation;
};

// The pixels of a node, and of which film (Snapshot::render_generation).
struct WatchedPixels {
  uint64_t film = 0;
  tracer::NodePixels pixels;
};

// Rays step by step: those of a pixel of the snapshot's film, or those of a log once more in the
// snapshot's BVH.
struct RayRequest {
  tracer::ivec2 pixel{0};
  std::shared_ptr<const tracer::RayLog> again;  // nullptr: the pixel's
  bool operator==(const RayRequest&) const = default;
};
struct LoggedRays {
  RayRequest of;
  std::shared_ptr<const tracer::RayLog> log;
};

// A benchmark of the scene as it stands, seen from the present camera.
struct BenchmarkRequest {
  tracer::BenchmarkOptions options;
  bool flatten = false;  // all instances become one mesh
};

// What is known of work beside the session.
struct Work {
  Background<tracer::Measures> measures;  // of the newest BVH, begun after its first picture
  Background<std::vector<tracer::ComparedBuild>> comparison;  // of what was asked for last
  Background<tracer::Benchmark> benchmark;                    // likewise
  std::string_view missing_peers;  // what could not be measured beside ours; "" if nothing
  Background<Checked> checks;
  Background<tracer::Timeline> timeline;                // begun by Requests::measure_timeline
  std::shared_ptr<const tracer::Settings> timeline_of;  // that it was begun with
  Background<tracer::Inspection> inspection;            // of the newest picture's BVH; an older
  Background<tracer::CountedVisits> visits;             // one stays until the next is complete
  Background<tracer::HotSpots> hot_spots;               // of those two
  Background<tracer::Icicle> icicle;                    // of what was asked for last, likewise
  Background<WatchedPixels> node_pixels;                // as last asked for
  Background<tracer::NodeSplits> splits;                // likewise
  Background<LoggedRays> rays;                          // likewise
  Background<tracer::Replay> replay;                    // likewise
  bool measuring_time = false;                          // the session rests meanwhile
};

// What the frame loop carries out after the frame, and then clears.
struct Requests {
  std::optional<std::string> open;          // a scene, as on the command line: see open_scene
  std::optional<std::string> save_picture;  // file name of the picture with its legend
  std::optional<std::string> save_session;  // file name
  std::optional<std::string> open_session;  // file name
  std::optional<std::vector<tracer::BuildOptions>> compare;  // builds of the scene, as seen now
  bool cancel_comparison = false;
  std::optional<BenchmarkRequest> benchmark;
  bool cancel_benchmark = false;
  bool check_trees = false;  // of the present BVH
  bool cancel_check = false;
  std::optional<tracer::TimelineOptions> measure_timeline;  // of the present settings
  bool cancel_timeline = false;
  bool inspect = false;          // asked for in each frame in which it is shown: Work::inspection
  bool count_visits = false;     // likewise: Work::visits
  std::optional<int> hot_spots;  // likewise, of a ray class or all: Work::hot_spots
  std::optional<tracer::IcicleOptions> icicle;  // likewise: Work::icicle
  std::optional<tracer::Watched> node_pixels;   // likewise: Work::node_pixels
  std::optional<NodePlace> node_splits;         // likewise: Work::splits
  std::optional<RayRequest> log_rays;           // likewise: Work::rays
  std::optional<uint32_t> replay;  // likewise, of a mesh or the TLAS (none): Work::replay
  bool screenshot = false;         // of the whole window
  bool cancel = false;             // the running stage
  bool quit = false;
};

// Undo and redo: a list of settings. An edit ends when no widget is held any more.
struct History {
  std::vector<tracer::Settings> states;
  size_t now = 0;
  double time = -1e9;        // seconds; when states[now] was entered
  bool camera_only = false;  // states[now] differs from the one before in the camera alone
};

struct UiState;  // selection, layout, panels, filters: workspace_state.h

struct Frame {
  const tracer::Snapshot& snapshot;
  const tracer::Picture* picture = nullptr;  // nullptr until there is one
  ImTextureID texture = {};                  // of the picture, row 0 on top
  float frame_ms = 0.0f;                     // of the window, smoothed
  std::vector<KeyPress> keys;
  Edited& edited;
  UiState& state;
  Requests& requests;
  Work work = {};
};

// Draws everything, between ImGui::NewFrame and ImGui::Render. Starts no work; the file browser
// lists folders. ImGuiIO::UserData must be null or a ui::Registry (registry.h).
void draw_workspace(Frame& frame);

}  // namespace ui
