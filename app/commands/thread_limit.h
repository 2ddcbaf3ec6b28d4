// How many threads a command may use.
#pragma once

#include <optional>

#include <tbb/global_control.h>

namespace app {

// Until the end of its life; nothing: as many as the machine has.
class ThreadLimit {
 public:
  explicit ThreadLimit(std::optional<int> threads) {
    if (threads) limit_.emplace(tbb::global_control::max_allowed_parallelism, size_t(*threads));
  }

 private:
  std::optional<tbb::global_control> limit_;
};

}  // namespace app
