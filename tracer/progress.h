// How a long job says how far it is, and learns that nobody waits for it any more.
#pragma once

#include <functional>
#include <stop_token>
#include <string_view>

namespace tracer {

struct Job {
  std::stop_token stop;
  // fraction 0..1; called by one thread at a time, at most a few hundred times.
  std::function<void(float fraction, std::string_view what)> report;

  bool stopped() const { return stop.stop_requested(); }
  void progress(float fraction, std::string_view what) const {
    if (report) report(fraction, what);
  }
};

}  // namespace tracer
