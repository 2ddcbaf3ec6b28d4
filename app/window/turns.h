// Who may use the processor: times are only worth something if nobody else computes.
#pragma once

#include <condition_variable>
#include <mutex>
#include <stop_token>

#include "app/window/session.h"

namespace app {

enum class TurnKind { computes, measures_time };

// Any number may compute at once, beside the session. Whoever measures time does so alone: he waits
// for those who compute, others wait for him, and the session is paused meanwhile.
class Turns {
 public:
  explicit Turns(Session& session) : session_(session) {}

  // Waits for the turn; false if stopped before. After true, end must follow.
  bool begin(TurnKind kind, const std::stop_token& stop);
  void end(TurnKind kind);

  bool measuring() const;

 private:
  Session& session_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  int computing_ = 0;
  bool measuring_ = false;
};

}  // namespace app
