// bvhscope render: a scene to a picture.
#include <charconv>
#include <memory>

#include <fmt/format.h>

#include "app/commands/command.h"
#include "app/commands/interrupt.h"
#include "app/commands/machine_limit.h"
#include "app/commands/output_file.h"
#include "app/commands/run_pipeline.h"
#include "app/commands/scene_options.h"
#include "app/commands/typed_settings.h"
#include "tracer/choice.h"
#include "tracer/render/image_io.h"
#include "tracer/render/overlay.h"
#include "tracer/render/views.h"

namespace app {
namespace {

struct RenderCommand {
  SceneOptions scene;
  std::string output;
  std::optional<std::string> box_node;
  uint32_t box_instance = tracer::none;
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

// "tlas:12", or "3:12" for a node of the BLAS of mesh 3.
tracer::NodePlace parse_place(const std::string& text) {
  const auto number = [&](std::string_view word) {
    uint32_t value = 0;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || rest != word.data() + word.size()) {
      throw UsageError(fmt::format(
          "--box-node: '{}' is not a node; write tlas:NODE or MESH:NODE, as in 0:12", text));
    }
    return value;
  };
  const size_t colon = std::min(text.find(':'), text.size());
  const std::string_view tree = std::string_view(text).substr(0, colon);
  const std::string_view node = std::string_view(text).substr(std::min(colon + 1, text.size()));
  return {tree == "tlas" ? tracer::none : number(tree), number(node)};
}

void check_boxes(const RenderCommand& command, const tracer::BoxOptions& boxes) {
  const tracer::BoxSetRow* set = tracer::find_row(tracer::box_sets(), boxes.what);
  if (!boxes.show || set == nullptr || !set->of_selected || command.box_node) return;
  throw UsageError(fmt::format("--boxes {}: of which node? Add --box-node MESH:NODE", boxes.what));
}

tracer::NodeBoxes boxes_of(const RenderCommand& command, const tracer::Snapshot& snapshot,
                           const tracer::BoxOptions& options, const std::stop_token& stop) {
  tracer::BoxSources sources = tracer::box_sources(snapshot, options, tracer::Job{stop, {}});
  if (stop.stop_requested()) throw Interrupted{};
  if (command.box_node) sources.selected = parse_place(*command.box_node);
  sources.instance = command.box_instance;
  return tracer::node_boxes(snapshot.bvh, options, sources);
}

// Says what the picture does not show.
void warn(const tracer::NodeBoxes& boxes, CommandContext& context) {
  if (boxes.boxes.empty()) {
    context.error << "warning: --boxes: the trees have no such nodes\n";
  } else if (boxes.at_least || boxes.found > boxes.boxes.size()) {
    context.error << fmt::format("warning: --boxes: the largest {} of {}{} boxes are drawn\n",
                                 boxes.boxes.size(), boxes.at_least ? "more than " : "",
                                 boxes.found);
  }
}

std::string picture_bytes(const std::string& format, const tracer::Snapshot& snapshot,
                          const tracer::ViewOptions& view, const tracer::NodeBoxes& boxes) {
  const tracer::Film& film = snapshot.film;
  if (format == ".exr") return tracer::exr_bytes(film.width, film.height, radiance_of(film));
  if (format == ".hdr") return tracer::hdr_bytes(film.width, film.height, radiance_of(film));
  tracer::Picture picture = tracer::colorize(snapshot, view);
  if (view.boxes.show) tracer::draw_boxes(picture, snapshot, boxes, view.boxes);
  if (view.legend) tracer::draw_legend(picture, view);
  if (view.legend) tracer::draw_box_legend(picture, view.boxes);
  return tracer::png_bytes(picture.image);
}

void render(const RenderCommand& command, CommandContext& context) {
  tracer::SavedSession session = resolve(command.scene);
  check_format(command.output, session.view);
  check_output(command.output);
  check_boxes(command, session.view.boxes);
  if (command.box_node) parse_place(*command.box_node);
  // Every other view shows the first pass only.
  if (!is_radiance(session.view)) session.settings.render.samples = 1;

  const MachineLimit limit(command.scene);
  const InterruptWatch interrupt;
  tracer::Pipeline pipeline;
  const std::shared_ptr<const tracer::Snapshot> snapshot =
      run_pipeline(pipeline, command.scene, session.settings, interrupt.stop(), context);
  const std::string format = format_of(command.output);
  tracer::NodeBoxes boxes;
  if (session.view.boxes.show && format == ".png") {
    boxes = boxes_of(command, *snapshot, session.view.boxes, interrupt.stop());
    warn(boxes, context);
  }
  write_output(command.output, picture_bytes(format, *snapshot, session.view, boxes), context.out);
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
  command
      .add_option("--box-node", options->box_node,
                  "The node that --boxes is about: tlas:NODE or MESH:NODE")
      ->type_name("PLACE")
      ->group("Boxes");
  command
      .add_option("--box-instance", options->box_instance,
                  "Show that node through this instance only; otherwise through all of its mesh")
      ->type_name("N")
      ->group("Boxes");
  command.get_option("--builder")->expected(1);
  command.callback([options, &context] { render(*options, context); });
}

}  // namespace app
