#include "app/window/screenshot.h"

#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

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
  }

  void paint_picture() {
    painting = paint(pipeline.snapshot(), edited.view, ui::box_sources(state, work));
    if (!painting.error.empty()) throw tracer::Error(painting.error);
    if (painting.picture) texture.upload(painting.picture->image);
  }

  // What panels on show ask for in each frame.
  void inspect() {
    const tracer::Snapshot& traced = *pipeline.snapshot();
    if (asked.inspect) {
      work.inspection.result = std::make_shared<const tracer::Inspection>(
          tracer::inspect(traced.bvh, work.inspection.result.get(), {}));
    }
    if (asked.count_visits) {
      work.visits.result =
          std::make_shared<const tracer::CountedVisits>(counted_visits(traced, {}));
    }
    if (asked.hot_spots) {
      work.hot_spots.result = std::make_shared<const tracer::HotSpots>(
          tracer::hot_spots(*traced.scene, work.inspection.result, work.visits.result,
                            *asked.hot_spots, most_hot_spots, {}));
    }
    if (asked.icicle) {
      work.icicle.result = std::make_shared<const tracer::Icicle>(
          tracer::make_icicle(tracer::icicle_sources(*asked.icicle, work.inspection.result,
                                                     work.visits.result, work.measures.result),
                              {}));
    }
    if (asked.replay) {
      const uint32_t mesh = *asked.replay;
      const tracer::Inspection& inspection = *work.inspection.result;
      work.replay.result = std::make_shared<const tracer::Replay>(replay_of(
          mesh == tracer::none ? inspection.tlas : inspection.blases[mesh], traced.bvh->options));
    }
  }

  // What a click in the picture does.
  void select(tracer::ivec2 pixel) {
    const tracer::Film& film = pipeline.snapshot()->film;
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= film.width || pixel.y >= film.height) {
      throw tracer::Error(fmt::format("pixel {},{} is outside the picture of {} x {} pixels",
                                      pixel.x, pixel.y, film.width, film.height));
    }
    state.selection.pixel = pixel;
    settle();
    if (!asked.log_rays) return;
    work.rays.result =
        std::make_shared<const ui::LoggedRays>(logged(*asked.log_rays, *pipeline.snapshot()));
    settle();
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
  still.inspect();
  still.paint_picture();
  still.settle();
  if (options.pixel) still.select(*options.pixel);
  still.draw(options.width, options.height);
  tracer::write_png(file, read_framebuffer(options.width, options.height));
}

}  // namespace app
