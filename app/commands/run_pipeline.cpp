// Running the pipeline: progress, warnings and failures.
#include "app/commands/run_pipeline.h"

#include <chrono>

#include <fmt/format.h>

#include "tracer/error.h"

namespace app {
namespace {

using Clock = std::chrono::steady_clock;
using SnapshotPointer = std::shared_ptr<const tracer::Snapshot>;

// One line on a terminal that is written over and cleared at the end; nothing elsewhere.
class ProgressLine {
 public:
  explicit ProgressLine(CommandContext& context) : context_(context) {}
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() {
    if (drawn_) context_.error << "\r\x1b[K" << std::flush;
  }

  void show(const tracer::Snapshot& snapshot) {
    const auto now = Clock::now();
    if (!context_.error_is_terminal || now - last_ < std::chrono::milliseconds(100)) return;
    last_ = now;
    drawn_ = true;
    context_.error << fmt::format("\r\x1b[K{:3.0f} %  {}", 100.0f * snapshot.progress,
                                  snapshot.doing);
    if (snapshot.stage == tracer::Stage::refine) {
      context_.error << fmt::format(", sample {} of {}", snapshot.samples + 1,
                                    snapshot.settings.render.samples);
    }
    context_.error << std::flush;
  }

 private:
  CommandContext& context_;
  Clock::time_point last_ = Clock::now();
  bool drawn_ = false;
};

SnapshotPointer run(tracer::Pipeline& pipeline, const tracer::Settings& settings,
                    const std::stop_token& stop, CommandContext& context) {
  ProgressLine progress(context);
  pipeline.run(settings, stop, [&](const SnapshotPointer& snapshot) { progress.show(*snapshot); });
  const SnapshotPointer result = pipeline.snapshot();
  if (stop.stop_requested()) throw Interrupted{};
  if (!result->error.empty()) throw tracer::Error(result->error);
  return result;
}

}  // namespace

SnapshotPointer run_pipeline(tracer::Pipeline& pipeline, const SceneOptions& options,
                             tracer::Settings settings, const std::stop_token& stop,
                             CommandContext& context) {
  const uint64_t scenes_before = pipeline.snapshot()->scene_generation;
  if (has_camera(options)) {
    // A picture of one pixel tells which camera the scene brings.
    tracer::Settings one_pixel = settings;
    one_pixel.render = {.width = 1, .height = 1, .ray_depth = 0, .samples = 1, .shadows = false};
    settings.look = run(pipeline, one_pixel, stop, context)->settings.look;
    settings.look->camera = placed(options, settings.look->camera);
  }
  SnapshotPointer result = run(pipeline, settings, stop, context);
  if (result->scene_generation != scenes_before) {
    for (const std::string& warning : result->scene->warnings) {
      context.error << "warning: " << warning << '\n';
    }
  }
  return result;
}

}  // namespace app
