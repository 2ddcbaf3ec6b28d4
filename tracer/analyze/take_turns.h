// Timing several ways to do the same in turns, so that what else the machine does hits all alike.
#pragma once

#include <functional>
#include <span>
#include <stop_token>
#include <vector>

namespace tracer {

// Of several measurements: the median and the quartiles around it.
struct Spread {
  double median = 0.0, low = 0.0, high = 0.0;
  bool operator==(const Spread&) const = default;
};

// Quartiles are interpolated between neighbours. Nothing gives zeros.
Spread spread_of(std::vector<double> values);

// Runs `work` with at most so many threads, the calling one among them.
void with_threads(int threads, const std::function<void()>& work);

// Seconds that the work takes with so many threads: for one the processor's time of the calling
// thread, which no other program disturbs, for several the clock on the wall.
double seconds_of(int threads, const std::function<void()>& work);

struct TurnOptions {
  int threads = 1;
  int turns = 5;                 // measured ones, after one of warm-up; at least 1
  double enough_seconds = 1e30;  // no further turn once all together have taken so long
  std::stop_token stop = {};
};

// a, b, c, a, b, c, ...: the seconds of each, without the warm-up. warm(i) is called after the
// warm-up of work i; turn(n) before each turn, the warm-up being 0. Nothing was measured of a work
// whose vector is empty: it was stopped.
std::vector<std::vector<double>> take_turns(std::span<const std::function<void()>> works,
                                            const TurnOptions& options,
                                            const std::function<void(size_t)>& warm,
                                            const std::function<void(int)>& turn);

}  // namespace tracer
