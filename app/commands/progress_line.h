// How far a command is, as one line on a terminal.
#pragma once

#include <chrono>
#include <string_view>

#include "app/commands/command.h"

namespace app {

// The line is written over, at most ten times a second, and cleared at the end; nothing is shown
// where the error stream is no terminal.
class ProgressLine {
 public:
  explicit ProgressLine(CommandContext& context) : context_(context) {}
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine();

  void show(float fraction, std::string_view doing);  // fraction 0..1

 private:
  CommandContext& context_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  bool drawn_ = false;
};

}  // namespace app
