// Running the pipeline: progress, warnings and failures.
#include "app/commands/run_pipeline.h"

#include <fmt/format.h>

#include "app/commands/progress_line.h"
#include "app/commands/typed_settings.h"
#include "tracer/error.h"

namespace app {
namespace {

using SnapshotPointer = std::shared_ptr<const tracer::Snapshot>;

void show(ProgressLine& line, const tracer::Snapshot& snapshot) {
  std::string doing = snapshot.doing;
  if (snapshot.stage == tracer::Stage::refine) {
    doing +=
        fmt::format(", sample {} of {}", snapshot.samples + 1, snapshot.settings.render.samples);
  }
  line.show(snapshot.progress, doing);
}

SnapshotPointer run(tracer::Pipeline& pipeline, const tracer::Settings& settings,
                    const std::stop_token& stop, CommandContext& context) {
  ProgressLine progress(context);
  pipeline.run(settings, stop, [&](const SnapshotPointer& snapshot) { show(progress, *snapshot); });
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
  if (!result->update.warning.empty()) {
    context.error << "warning: " << result->update.warning << '\n';
  }
  return result;
}

}  // namespace app
