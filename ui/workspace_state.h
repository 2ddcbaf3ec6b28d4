// What the workspace remembers from frame to frame: an edit here costs a redraw and nothing else.
#pragma once

#include <bitset>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tracer/analyze/node_facts.h"
#include "ui/file_browser.h"
#include "ui/icicle_state.h"
#include "ui/layout.h"
#include "ui/tree_state.h"
#include "ui/workspace.h"

namespace ui {

enum class Severity { info, warning, error };
struct Message {
  Severity severity = Severity::info;
  std::string text;
};

// How the size of the rendered picture is chosen.
enum class PictureSize { panel, half_panel, quarter_panel, fixed };

struct Bookmark {
  std::string name;
  tracer::Camera camera;
};

// What the mouse is doing in the viewport.
enum class ViewportDrag { none, orbit, pan, look, light };

struct ViewportState {
  ImVec2 lo{0, 0}, hi{0, 0};  // of the picture on the screen
  ViewportDrag drag = ViewportDrag::none;
  int button = 0;  // of the mouse, that is held
  ImVec2 drag_from{0, 0};
  bool dragged = false;            // moved far enough not to be a click
  tracer::ivec2 menu_pixel{0, 0};  // that the context menu is about
  std::bitset<key_count> flying;   // fly keys that are held
  ImVec2 panel_size{0, 0};         // pixels, of the last frame
  float size_age = 1e9f;           // seconds since panel_size changed last
  std::string view_before;         // what M goes back to
};

// Of the loaded scene; counted once.
struct SceneFigures {
  uint64_t triangles = 0;            // of the meshes
  uint64_t instanced_triangles = 0;  // of all instances
  bool moves = false;                // some instance does
};

// The rows of a long list that match its filter.
struct FilteredRows {
  std::string filter;
  uint64_t scene_generation = 0;
  std::vector<uint32_t> rows;
};

// The Builders panel.
struct BuildersState {
  std::set<std::string, std::less<>> left_out;               // ids of builders
  std::set<std::string, std::less<>> optimizers = {"none"};  // ids, for each of the builders
  bool whole = true;                                         // each without pre-splitting
  bool presplit = false;                                     // and with it
  bool present_options = true;                               // those of the Build panel too
  std::vector<tracer::ComparedBuild> rows;                   // of the scene
  std::shared_ptr<const std::vector<tracer::ComparedBuild>> adopted;  // what rows has taken over
  std::optional<tracer::ComparisonView> view;                         // of the rows measured last
  uint64_t scene_generation = 0;
  int hovered = -1;  // row, in the last frame
  std::string plot = "cost";
};

// The Benchmark panel.
struct BenchmarkState {
  std::set<std::string, std::less<>> builders;  // ids; none: the Build panel's
  std::set<std::string, std::less<>> left_out;  // ids of layouts, kernels and classes of rays
  bool one_thread = true, all_threads = true;
  bool quick = true;
  bool flatten = false;
  bool fast = false;
  std::string shown = "rays";         // or "builds"
  std::string shown_class = "all";    // of rays
  std::string shown_threads = "all";  // "one", "several"
};

// The Findings panel.
struct FindingsState {
  std::string severity = "all";
  std::string filter;
  // Of the selected node, and of which tree; walked to once.
  std::shared_ptr<const tracer::SceneBvh> facts_of;
  NodePlace facts_at;
  std::optional<tracer::NodeFacts> facts;
};

// The Hot nodes panel.
struct HotState {
  std::string ray_class = "all";
  bool with_cause = true;
};

// Which of the nodes' boxes are shown in 3D.
struct BoxFilter {
  std::optional<NodePlace> isolated;  // only those of this node and of what is below it
  std::vector<NodePlace> hidden;      // these and what is below them are left out
  bool operator==(const BoxFilter&) const = default;
};

// The range of time that is played and measured.
struct TimelineState {
  float from = 0.0f, to = 4.0f;  // seconds
  bool own_range = false;        // chosen by the user; else one swing of the deformer
  bool loop = true;
  int frames = 40;  // measured at most
  int width = 320;  // of the measured picture, pixels
};

// The Replay panel.
struct ReplayState {
  uint32_t mesh = tracer::none;              // whose BLAS; none: the TLAS
  bool chosen = false;                       // else the first mesh
  std::shared_ptr<const tracer::Replay> of;  // that the step is of
  size_t step = 0;                           // steps done
  bool playing = false;
  float speed = 8.0f;              // steps a second
  float due = 0.0f;                // part of the next step, 0..1
  std::vector<tracer::Box> boxes;  // that there are after the step, the largest
  size_t boxes_at = SIZE_MAX;      // the step that they are of
  int drawn_in = -1;               // frame in which the panel was on show
};

// The Ray panel: which rays are shown, and how far one of them has been followed.
struct RayState {
  std::optional<tracer::ivec2> pixel;  // clicked last; stays when something else is selected
  std::shared_ptr<const tracer::RayLog> locked;  // stays while camera and trees change
  uint32_t ray = 0;                              // in RayLog::rays
  uint32_t step = 0;
  bool before = false;   // the steps are those of `locked`, though the tree is another one now
  bool stepped = false;  // by the user, since the pixel was clicked
  bool reveal = false;   // scroll the table to the step
  bool playing = false;
  float speed = 8.0f;  // steps a second
  float due = 0.0f;    // part of the next step, 0..1; below 0 a held key pauses
  std::string shown_rays = "all";
  bool show_boxes = true;
  // Of the last frame, since the picture is drawn before the panel.
  uint32_t hovered_step = tracer::none;
  uint32_t hovered_ray = tracer::none;
  int drawn_in = -1;  // frame in which the panel was on show
  uint64_t scene_generation = 0;
};

struct UiState {
  // Written by the frame loop.
  std::bitset<key_count> held;  // keys that are down now, by Key
  float scale = 1.0f;           // what apply_style was called with

