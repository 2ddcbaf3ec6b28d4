#include "app/window/painter.h"

#include <chrono>
#include <utility>

#include <tbb/task_arena.h>

#include "app/window/priority.h"
#include "tracer/error.h"

namespace app {

using tracer::Picture;
using tracer::Snapshot;
using tracer::ViewOptions;

namespace {

void paint_boxes(Picture& picture, const Snapshot& snapshot, const ViewOptions& view,
                 const tracer::BoxSources& sources,
                 std::shared_ptr<const tracer::NodeBoxes>& kept) {
  if (!kept || !is_of(*kept, snapshot.bvh, view.boxes, sources)) {
    kept = std::make_shared<const tracer::NodeBoxes>(
        tracer::node_boxes(snapshot.bvh, view.boxes, sources));
  }
  tracer::draw_boxes(picture, snapshot, *kept, view.boxes);
  if (view.legend) tracer::draw_box_legend(picture, view.boxes);
}

}  // namespace

Painting paint(std::shared_ptr<const Snapshot> snapshot, const ViewOptions& view,
               const tracer::BoxSources& boxes, std::shared_ptr<const tracer::NodeBoxes>* kept) {
  const auto began = std::chrono::steady_clock::now();
  Painting result;
  try {
    auto picture = std::make_shared<Picture>(tracer::colorize(*snapshot, view));
    std::shared_ptr<const tracer::NodeBoxes> none_before;
    if (view.boxes.show) {
      paint_boxes(*picture, *snapshot, view, boxes, kept != nullptr ? *kept : none_before);
    } else if (kept != nullptr) {
      kept->reset();
    }
    if (view.legend) tracer::draw_legend(*picture, view);
    if (!picture->image.pixels.empty()) result.picture = std::move(picture);
  } catch (const tracer::Error& error) {
    result.error = error.what();
  }
  result.snapshot = std::move(snapshot);
  result.view = view;
  result.boxes = boxes;
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - began;
  result.milliseconds = taken.count();
  return result;
}

Painter::Painter(Wake wake)
    : wake_(std::move(wake)), thread_([this](const std::stop_token& quit) { work(quit); }) {}

Painter::~Painter() {
  const std::lock_guard lock(mutex_);
  waiting_.reset();
  thread_.request_stop();
}

void Painter::submit(std::shared_ptr<const Snapshot> snapshot, const ViewOptions& view,
                     const tracer::BoxSources& boxes) {
  const std::lock_guard lock(mutex_);
  waiting_ = Request{std::move(snapshot), view, boxes};
  submitted_.notify_one();
}

std::shared_ptr<const Painting> Painter::painting() const {
  const std::lock_guard lock(mutex_);
  return painting_;
}

bool Painter::busy() const {
  const std::lock_guard lock(mutex_);
  return painting_now_ || waiting_;
}

void Painter::work(const std::stop_token& quit) {
  lower_thread_priority(Priority::painting);
  tbb::task_arena arena(tbb::task_arena::automatic, 1, tbb::task_arena::priority::high);
  std::shared_ptr<const tracer::NodeBoxes> boxes;
  while (true) {
    Request request;
    {
      std::unique_lock lock(mutex_);
      if (!submitted_.wait(lock, quit, [this] { return waiting_.has_value(); })) return;
      request = *std::exchange(waiting_, std::nullopt);
      painting_now_ = true;
    }
    auto painting = std::make_shared<Painting>();
    arena.execute([&] {
      *painting = paint(std::move(request.snapshot), request.view, request.boxes, &boxes);
    });
    {
      const std::lock_guard lock(mutex_);
      painting_ = std::move(painting);
      painting_now_ = false;
    }
    wake_();
  }
}

}  // namespace app
