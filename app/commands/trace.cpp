// bvhscope trace: the rays of one pixel, step by step.
#include <algorithm>
#include <charconv>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "app/commands/command.h"
#include "app/commands/interrupt.h"
#include "app/commands/machine_limit.h"
#include "app/commands/output_file.h"
#include "app/commands/run_pipeline.h"
#include "app/commands/scene_options.h"
#include "app/commands/typed_numbers.h"
#include "app/commands/typed_settings.h"
#include "tracer/analyze/ray_log_report.h"

namespace app {
namespace {

struct TraceCommand {
  SceneOptions scene;
  std::string pixel;
  std::string ray = "0";
  std::string json_file;
};

tracer::ivec2 pixel_in(const std::string& text, const tracer::RenderOptions& picture) {
  const tracer::ivec2 pixel = parse_pixel(text, "--pixel");
  if (pixel.x < 0 || pixel.y < 0 || pixel.x >= picture.width || pixel.y >= picture.height) {
    throw UsageError(fmt::format(
        "--pixel: {},{} is outside the picture; of {} x {} pixels X goes from 0 to {} and Y from 0 "
        "to {}",
        pixel.x, pixel.y, picture.width, picture.height, picture.width - 1, picture.height - 1));
  }
  return pixel;
}

// Which rays' steps are printed: one (an index), all, or none.
struct PrintedRays {
  size_t from = 0, to = std::numeric_limits<size_t>::max();  // to: past the last
};

PrintedRays parse_rays(const std::string& text) {
  if (text == "all") return {};
  if (text == "none") return {0, 0};
  size_t ray = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, ray);
  if (error != std::errc() || rest != end) {
    throw UsageError(fmt::format(
        "--ray: '{}' is not the number of a ray; write 0 for the primary ray, all or none", text));
  }
  return {ray, ray + 1};
}

std::vector<size_t> indices(const PrintedRays& wanted, size_t count) {
  const bool one = wanted.to == wanted.from + 1;
  if (one && wanted.from >= count) {
    throw UsageError(fmt::format("--ray: {} is none of the pixel's rays, which are 0 to {}",
                                 wanted.from, count - 1));
  }
  std::vector<size_t> rays;
  for (size_t i = wanted.from; i < std::min(wanted.to, count); ++i)
    rays.push_back(i);
  return rays;
}

void trace(const TraceCommand& command, CommandContext& context) {
  tracer::SavedSession session = resolve(command.scene);
  const tracer::RenderOptions picture = session.settings.render;
  const tracer::ivec2 pixel = pixel_in(command.pixel, picture);
  const PrintedRays printed = parse_rays(command.ray);
  if (!command.json_file.empty()) check_output(command.json_file);
  session.settings.render = smallest_picture;

  const MachineLimit limit(command.scene);
  const InterruptWatch interrupt;
  tracer::Pipeline pipeline;
  tracer::Snapshot snapshot =
      *run_pipeline(pipeline, command.scene, session.settings, interrupt.stop(), context);
  snapshot.settings.render = picture;
  const tracer::Look& look = *snapshot.settings.look;
  const tracer::World world{*snapshot.scene, *snapshot.bvh, look, picture};
  const tracer::RayLog log = tracer::log_pixel(
      world, snapshot.bvh, tracer::frame(look.camera, picture.width, picture.height), pixel);
  const std::vector<size_t> rays = indices(printed, log.rays.size());
  if (!command.json_file.empty()) {
    write_output(command.json_file, tracer::ray_log_json(snapshot, log).dump(2) + "\n",
                 context.out);
  }
  if (command.json_file != "-") {
    write_output("-", tracer::ray_log_text(snapshot, log, rays), context.out);
  }
}

}  // namespace

void add_trace(CLI::App& command, CommandContext& context) {
  auto options = std::make_shared<TraceCommand>();
  add_scene_options(command, options->scene, true);
  add_size_option(command, options->scene);
  command
      .add_option("--pixel", options->pixel,
                  "The pixel whose rays are traced, from the upper left corner")
      ->type_name("X,Y")
      ->required();
  command
      .add_option("--ray", options->ray,
                  "The ray whose steps are printed, as numbered in the list; all or none")
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option("--json", options->json_file,
                  "Write all rays with all steps as JSON; - is standard output")
      ->type_name("FILE");
  command.get_option("--builder")->expected(1);
  command.callback([options, &context] { trace(*options, context); });
}

}  // namespace app
