// bvhscope render: a scene to a picture.
#include <memory>

#include <fmt/format.h>

#include "app/commands/command.h"
#include "app/commands/interrupt.h"
#include "app/commands/output_file.h"
#include "app/commands/run_pipeline.h"
#include "app/commands/scene_options.h"
#include "app/commands/thread_limit.h"
#include "tracer/choice.h"
#include "tracer/render/colorize.h"
#include "tracer/render/image_io.h"
#include "tracer/render/views.h"

namespace app {
namespace {

struct RenderCommand {
  SceneOptions scene;
  std::string output;
};

bool is_radiance(const tracer::ViewOptions& view) {
  return tracer::find_row(tracer::views(), view.view)->kind == tracer::ViewKind::radiance;
}

// The ending, lower case; "-" writes PNG.
std::string format_of(const std::filesystem::path& file) {
  if (file == "-") return ".png";
  std::string ending = file.extension().string();
  for (char& letter : ending)
    letter = char(std::tolower(static_cast<unsigned char>(letter)));
  return ending;
}

void check_format(const std::string& output, const tracer::ViewOptions& view) {
  const std::string format = format_of(output);
  if (format != ".png" && format != ".exr" && format != ".hdr") {
    throw UsageError(fmt::format("-o '{}': pictures are .png, .exr or .hdr files", output));
  }
  if (format != ".png" && !is_radiance(view)) {
    throw UsageError(fmt::format(
        "{}: {} files hold light, so they go with --view shaded only; write a .png for --view {}",
        output, format, view.view));
  }
}

std::string picture_bytes(const std::string& format, const tracer::Snapshot& snapshot,
                          const tracer::ViewOptions& view) {
  const tracer::Film& film = snapshot.film;
  if (format == ".exr") return tracer::exr_bytes(film.width, film.height, radiance_of(film));
  if (format == ".hdr") return tracer::hdr_bytes(film.width, film.height, radiance_of(film));
  tracer::Picture picture = tracer::colorize(snapshot, view);
  if (view.legend) tracer::draw_legend(picture, view);
  return tracer::png_bytes(picture.image);
}

void render(const RenderCommand& command, CommandContext& context) {
  tracer::SavedSession session = resolve(command.scene);
  check_format(command.output, session.view);
  check_output(command.output);
  // Every other view shows the first pass only.
  if (!is_radiance(session.view)) session.settings.render.samples = 1;

  const ThreadLimit threads(command.scene.threads);
  const InterruptWatch interrupt;
  tracer::Pipeline pipeline;
  const std::shared_ptr<const tracer::Snapshot> snapshot =
      run_pipeline(pipeline, command.scene, session.settings, interrupt.stop(), context);
  write_output(command.output, picture_bytes(format_of(command.output), *snapshot, session.view),
               context.out);
}

}  // namespace

void add_render(CLI::App& command, CommandContext& context) {
  auto options = std::make_shared<RenderCommand>();
  add_scene_options(command, options->scene, true);
  add_size_option(command, options->scene);
  add_view_options(command, options->scene);
  command
      .add_option("-o,--output", options->output,
                  "Picture: .png with colours, .exr or .hdr with light; - writes a PNG to "
                  "standard output")
      ->type_name("FILE")
      ->required();
  command.get_option("--builder")->expected(1);
  command.callback([options, &context] { render(*options, context); });
}

}  // namespace app
