// bvhscope validate: whether a BVH is right.
#include "tracer/analyze/validate.h"

#include <memory>

#include <fmt/format.h>

#include "app/commands/command.h"
#include "app/commands/interrupt.h"
#include "app/commands/machine_limit.h"
#include "app/commands/number_from.h"
#include "app/commands/output_file.h"
#include "app/commands/progress_line.h"
#include "app/commands/run_pipeline.h"
#include "app/commands/scene_options.h"
#include "app/commands/typed_settings.h"
#include "tracer/analyze/validate_report.h"

namespace app {
namespace {

struct ValidateCommand {
  SceneOptions scene;
  std::string json_file;
  std::optional<uint64_t> rays;
};

tracer::Validation run_validation(const tracer::Snapshot& snapshot, uint64_t rays,
                                  const std::stop_token& stop, CommandContext& context) {
  ProgressLine line(context);
  const tracer::Job job{stop,
                        [&](float fraction, std::string_view what) { line.show(fraction, what); }};
  tracer::Validation validation = tracer::validate(*snapshot.scene, *snapshot.bvh, rays, job);
  if (stop.stop_requested()) throw Interrupted{};
  return validation;
}

void validate(const ValidateCommand& command, CommandContext& context) {
  tracer::SavedSession session = resolve(command.scene);
  if (!command.json_file.empty()) check_output(command.json_file);
  session.settings.render = smallest_picture;

  const MachineLimit limit(command.scene);
  const InterruptWatch interrupt;
  tracer::Pipeline pipeline;
  const std::shared_ptr<const tracer::Snapshot> snapshot =
      run_pipeline(pipeline, command.scene, session.settings, interrupt.stop(), context);
  const uint64_t rays = command.rays.value_or(tracer::default_ray_count(*snapshot->scene));
  const tracer::Validation validation = run_validation(*snapshot, rays, interrupt.stop(), context);
  if (!command.json_file.empty()) {
    const tracer::Json json = tracer::validation_json(*snapshot, validation);
    write_output(command.json_file, json.dump(2) + "\n", context.out);
  }
  if (command.json_file != "-") {
    write_output("-", tracer::validation_text(*snapshot, validation), context.out);
  }
  if (tracer::has_errors(validation)) context.status = exit_failed;
}

}  // namespace

void add_validate(CLI::App& command, CommandContext& context) {
  auto options = std::make_shared<ValidateCommand>();
  add_scene_options(command, options->scene, true);
  command
      .add_option("--json", options->json_file, "Write the findings as JSON; - is standard output")
      ->type_name("FILE");
  command
      .add_option("--rays", options->rays,
                  "Rays to compare with brute force; as many as take seconds if not given")
      ->type_name("N")
      ->check(number_from<uint64_t>(0, tracer::max_validation_rays));
  command.get_option("--builder")->expected(1);
  command.callback([options, &context] { validate(*options, context); });
}

}  // namespace app
