#include "app/window/screenshot.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "app/peers/peers.h"
#include "app/window/background_work.h"
#include "app/window/gl_picture.h"
#include "app/window/gui.h"
#include "app/window/painter.h"
#include "app/window/surfaceless.h"
#include "tracer/choice.h"
#include "tracer/error.h"
#include "tracer/render/image_io.h"
#include "ui/boxes.h"
#include "ui/panels.h"

namespace app {
namespace {

constexpr int min_width = 320;
constexpr int min_height = 200;

void check(const ScreenshotOptions& options) {
  if (options.width < min_width || options.width > tracer::max_image_size ||
      options.height < min_height || options.height > tracer::max_image_size) {
    throw tracer::Error(fmt::format("size {}x{}: a screenshot has {}x{} to {}x{} pixels",
                                    options.width, options.height, min_width, min_height,
                                    tracer::max_image_size, tracer::max_image_size));
  }
  for (const std::string& panel : options.panels) {
    if (tracer::find_row(ui::panels(), panel) != nullptr) continue;
    throw tracer::Error(
        fmt::format("unknown panel '{}'; known: {}", panel, tracer::known_ids(ui::panels())));
  }
  if (!(options.scale >= 0.5f && options.scale <= 4.0f)) {
    throw tracer::Error(fmt::format("scale {}: choose one from 0.5 to 4", options.scale));
  }
}

uint32_t number(std::string_view text) {
  uint32_t value = tracer::none;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  return end.ec == std::errc() && end.ptr == text.data() + text.size() ? value : tracer::none;
}

// "tlas:3", "0:12"
ui::NodePlace node_place(std::string_view text, const tracer::SceneBvh& bvh) {
  const size_t colon = std::min(text.find(':'), text.size());
  const std::string_view tree = text.substr(0, colon);
  const ui::NodePlace place = {tree == "tlas" ? tracer::none : number(tree),
                               number(text.substr(std::min(colon + 1, text.size())))};
  size_t nodes = 0;
  if (tree == "tlas") {
    nodes = bvh.tlas.nodes.size();
  } else if (place.mesh < bvh.blases.size()) {
    nodes = bvh.blases[place.mesh]->tree.nodes.size();
  }
  if (place.node < nodes) return place;
  throw tracer::Error(fmt::format(
      "no node '{}': give tlas:NODE or MESH:NODE; there are {} meshes, and {} nodes in this tree",
      text, bvh.blases.size(), nodes));
}

// The workspace as the window has it, on one thread and with nobody at the mouse.
struct Still {
  Gui gui;
  GlPicture texture;
  ui::Edited edited;
  ui::UiState state;
  tracer::Pipeline pipeline;
  Painting painting;
  ui::Work work;
  ui::Requests asked;  // in the last frame

  explicit Still(const ScreenshotOptions& options) : gui(options.scale) {
    edited = {options.settings, options.view};
    state.scale = options.scale;
    for (const std::string& panel : options.panels)
      ui::show_panel(state.layout, panel);
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {float(options.width), float(options.height)};
    io.DeltaTime = 1.0f / 60.0f;
  }

  void panels() {
    asked = {};
    ui::adopt(edited, state, *pipeline.snapshot());
    ui::Frame frame{*pipeline.snapshot(),
                    painting.picture.get(),
                    texture.texture(),
                    0.0f,
                    {},
                    edited,
                    state,
                    asked,
                    work};
    gui.begin_frame();
    ui::draw_workspace(frame);
  }

  // A second of frames: sizes and popups come to rest, and the viewport has told its size.
  void settle() {
    for (int i = 0; i < 60; ++i) {
      panels();
      ImGui::EndFrame();
    }
  }

  void draw(int width, int height) {
    panels();
    gui.end_frame(width, height);
  }

  void trace() {
    pipeline.run(edited.settings, {}, [](const auto&) {});
    const std::string& error = pipeline.snapshot()->error;
    if (!error.empty()) throw tracer::Error(error);
    ui::adopt(edited, state, *pipeline.snapshot());
    paint_picture();
    const tracer::Snapshot& traced = *pipeline.snapshot();
    work.measures.result = std::make_shared<const tracer::Measures>(
        tracer::measure(*traced.scene, traced.bvh, work.measures.result.get(), {}));
    const std::string& bottom = state.layout.front[static_cast<int>(ui::Region::bottom)];
    if (bottom == "timeline" && !work.timeline.result && is_active(edited.settings.deformer)) {
      measure_timeline();
    }
    if (bottom == "benchmark" && !work.benchmark.result) measure_benchmark();
  }

  // What the panel's button does, with fewer rays and one turn.
  void measure_benchmark() {
    const tracer::Snapshot& traced = *pipeline.snapshot();
    tracer::BenchmarkOptions benchmark;
    benchmark.builds = {edited.settings.build};
    benchmark.width = 320;
    benchmark.height = 180;
    benchmark.turns = 1;
    work.missing_peers = missing_peers();
    work.benchmark.result = std::make_shared<const tracer::Benchmark>(run_benchmark(
        {*traced.scene, *traced.settings.look, edited.settings.time, edited.settings.motion},
        benchmark, peers(), {}));
  }

  void paint_picture() {
    painting = paint(pipeline.snapshot(), edited.view, ui::box_sources(state, work));
    if (!painting.error.empty()) throw tracer::Error(painting.error);
    if (painting.picture) texture.upload(painting.picture->image);
  }

  // What a click in the picture does.
  void select(tracer::ivec2 pixel) {
    const tracer::Film& film = pipeline.snapshot()->film;
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= film.width || pixel.y >= film.height) {
      throw tracer::Error(fmt::format("pixel {},{} is outside the picture of {} x {} pixels",
                                      pixel.x, pixel.y, film.width, film.height));
    }
    state.selection.pixel = pixel;
  }

  // What the panel's button does.
  void measure_timeline() {
    const tracer::Settings& settings = edited.settings;
    work.timeline_of = std::make_shared<const tracer::Settings>(settings);
    work.timeline.result = std::make_shared<const tracer::Timeline>(tracer::measure_timeline(
        pipeline.snapshot()->rest, settings,
        tracer::one_swing(settings.deformer, settings.update, state.timeline.frames), {}));
  }
};

}  // namespace

void write_workspace_screenshot(const ScreenshotOptions& options,
                                const std::filesystem::path& file) {
  check(options);
  const Surfaceless context(options.width, options.height);
  Still still(options);
  still.settle();
  // Panels may edit what they show once there is a scene, such as the picture's size.
  ui::Edited traced;
  for (int i = 0; i < 4 && traced != still.edited; ++i) {
    still.trace();
    traced = still.edited;
    still.settle();
  }
  if (options.pixel) still.select(*options.pixel);
  if (!options.node.empty()) {
    still.state.selection.node = node_place(options.node, *still.pipeline.snapshot()->bvh);
  }
  for (int i = 0; i < 2; ++i) {  // the answers bring other questions
    still.settle();
    answer(still.work, still.asked, *still.pipeline.snapshot());
  }
  still.paint_picture();
  still.settle();
  still.draw(options.width, options.height);
  tracer::write_png(file, read_framebuffer(options.width, options.height));
}

}  // namespace app
