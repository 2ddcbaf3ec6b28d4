// One kind of long work beside the session: measuring a tree, comparing builders, validating.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "app/window/low_priority_workers.h"
#include "app/window/turns.h"
#include "tracer/progress.h"
#include "ui/background.h"

namespace app {

// One thread of low priority, which does one piece of work at a time; the newest wins. All calls
// return at once and may come from any thread.
template <class Result>
class BackgroundRun {
 public:
  // For results of a part of the work; each replaces the one before.
  using Publish = std::function<void(Result)>;
  // Gives the result, of what was done by then if it was stopped; what it throws becomes the error.
  using Work = std::function<Result(const tracer::Job&, const Publish&)>;

  // `wake` is called from the run's thread after each change of state().
  BackgroundRun(Turns& turns, std::function<void()> wake)
      : turns_(turns),
        wake_(std::move(wake)),
        thread_([this](const std::stop_token& quit) { work(quit); }) {}
  BackgroundRun(const BackgroundRun&) = delete;
  BackgroundRun& operator=(const BackgroundRun&) = delete;
  ~BackgroundRun() {  // stops the work and waits for it
    const std::lock_guard lock(mutex_);
    waiting_.reset();
    thread_.request_stop();
    stop_.request_stop();
  }

  // Stops what runs and drops its result, then does this. With keep_result the result before stays
  // until this one is there.
  void start(TurnKind kind, Work work, bool keep_result = false) {
    const std::lock_guard lock(mutex_);
    stop_.request_stop();
    waiting_ = Order{kind, std::move(work)};
    ++number_;
    auto before = std::move(state_.result);
    state_ = {};
    if (keep_result) state_.result = std::move(before);
    state_.running = true;
    state_.doing = "waiting for other work";
    started_.notify_one();
  }

  // Stops what runs; its result of a part stays.
  void cancel() {
    const std::lock_guard lock(mutex_);
    stop_.request_stop();
    if (!std::exchange(waiting_, std::nullopt)) return;
    state_.running = false;
    state_.stopped = true;
  }

  // Stops what runs and drops the result.
  void forget() {
    const std::lock_guard lock(mutex_);
    stop_.request_stop();
    waiting_.reset();
    ++number_;
    state_ = {};
  }

  ui::Background<Result> state() const {
    const std::lock_guard lock(mutex_);
    return state_;
  }

 private:
  struct Order {
    TurnKind kind = TurnKind::computes;
    Work work;
  };

  // Changes the state unless the work of that number is not wanted any more.
  template <class Change>
  void change(uint64_t number, const Change& change) {
    {
      const std::lock_guard lock(mutex_);
      if (number != number_) return;
      change(state_);
    }
    wake_();
  }

  void work(const std::stop_token& quit) {
    lower_thread_priority(Priority::tracing);
    const LowPriorityWorkers workers;
    while (true) {
      Order order;
      uint64_t number = 0;
      std::stop_token stop;
      {
        std::unique_lock lock(mutex_);
        if (!started_.wait(lock, quit, [this] { return waiting_.has_value(); })) return;
        order = *std::exchange(waiting_, std::nullopt);
        number = number_;
        stop_ = {};
        stop = stop_.get_token();
      }
      if (turns_.begin(order.kind, stop)) {
        carry_out(order, number, stop);
        order.work = nullptr;  // what it holds goes before others get their turn
        turns_.end(order.kind);
      }
      change(number, [&](ui::Background<Result>& state) {
        state.running = false;
        state.stopped = stop.stop_requested();
      });
    }
  }

  void carry_out(const Order& order, uint64_t number, const std::stop_token& stop) {
    const tracer::Job job{stop, [&](float fraction, std::string_view what) {
                            change(number, [&](ui::Background<Result>& state) {
                              state.fraction = fraction;
                              state.doing = what;
                            });
                          }};
    const auto publish = [&](Result result) {
      auto shared = std::make_shared<const Result>(std::move(result));
      change(number, [&](ui::Background<Result>& state) { state.result = std::move(shared); });
    };
    std::string error;
    try {
      publish(order.work(job, publish));
    } catch (const std::bad_alloc&) {
      error = "there is not enough memory for it; close other programs or choose a smaller scene";
    } catch (const std::exception& caught) {
      error = caught.what();
    }
    if (!error.empty()) {
      change(number, [&](ui::Background<Result>& state) { state.error = error; });
    }
  }

  Turns& turns_;
  const std::function<void()> wake_;
  mutable std::mutex mutex_;
  std::condition_variable_any started_;
  std::optional<Order> waiting_;
  std::stop_source stop_;  // of what runs
  uint64_t number_ = 0;    // of what was started last
  ui::Background<Result> state_;
  std::jthread thread_;  // last: it uses everything above
};

}  // namespace app
