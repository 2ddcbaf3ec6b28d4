// What a command knows of the program around it, and the table of the commands.
#pragma once

#include <ostream>
#include <stdexcept>
#include <string_view>

#include <CLI/CLI.hpp>

#include "app/commands/command_line.h"

namespace app {

// Where a command writes, and where it leaves its exit status.
struct CommandContext {
  std::ostream& out;
  std::ostream& error;
  bool error_is_terminal = false;  // then progress is shown
  int status = exit_fine;
};

// Thrown for what is wrong with the command line itself: exit status 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Adds the command's options to `command`, and its work as a callback that may throw tracer::Error
// and UsageError. The context outlives the command.
struct CommandRow {
  std::string_view id, help;
  void (*add)(CLI::App& command, CommandContext& context);
};

void add_workspace(CLI::App& program, CommandContext& context);  // what runs without a command
void add_render(CLI::App& command, CommandContext& context);
void add_report(CLI::App& command, CommandContext& context);
void add_bench(CLI::App& command, CommandContext& context);
void add_timeline(CLI::App& command, CommandContext& context);
void add_trace(CLI::App& command, CommandContext& context);
void add_validate(CLI::App& command, CommandContext& context);
void add_screenshot(CLI::App& command, CommandContext& context);
void add_list(CLI::App& command, CommandContext& context);

}  // namespace app
