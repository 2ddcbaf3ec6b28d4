#include "app/window/turns.h"

namespace app {

bool Turns::begin(TurnKind kind, const std::stop_token& stop) {
  {
    std::unique_lock lock(mutex_);
    if (!changed_.wait(lock, stop, [this] { return !measuring_; })) return false;
    if (kind == TurnKind::computes) {
      ++computing_;
      return true;
    }
    measuring_ = true;  // from now on nobody else begins
    if (!changed_.wait(lock, stop, [this] { return computing_ == 0; })) {
      measuring_ = false;
      changed_.notify_all();
      return false;
    }
  }
  session_.pause();
  if (session_.wait_until_quiet(stop)) return true;
  end(kind);
  return false;
}

void Turns::end(TurnKind kind) {
  if (kind == TurnKind::measures_time) session_.resume();
  const std::lock_guard lock(mutex_);
  if (kind == TurnKind::computes) {
    --computing_;
  } else {
    measuring_ = false;
  }
  changed_.notify_all();
}

bool Turns::measuring() const {
  const std::lock_guard lock(mutex_);
  return measuring_;
}

}  // namespace app
