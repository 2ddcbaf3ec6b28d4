// bvhscope [SCENE]: the workspace in a window.
#include <memory>

#include "app/commands/command.h"
#include "app/commands/machine_limit.h"
#include "app/commands/number_from.h"
#include "app/commands/scene_options.h"
#include "app/commands/typed_settings.h"
#ifdef BVHSCOPE_GUI
#include "app/window/workspace_main.h"
#else
#include "tracer/error.h"
#endif

namespace app {
namespace {

struct WorkspaceCommand {
  SceneOptions scene;
  float scale = 0.0f;
  int frames = 0;
  bool timings = false;
};

#ifdef BVHSCOPE_GUI
void workspace(const WorkspaceCommand& command, CommandContext& context) {
  tracer::SavedSession session = resolve(command.scene);
  const MachineLimit limit(command.scene);
  if (has_display()) place_camera(command.scene, session.settings);
  WorkspaceOptions options;
  options.settings = session.settings;
  options.view = session.view;
  options.scale = command.scale;
  options.frames = command.frames;
  options.timings = command.timings;
  context.status = run_workspace(options);
}
#else
void workspace(const WorkspaceCommand&, CommandContext&) {
  throw tracer::Error(
      "this bvhscope was built without the workspace (BVHSCOPE_GUI=OFF); its commands work, see "
      "bvhscope --help");
}
#endif

}  // namespace

void add_workspace(CLI::App& program, CommandContext& context) {
  auto options = std::make_shared<WorkspaceCommand>();
  add_scene_options(program, options->scene, false);
  add_view_options(program, options->scene);
  program.get_option("--builder")->expected(1);
  program
      .add_option("--scale", options->scale, "Of text and controls; 0: what the screen asks for")
      ->type_name("FACTOR")
      ->check(number_from(0.0f, 4.0f))
      ->group("Window");
  program.add_option("--frames", options->frames, "Close the window after so many frames")
      ->type_name("N")
      ->check(number_from(0, 1000000))
      ->group("Window");
  program.add_flag("--timings", options->timings, "Print the frame times at the end")
      ->group("Window");
  program.callback([options, &program, &context] {
    if (program.get_subcommands().empty()) workspace(*options, context);
  });
}

}  // namespace app
