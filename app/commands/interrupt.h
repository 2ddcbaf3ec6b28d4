// Ctrl-C as a stop token.
#pragma once

#include <csignal>
#include <stop_token>
#include <thread>

#include <pthread.h>

namespace app {

// From its construction on, SIGINT and SIGTERM ask for a stop instead of ending the process, so a
// file that is being written is complete. Threads started meanwhile inherit this. The second
// signal ends the process at once.
class InterruptWatch {
 public:
  InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;
  ~InterruptWatch();

  std::stop_token stop() const { return source_.get_token(); }

 private:
  sigset_t before_{};
  std::stop_source source_;
  std::jthread thread_;
};

}  // namespace app
