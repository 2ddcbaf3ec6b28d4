// bvhscope bench: build times and rays a second, beside what else was found to trace.
#include <memory>

#include <fmt/format.h>

#include "app/commands/command.h"
#include "app/commands/interrupt.h"
#include "app/commands/number_from.h"
#include "app/commands/one_of.h"
#include "app/commands/output_file.h"
#include "app/commands/progress_line.h"
#include "app/commands/run_pipeline.h"
#include "app/commands/scene_options.h"
#include "app/commands/typed_settings.h"
#include "app/peers/peers.h"
#include "tracer/analyze/benchmark.h"
#include "tracer/analyze/benchmark_report.h"
#include "tracer/bvh/flatten.h"
#include "tracer/bvh/ray_kernels.h"
#include "tracer/error.h"

namespace app {
namespace {

constexpr int quick_turns = 3;
constexpr int quick_width = 640, quick_height = 360;  // pixels

struct BenchCommand {
  SceneOptions scene;
  std::vector<std::string> layouts, kernels, classes;
  std::string json_file, csv_file, ray_file;
  std::optional<int> turns;
  bool quick = false, flatten = false, only_builds = false, no_peers = false;
};

tracer::BenchmarkOptions options_of(const BenchCommand& command, const tracer::Settings& settings) {
  tracer::BenchmarkOptions options;
  options.builds.assign(std::max<size_t>(command.scene.builders.size(), 1), settings.build);
  for (size_t i = 0; i < command.scene.builders.size(); ++i)
    options.builds[i].builder = command.scene.builders[i];
  options.layouts = command.layouts;
  options.kernels = command.kernels;
  options.classes = command.classes;
  options.isa = command.scene.isa.value_or("");
  options.fast = settings.render.fast;
  options.threads =
      command.scene.threads ? std::vector<int>{*command.scene.threads} : tracer::usual_threads();
  if (command.scene.size || !command.quick) {
    options.width = settings.render.width;
    options.height = settings.render.height;
  } else {
    options.width = quick_width;
    options.height = quick_height;
  }
  options.turns = command.turns.value_or(command.quick ? quick_turns : options.turns);
  options.rays = !command.only_builds;
  return options;
}

void check_kernels(const tracer::BenchmarkOptions& options) {
  for (const std::string& layout : chosen_layouts(options)) {
    if (!chosen_kernels(options, layout).empty()) return;
  }
  throw UsageError(
      "--kernel: none of the chosen layouts has it; see 'list layouts' and 'list "
      "kernels'");
}

void read_own_rays(const BenchCommand& command, tracer::BenchmarkOptions& options,
                   CommandContext& context) {
  if (command.ray_file.empty()) return;
  tracer::RayFile file = tracer::read_rays(command.ray_file);
  if (file.left_out > 0) {
    context.error << fmt::format(
        "warning: {}: {} rays were left out, since they cannot hit anything: not finite, without "
        "direction, or t_min above t_max\n",
        command.ray_file, file.left_out);
  }
  options.own_rays = std::move(file.rays);
  options.only_own_rays = command.classes.empty();
}

// The scene and camera, by way of the pipeline, whose cheapest tree and picture nobody wants.
std::shared_ptr<const tracer::Snapshot> load(const BenchCommand& command, tracer::Settings settings,
                                             const std::stop_token& stop, CommandContext& context) {
  settings.render = smallest_picture;
  settings.build = {};
  settings.build.builder = "lbvh";
  settings.update = {};
  tracer::Pipeline pipeline;
  return run_pipeline(pipeline, command.scene, settings, stop, context);
}

std::shared_ptr<const tracer::Scene> flat(const tracer::Snapshot& snapshot) {
  return std::make_shared<const tracer::Scene>(
      tracer::flattened(*snapshot.scene, snapshot.bvh->instances));
}

void write(const BenchCommand& command, const tracer::BenchmarkFacts& facts,
           const tracer::Benchmark& result, CommandContext& context) {
  if (!command.json_file.empty())
    write_output(command.json_file, benchmark_json(facts, result).dump(2) + "\n", context.out);
  if (!command.csv_file.empty()) write_output(command.csv_file, benchmark_csv(result), context.out);
  if (command.json_file != "-" && command.csv_file != "-")
    write_output("-", benchmark_text(facts, result), context.out);
}

void bench(const BenchCommand& command, CommandContext& context) {
  tracer::SavedSession session = resolve(command.scene);
  tracer::BenchmarkOptions options = options_of(command, session.settings);
  check_kernels(options);
  if (!command.json_file.empty()) check_output(command.json_file);
  if (!command.csv_file.empty()) check_output(command.csv_file);
  if (command.json_file == "-" && command.csv_file == "-")
    throw UsageError("--json and --csv: only one of them can go to standard output");
  read_own_rays(command, options, context);

  const InterruptWatch interrupt;
  const auto snapshot = load(command, session.settings, interrupt.stop(), context);
  const std::shared_ptr<const tracer::Scene> scene =
      command.flatten ? flat(*snapshot) : snapshot->scene;
  tracer::BenchmarkScene wanted{*scene, *snapshot->settings.look};
  if (!command.flatten) {
    wanted.time = session.settings.time;
    wanted.motion = session.settings.motion;
  }
  const std::span<const tracer::PeerRow> others =
      command.no_peers ? std::span<const tracer::PeerRow>() : peers();
  tracer::Benchmark result;
  {
    ProgressLine line(context);
    const tracer::Job job{interrupt.stop(), [&](float fraction, std::string_view what) {
                            line.show(fraction, what);
                          }};
    result = run_benchmark(wanted, options, others, job);
  }
  write(command, {*scene, options, others, command.no_peers ? "" : missing_peers()}, result,
        context);
  if (!result.complete) {
    context.error << "bvhscope: stopped; what had been measured was written\n";
    context.status = exit_interrupted;
  } else if (!result.faults.empty()) {
    throw tracer::Error(
        fmt::format("bench: {} of the rows answer rays otherwise than the others; "
                    "see the lines with DIFFERENT, first: {}",
                    result.faults.size(), result.faults.front()));
  }
}

void add_choices(CLI::App& command, BenchCommand& options) {
  // One of a kind elsewhere, several here.
  command.remove_option(command.get_option("--layout"));
  command.remove_option(command.get_option("--kernel"));
  command.add_option("--layout", options.layouts, "Layouts, see 'list layouts'; all if not given")
      ->type_name("L")
      ->check(one_of(tracer::layouts(), "layout"))
      ->group("Benchmark");
  command
      .add_option("--kernel", options.kernels,
                  "Ways to trace, see 'list kernels'; all that a layout has if not given")
      ->type_name("K")
      ->check(one_of(tracer::ray_kernels(), "kernel"))
      ->group("Benchmark");
  command
      .add_option("--class", options.classes,
                  "Classes of rays, see 'list bench-classes'; all if not given")
      ->type_name("CLASS")
      ->check(one_of(tracer::ray_set_rows(), "class of rays"))
      ->group("Benchmark");
}

void add_effort(CLI::App& command, BenchCommand& options) {
  command
      .add_option("--turns", options.turns,
                  "Measurements of each row, after one of warm-up; 5 if not given")
      ->type_name("N")
      ->check(number_from(1, tracer::max_turns))
      ->group("Benchmark");
  command
      .add_flag(
          "--quick", options.quick,
          fmt::format("{} turns and {} x {} pixels a view", quick_turns, quick_width, quick_height))
      ->group("Benchmark");
  command.add_flag("--builds-only", options.only_builds, "No rays")->group("Benchmark");
  command
      .add_flag("--flatten", options.flatten,
                "All instances become one mesh in the world, for both sides")
      ->group("Benchmark");
  command.add_flag("--no-peers", options.no_peers, "Measure ours alone")->group("Benchmark");
  command
      .add_option("--rays", options.ray_file,
                  "Trace the rays of this file instead (beside --class, if given): little-endian "
                  "floats, eight a ray: origin, t_min, direction, t_max")
      ->type_name("FILE")
      ->group("Benchmark");
}

}  // namespace

void add_bench(CLI::App& command, CommandContext& context) {
  auto options = std::make_shared<BenchCommand>();
  add_scene_options(command, options->scene, true);
  add_size_option(command, options->scene);
  add_choices(command, *options);
  add_effort(command, *options);
  command
      .add_option("--json", options->json_file, "Write the figures as JSON; - is standard output")
      ->type_name("FILE");
  command
      .add_option("--csv", options->csv_file,
                  "Write the figures as comma separated values; - is "
                  "standard output")
      ->type_name("FILE");
  command.callback([options, &context] { bench(*options, context); });
}

}  // namespace app
