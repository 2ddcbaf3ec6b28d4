// bvhscope report: what a BVH is like and what its rays cost, for one builder or several.
#include "tracer/analyze/report.h"

#include <memory>

#include "app/commands/assertion.h"
#include "app/commands/command.h"
#include "app/commands/interrupt.h"
#include "app/commands/machine_limit.h"
#include "app/commands/output_file.h"
#include "app/commands/run_pipeline.h"
#include "app/commands/scene_options.h"
#include "app/commands/typed_settings.h"

namespace app {
namespace {

// The first pass counts; the others measure the speed.
constexpr int default_samples = 5;

struct ReportCommand {
  SceneOptions scene;
  std::string json_file;
  std::vector<std::string> assertions;
};

void report(const ReportCommand& command, CommandContext& context) {
  tracer::SavedSession session = resolve(command.scene);
  if (!command.scene.samples) session.settings.render.samples = default_samples;
  std::vector<Assertion> assertions;
  for (const std::string& text : command.assertions)
    assertions.push_back(parse_assertion(text));
  if (!command.json_file.empty()) check_output(command.json_file);
  std::vector<std::string> builders = command.scene.builders;
  if (builders.empty()) builders = {session.settings.build.builder};

  const MachineLimit limit(command.scene);
  const InterruptWatch interrupt;
  tracer::Pipeline pipeline;
  std::vector<std::shared_ptr<const tracer::Snapshot>> snapshots;
  for (const std::string& builder : builders) {
    session.settings.build.builder = builder;
    snapshots.push_back(
        run_pipeline(pipeline, command.scene, session.settings, interrupt.stop(), context));
  }
  const tracer::Json json = tracer::report_json(snapshots, interrupt.stop());
  if (interrupt.stop().stop_requested()) throw Interrupted{};
  std::vector<std::string> failed;  // an unknown field is told before anything is written
  for (const Assertion& assertion : assertions)
    failed.push_back(failures(assertion, json));
  if (!command.json_file.empty()) {
    write_output(command.json_file, json.dump(2) + "\n", context.out);
  }
  if (command.json_file != "-") write_output("-", tracer::report_text(json), context.out);

  for (size_t i = 0; i < assertions.size(); ++i) {
    if (failed[i].empty()) continue;
    context.error << "assertion '" << assertions[i].text << "' does not hold\n" << failed[i];
    context.status = exit_assertion;
  }
}

}  // namespace

void add_report(CLI::App& command, CommandContext& context) {
  auto options = std::make_shared<ReportCommand>();
  add_scene_options(command, options->scene, true);
  add_size_option(command, options->scene);
  command
      .add_option("--json", options->json_file, "Write the report as JSON; - is standard output")
      ->type_name("FILE");
  command
      .add_option("--assert", options->assertions,
                  "Exit with status 3 unless this holds for every build, as in 'sah<40'; fields "
                  "are those of --json")
      ->type_name("CONDITION");
  command.callback([options, &context] { report(*options, context); });
}

}  // namespace app
