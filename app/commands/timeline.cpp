// bvhscope timeline: what refitting and rebuilding cost over the frames of an animation.
#include "tracer/analyze/timeline.h"

#include <charconv>
#include <memory>

#include <fmt/format.h>

#include "app/commands/command.h"
#include "app/commands/interrupt.h"
#include "app/commands/machine_limit.h"
#include "app/commands/one_of.h"
#include "app/commands/output_file.h"
#include "app/commands/progress_line.h"
#include "app/commands/run_pipeline.h"
#include "app/commands/scene_options.h"
#include "app/commands/typed_settings.h"
#include "tracer/analyze/timeline_report.h"
#include "tracer/error.h"

namespace app {
namespace {

struct TimelineCommand {
  SceneOptions scene;
  std::string frames;
  std::vector<std::string> strategies;
  std::string json_file;
};

// "A:B" or "A:B:STEP".
void parse_frames(const std::string& text, tracer::TimelineOptions& options) {
  int64_t* const parts[] = {&options.from, &options.to, &options.step};
  options.step = 1;
  const char* at = text.data();
  const char* const end = at + text.size();
  size_t count = 0;
  for (; count < std::size(parts); ++count) {
    const auto [rest, error] = std::from_chars(at, end, *parts[count]);
    at = rest;
    if (error != std::errc() || (rest != end && *rest != ':')) {
      count = 0;
      break;
    }
    if (rest == end) break;
    ++at;
  }
  const bool in_order = options.from >= 0 && options.to >= options.from &&
                        options.to <= tracer::last_frame && options.step >= 1;
  if (at != end || (count != 1 && count != 2) || !in_order) {
    throw UsageError(fmt::format(
        "--frames: '{}' is not a range of frames; write A:B or A:B:STEP with 0 <= A <= B", text));
  }
  if ((options.to - options.from) / options.step >= tracer::max_timeline_frames) {
    throw UsageError(
        fmt::format("--frames: '{}' are more than {} frames to measure; write a larger "
                    "STEP",
                    text, tracer::max_timeline_frames));
  }
}

void timeline(const TimelineCommand& command, CommandContext& context) {
  tracer::SavedSession session = resolve(command.scene);
  tracer::Settings& settings = session.settings;
  if (!tracer::is_active(settings.deformer)) {
    throw UsageError(
        "timeline: nothing is deformed; choose a deformer, as in --deform twist (see 'list "
        "deformers'), with an --amount other than 0");
  }
  tracer::TimelineOptions options = tracer::one_swing(settings.deformer, settings.update);
  if (!command.frames.empty()) parse_frames(command.frames, options);
  if (!command.strategies.empty()) options.strategies = command.strategies;
  if (command.scene.size) {
    options.width = settings.render.width;
    options.height = settings.render.height;
  }
  if (!command.json_file.empty()) check_output(command.json_file);
  // The pipeline loads the scene and places the camera; its picture is not wanted.
  const tracer::RenderOptions wanted = settings.render;
  tracer::Settings one_pixel = settings;
  one_pixel.render = {.width = 1, .height = 1, .ray_depth = 0, .samples = 1, .shadows = false};
  one_pixel.deformer = {};

  const MachineLimit limit(command.scene);
  const InterruptWatch interrupt;
  tracer::Pipeline pipeline;
  const std::shared_ptr<const tracer::Snapshot> snapshot =
      run_pipeline(pipeline, command.scene, one_pixel, interrupt.stop(), context);
  settings.look = snapshot->settings.look;
  settings.render = wanted;
  tracer::Timeline result;
  {
    ProgressLine line(context);
    const tracer::Job job{interrupt.stop(), [&](float fraction, std::string_view what) {
                            line.show(fraction, what);
                          }};
    result = tracer::measure_timeline(snapshot->rest, settings, options, job);
  }
  if (interrupt.stop().stop_requested()) throw Interrupted{};
  if (!result.warning.empty()) context.error << "warning: " << result.warning << '\n';
  if (!command.json_file.empty()) {
    const tracer::Json json = tracer::timeline_json(*snapshot->rest, result);
    write_output(command.json_file, json.dump(2) + "\n", context.out);
  }
  if (command.json_file != "-") write_output("-", tracer::timeline_text(result), context.out);
}

}  // namespace

void add_timeline(CLI::App& command, CommandContext& context) {
  auto options = std::make_shared<TimelineCommand>();
  add_scene_options(command, options->scene, true);
  add_size_option(command, options->scene);
  command
      .add_option("--frames", options->frames,
                  "Frames to measure; one swing of the deformer if not given")
      ->type_name("A:B[:STEP]");
  command
      .add_option("--strategy", options->strategies,
                  "Update strategies to measure, see 'list updates'; refit, every and rebuild if "
                  "not given")
      ->type_name("U")
      ->check(one_of(tracer::updates(), "update strategy"));
  command
      .add_option("--json", options->json_file, "Write the curves as JSON; - is standard output")
      ->type_name("FILE");
  command.get_option("--builder")->expected(1);
  command.callback([options, &context] { timeline(*options, context); });
}

}  // namespace app