  // Read by the frame loop.
  float user_scale = 0.0f;  // chosen in the View menu; 0: the monitor's
  bool animating = false;   // the next frame should come at once: flying, playing, a popup opening

  Layout layout = default_layout();
  Selection selection;
  Selection hovered;      // rebuilt in each frame by whatever is under the cursor
  Selection was_hovered;  // in the last frame: for panels that are drawn before that one
  History history;
  FileBrowser browser;
  std::vector<std::string> recent_files;  // scenes, newest first
  std::vector<Message> messages;
  std::string banner;  // the error shown over the picture until it is dismissed
  bool show_keys = false;
  bool show_about = false;

  ViewportState viewport;
  PictureSize picture_size = PictureSize::panel;
  float fly_speed = 1.0f;  // times the speed that fits the scene
  std::vector<Bookmark> bookmarks;
  bool playing = false;
  float play_speed = 1.0f;  // scene seconds a second
  TimelineState timeline;
  bool show_gizmo = true;
  bool show_lights = true;
  bool show_values = true;  // the text about the pixel under the cursor
  std::string material_filter;
  std::string instance_filter;
  FilteredRows instance_rows;
  uint32_t edited_material = tracer::none;
  bool show_material = false;                      // scroll the list to it
  std::vector<tracer::SceneParameter> parameters;  // of a built-in scene, while one is being edited
  std::string bookmark_name;
  BuildersState builders;
  BenchmarkState benchmark;
  FindingsState findings;
  HotState hot;
  IcicleState icicle;
  TreeState tree;
  NodeState node;
  BoxFilter box_filter;
  RayState ray;
  ReplayState replay;
  int message_filter = 0;  // 0 all, 1 warnings and errors, 2 errors

  // What has been taken over from the snapshot.
  uint64_t scene_generation = 0;
  std::vector<std::shared_ptr<const tracer::Blas>> blases;  // that a selected node may be of
  SceneFigures scene;
  std::string last_error;
  const void* failed = nullptr;               // the snapshot whose failed load has been answered
  std::optional<tracer::Camera> kept_camera;  // for the scene that is being loaded
};

// Dark style, and Roboto at 15 pixels times the scale through FreeType (else DejaVu, else ImGui's
// own font). Call it between frames, or before the first one; before ImGui 1.92 the renderer's font
// texture has to be made anew afterwards.
void apply_style(float scale);

// Layout, scale, recent files and the other lasting choices as JSON. Reading takes what it
// understands and leaves the rest as it is.
std::string layout_to_json(const UiState& state);
void layout_from_json(UiState& state, std::string_view json);

// Adds a line to the Messages panel; an error is shown over the picture too.
void post(UiState& state, Severity severity, std::string text);

// Makes this the scene to load; its own look comes with it. (Requests::open asks for this.)
void open_scene(Edited& edited, UiState& state, tracer::SceneSource source);

// Takes over what a new snapshot brings: the look of a scene that has just been loaded, its
// warnings and errors. To be called once a frame before draw_workspace.
void adopt(Edited& edited, UiState& state, const tracer::Snapshot& snapshot);

}  // namespace ui
