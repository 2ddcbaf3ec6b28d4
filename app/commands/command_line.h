// The command line: which command runs, and what its failures look like.
#pragma once

#include <iosfwd>
#include <span>
#include <string>

namespace app {

enum ExitStatus : int {
  exit_fine = 0,
  exit_failed = 1,        // the job: the message says what, where and what to do
  exit_usage = 2,         // the command line
  exit_assertion = 3,     // a condition given with --assert does not hold
  exit_interrupted = 130  // Ctrl-C, as shells count it
};

// Runs one command line, given without the program's name, and gives the exit status. Throws
// nothing. "-" as an output file is `out`.
int run_command(std::span<const std::string> arguments, std::ostream& out, std::ostream& error);

}  // namespace app
