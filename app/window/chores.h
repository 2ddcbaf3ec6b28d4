// Small jobs that the window does not wait for: writing files.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace app {

// What became of a chore, for the Messages panel.
struct ChoreResult {
  std::string message;
  bool failed = false;
};

// One thread does them in the order they come.
class Chores {
 public:
  // Gives the message of success (none if empty); throws tracer::Error with that of failure.
  using Chore = std::function<std::string()>;

  explicit Chores(std::function<void()> wake);  // called from its thread after each chore
  Chores(const Chores&) = delete;
  Chores& operator=(const Chores&) = delete;
  ~Chores();  // finishes what was added

  void add(Chore chore);
  std::vector<ChoreResult> take_results();

 private:
  void work(const std::stop_token& quit);

  const std::function<void()> wake_;
  std::mutex mutex_;
  std::condition_variable_any added_;
  std::deque<Chore> chores_;
  std::vector<ChoreResult> results_;
  std::jthread thread_;  // last: it uses everything above
};

}  // namespace app
