// Work whose result panels ask for anew in each frame in which they show it.
#pragma once

#include <optional>
#include <utility>

#include "app/window/background_run.h"

namespace app {

// A BackgroundRun that knows what it was started for last. Wanted is equal for what has the same
// result.
template <class Wanted, class Result>
class KeptRun {
 public:
  KeptRun(Turns& turns, std::function<void()> wake) : run_(turns, std::move(wake)) {}

  // make(job) gives the result; it runs unless it was started for the same last. The older result
  // stays until the new one is there.
  template <class Make>
  void keep(Wanted wanted, Make make) {
    if (wanted_ == wanted) return;
    wanted_ = std::move(wanted);
    run_.start(
        TurnKind::computes,
        [make = std::move(make)](const tracer::Job& job, const auto&) { return make(job); }, true);
  }

  // Stops what runs and drops the result.
  void forget() {
    wanted_.reset();
    run_.forget();
  }

  const std::optional<Wanted>& wanted() const { return wanted_; }
  ui::Background<Result> state() const { return run_.state(); }

 private:
  std::optional<Wanted> wanted_;
  BackgroundRun<Result> run_;
};

}  // namespace app
