// How far a command is.
#include "app/commands/progress_line.h"

#include <fmt/format.h>

namespace app {

ProgressLine::~ProgressLine() {
  if (drawn_) context_.error << "\r\x1b[K" << std::flush;
}

void ProgressLine::show(float fraction, std::string_view doing) {
  const auto now = std::chrono::steady_clock::now();
  if (!context_.error_is_terminal || now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  drawn_ = true;
  context_.error << fmt::format("\r\x1b[K{:3.0f} %  {}", 100.0f * fraction, doing) << std::flush;
}

}  // namespace app
