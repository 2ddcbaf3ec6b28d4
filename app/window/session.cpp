#include "app/window/session.h"

#include <utility>

#include "app/window/low_priority_workers.h"

namespace app {

using tracer::Settings;
using tracer::Snapshot;
using tracer::Stage;

Session::Session(Wake wake)
    : wake_(std::move(wake)), thread_([this](const std::stop_token& quit) { work(quit); }) {}

Session::~Session() {
  const std::lock_guard lock(mutex_);
  waiting_.reset();
  thread_.request_stop();
  if (job_) job_->stop.request_stop();
}

void Session::submit(const Settings& settings) {
  const std::lock_guard lock(mutex_);
  waiting_ = settings;
  stop_if_due();
  submitted_.notify_one();
}

void Session::cancel() {
  const std::lock_guard lock(mutex_);
  waiting_.reset();
  if (!job_) return;
  job_->paused = false;
  job_->stop.request_stop();
}

void Session::pause() {
  const std::lock_guard lock(mutex_);
  ++pauses_;
  if (!job_ || job_->stop.stop_requested()) return;
  job_->paused = true;
  job_->stop.request_stop();
}

void Session::resume() {
  const std::lock_guard lock(mutex_);
  --pauses_;
  submitted_.notify_one();
}

bool Session::wait_until_quiet(const std::stop_token& stop) const {
  std::unique_lock lock(mutex_);
  return ended_.wait(lock, stop, [this] { return !job_; });
}

std::shared_ptr<const Snapshot> Session::snapshot() const {
  const std::lock_guard lock(mutex_);
  return snapshot_;
}

bool Session::busy() const {
  const std::lock_guard lock(mutex_);
  return job_ || waiting_;
}

void Session::stop_if_due() {
  if (!job_ || !waiting_) return;
  Settings later = *waiting_;
  later.time = job_->settings.time;
  if (!later.look) later.look = job_->settings.look;  // take() has filled in the scene's own
  // While the time runs, a moment that is being built is shown before the next one is begun; else
  // nothing would ever be shown of a scene that takes longer than a frame.
  if (job_->stage < Stage::render && later == job_->settings) return;
  const Stage stale = tracer::first_stale(job_->settings, *waiting_);
  // More samples only extend the job: the next one goes on where it ends.
  if (stale < Stage::refine && job_->stage >= stale) job_->stop.request_stop();
}

void Session::take(std::shared_ptr<const Snapshot> snapshot) {
  {
    const std::lock_guard lock(mutex_);
    job_->stage = snapshot->stage;
    if (!job_->settings.look && snapshot->settings.source == job_->settings.source) {
      job_->settings.look = snapshot->settings.look;
    }
    std::swap(snapshot_, snapshot);  // the old one's memory is freed after the lock
    stop_if_due();
  }
  wake_();
}

void Session::work(const std::stop_token& quit) {
  lower_thread_priority(Priority::tracing);
  const LowPriorityWorkers workers;
  tracer::Pipeline pipeline;
  while (true) {
    Settings settings;
    std::stop_token stop;
    {
      std::unique_lock lock(mutex_);
      if (!submitted_.wait(lock, quit, [this] { return waiting_ && pauses_ == 0; })) return;
      settings = *std::exchange(waiting_, std::nullopt);
      job_.emplace();
      job_->settings = settings;
      stop = job_->stop.get_token();
    }
    pipeline.run(settings, stop,
                 [this](std::shared_ptr<const Snapshot> snapshot) { take(std::move(snapshot)); });
    {
      const std::lock_guard lock(mutex_);
      if (job_->paused && !waiting_ && !quit.stop_requested()) waiting_ = settings;
      job_.reset();
      ended_.notify_all();
    }
    wake_();
  }
}

}  // namespace app
