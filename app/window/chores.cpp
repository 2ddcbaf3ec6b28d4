#include "app/window/chores.h"

#include <utility>

#include "tracer/error.h"

namespace app {

Chores::Chores(std::function<void()> wake)
    : wake_(std::move(wake)), thread_([this](const std::stop_token& quit) { work(quit); }) {}

Chores::~Chores() {
  thread_.request_stop();
}

void Chores::add(Chore chore) {
  const std::lock_guard lock(mutex_);
  chores_.push_back(std::move(chore));
  added_.notify_one();
}

std::vector<ChoreResult> Chores::take_results() {
  const std::lock_guard lock(mutex_);
  return std::exchange(results_, {});
}

void Chores::work(const std::stop_token& quit) {
  while (true) {
    Chore chore;
    {
      std::unique_lock lock(mutex_);
      added_.wait(lock, quit, [this] { return !chores_.empty(); });
      if (chores_.empty()) return;
      chore = std::move(chores_.front());
      chores_.pop_front();
    }
    ChoreResult result;
    try {
      result.message = chore();
    } catch (const tracer::Error& error) {
      result = {error.what(), true};
    }
    {
      const std::lock_guard lock(mutex_);
      results_.push_back(std::move(result));
    }
    wake_();
  }
}

}  // namespace app
