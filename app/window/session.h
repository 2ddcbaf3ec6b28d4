// The session thread: runs the pipeline for the newest settings and keeps its newest snapshot.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "tracer/pipeline.h"

namespace app {

// The job that runs, as far as others have to know it.
struct SessionJob {
  tracer::Settings settings;
  std::stop_source stop;
  tracer::Stage stage = tracer::Stage::load;
  bool paused = false;  // stopped by a pause: it goes on afterwards
};

// One slot in (settings) and one slot out (snapshot); the newest wins in both. All calls return at
// once and may come from any thread. The session's thread and the TBB workers that trace for it run
// at low priority, so that the window stays smooth with as many workers as cores.
class Session {
 public:
  using Wake = std::function<void()>;

  // `wake` is called from the session's thread after each new snapshot and each job.
  explicit Session(Wake wake);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session();  // stops the running job and waits for it: one tile, or one step of a builder

  // Replaces settings that still wait. The running job is stopped when it works on a stage that the
  // new settings make stale; until then it goes on, so that editing a light does not throw a build
  // away. (A render stage shows a coarse picture before it stops, so a steady stream of edits, such
  // as a camera that is being dragged, is seen.)
  void submit(const tracer::Settings& settings);

  // Stops the running job and forgets the settings that wait. What was stopped stays owed until the
  // next submit.
  void cancel();

  // Stops the running job; it, or newer settings, go on after as many calls of resume. For those
  // who measure times: see Turns.
  void pause();
  void resume();
  // Waits until no job runs; false if stopped before. While paused, none begins.
  bool wait_until_quiet(const std::stop_token& stop) const;

  std::shared_ptr<const tracer::Snapshot> snapshot() const;
  bool busy() const;  // a job runs or waits

 private:
  void work(const std::stop_token& quit);
  void take(std::shared_ptr<const tracer::Snapshot> snapshot);
  void stop_if_due();  // mutex_ is held

  const Wake wake_;
  mutable std::mutex mutex_;
  std::condition_variable_any submitted_;
  mutable std::condition_variable_any ended_;
  std::optional<tracer::Settings> waiting_;
  std::optional<SessionJob> job_;
  int pauses_ = 0;
  std::shared_ptr<const tracer::Snapshot> snapshot_ = std::make_shared<tracer::Snapshot>();
  std::jthread thread_;  // last: it uses everything above
};

}  // namespace app
