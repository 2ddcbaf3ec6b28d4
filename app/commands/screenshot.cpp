// bvhscope screenshot: the whole workspace as a picture, without a display.
#include "app/window/screenshot.h"

#include <memory>

#include "app/commands/command.h"
#include "app/commands/machine_limit.h"
#include "app/commands/number_from.h"
#include "app/commands/output_file.h"
#include "app/commands/scene_options.h"
#include "app/commands/typed_numbers.h"
#include "app/commands/typed_settings.h"

namespace app {
namespace {

struct ScreenshotCommand {
  SceneOptions scene;
  std::string output;
  std::string pixel;
  std::string window = "1600x900";
  std::vector<std::string> panels;
  std::string node;
  float scale = 1.0f;
};

void screenshot(const ScreenshotCommand& command) {
  tracer::SavedSession session = resolve(command.scene);
  const glm::ivec2 window = parse_size(command.window, "--window");
  check_output(command.output);
  const MachineLimit limit(command.scene);
  place_camera(command.scene, session.settings);
  ScreenshotOptions options;
  options.settings = session.settings;
  options.view = session.view;
  options.width = window.x;
  options.height = window.y;
  options.scale = command.scale;
  options.panels = command.panels;
  if (!command.pixel.empty()) options.pixel = parse_pixel(command.pixel, "--pixel");
  options.node = command.node;
  write_workspace_screenshot(options, command.output);
}

}  // namespace

void add_screenshot(CLI::App& command, CommandContext&) {
  auto options = std::make_shared<ScreenshotCommand>();
  add_scene_options(command, options->scene, true);
  add_view_options(command, options->scene);
  command.get_option("--builder")->expected(1);
  command.add_option("-o,--output", options->output, "Picture, .png; - is standard output")
      ->type_name("FILE")
      ->required();
  command.add_option("--window", options->window, "Size of the workspace in pixels")
      ->type_name("WxH")
      ->capture_default_str();
  command
      .add_option("--panel", options->panels,
                  "Bring this panel to the front of its region, as build or statistics; several "
                  "times for several regions")
      ->type_name("ID");
  command
      .add_option("--pixel", options->pixel,
                  "Select this pixel of the picture, as a click does; --panel ray shows its rays")
      ->type_name("X,Y");
  command
      .add_option("--node", options->node,
                  "Select this node: tlas:3 of the TLAS, 0:12 of the BLAS of mesh 0")
      ->type_name("TREE:NODE");
  command.add_option("--scale", options->scale, "Of text and controls")
      ->type_name("FACTOR")
      ->check(number_from(0.5f, 4.0f));
  command.callback([options] { screenshot(*options); });
}

}  // namespace app
