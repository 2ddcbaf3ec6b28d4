// Finds the command, runs it, and turns exceptions into one message and an exit status.
#include "app/commands/command_line.h"

#include <algorithm>
#include <exception>
#include <iostream>
#include <new>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "app/commands/command.h"
#include "app/commands/run_pipeline.h"
#include "tracer/error.h"
#include "tracer/machine.h"

namespace app {
namespace {

constexpr CommandRow rows[] = {
    {"render", "A picture of a scene: shaded, a debug view or a heat map", add_render},
    {"report", "Statistics and measured ray costs of one or more builders", add_report},
    {"bench", "Build times and rays a second, beside Embree", add_bench},
    {"timeline", "What refitting and rebuilding deformed meshes cost, frame by frame",
     add_timeline},
    {"trace", "The rays of one pixel, with every step of their traversal", add_trace},
    {"validate", "Whether a BVH is right: rules for its trees, and brute force", add_validate},
#ifdef BVHSCOPE_GUI
    {"screenshot", "A picture of the whole workspace; needs no display", add_screenshot},
#endif
    {"list", "What can be chosen: scenes, builders, views, ...", add_list},
};

int parse_and_run(CLI::App& program, std::vector<std::string> arguments, CommandContext& context) {
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
  try {
    program.parse(std::move(arguments));
    if (!context.out.flush()) throw tracer::Error("standard output: cannot be written");
    return context.status;
  } catch (const CLI::Success& help) {
    return program.exit(help, context.out, context.error);
  } catch (const CLI::ParseError& wrong) {
    context.error << "bvhscope: " << wrong.what() << "\nSee bvhscope --help.\n";
    return exit_usage;
  } catch (const UsageError& wrong) {
    context.error << "bvhscope: " << wrong.what() << "\nSee bvhscope --help.\n";
    return exit_usage;
  } catch (const Interrupted&) {
    context.error << "bvhscope: stopped; nothing was written\n";
    return exit_interrupted;
  } catch (const tracer::Error& failure) {
    context.error << "bvhscope: " << failure.what() << '\n';
  } catch (const std::bad_alloc&) {
    context.error << "bvhscope: out of memory; use a smaller scene or picture\n";
  } catch (const std::exception& failure) {
    context.error << "bvhscope: " << failure.what() << '\n';
  }
  return exit_failed;
}

}  // namespace

int run_command(std::span<const std::string> arguments, std::ostream& out, std::ostream& error) {
  CommandContext context{out, error, &error == &std::cerr && isatty(STDERR_FILENO) == 1};
  CLI::App program("The debugger for bounding volume hierarchies.", "bvhscope");
  program.set_version_flag("--version", fmt::format("bvhscope {}", tracer::version()));
  program.require_subcommand(0, 1);
  program.footer(
      "Without a command the scene opens in the workspace.\n"
      "Exit status: 0 fine, 1 failed, 2 wrong usage, 3 an assertion does not hold.");
  add_workspace(program, context);
  for (const CommandRow& row : rows) {
    row.add(*program.add_subcommand(std::string(row.id), std::string(row.help)), context);
  }
  return parse_and_run(program, {arguments.begin(), arguments.end()}, context);
}

}  // namespace app
