// A thread that waits for the signals: no handler, no global state.
#include "app/commands/interrupt.h"

#include <cstdlib>

namespace app {
namespace {

sigset_t watched_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGUSR1);  // from our own destructor: the watch is over
  return signals;
}

}  // namespace

InterruptWatch::InterruptWatch() {
  const sigset_t signals = watched_signals();
  pthread_sigmask(SIG_BLOCK, &signals, &before_);
  thread_ = std::jthread([signals, source = source_](const std::stop_token& over) mutable {
    int received = 0;
    while (sigwait(&signals, &received) == 0 && !over.stop_requested()) {
      if (received == SIGUSR1) continue;
      if (source.stop_requested()) std::_Exit(128 + received);
      source.request_stop();
    }
  });
}

InterruptWatch::~InterruptWatch() {
  thread_.request_stop();
  pthread_kill(thread_.native_handle(), SIGUSR1);
  thread_.join();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

}  // namespace app
