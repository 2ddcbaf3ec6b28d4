// Clocks and turns.
#include "tracer/analyze/take_turns.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "tracer/clock.h"

namespace tracer {
namespace {

double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * double(sorted.size() - 1);
  const size_t below = size_t(at);
  const size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - double(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.5), quantile(values, 0.25), quantile(values, 0.75)};
}

void with_threads(int threads, const std::function<void()>& work) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
  tbb::task_arena arena(threads);
  arena.execute(work);
}

double seconds_of(int threads, const std::function<void()>& work) {
  if (threads == 1) {
    const double start = thread_seconds();
    work();
    return thread_seconds() - start;
  }
  const auto start = Clock::now();
  work();
  return 1e-3 * ms_since(start);
}

std::vector<std::vector<double>> take_turns(std::span<const std::function<void()>> works,
                                            const TurnOptions& options,
                                            const std::function<void(size_t)>& warm,
                                            const std::function<void(int)>& turn) {
  std::vector<std::vector<double>> seconds(works.size());
  const auto start = Clock::now();
  with_threads(options.threads, [&] {
    for (int n = 0; n <= options.turns; ++n) {
      if (n > 1 && ms_since(start) > 1e3 * options.enough_seconds) return;
      if (turn) turn(n);
      for (size_t i = 0; i < works.size(); ++i) {
        if (options.stop.stop_requested()) return;
        const double taken = seconds_of(options.threads, works[i]);
        if (options.stop.stop_requested()) return;  // the work may have been cut short
        if (n > 0) {
          seconds[i].push_back(taken);
        } else if (warm) {
          warm(i);
        }
      }
    }
  });
  return seconds;
}

}  // namespace tracer
