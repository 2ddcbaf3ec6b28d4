// The painter thread: turns the newest snapshot and view options into a picture.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "tracer/render/overlay.h"

namespace app {

// One picture and what it was made of.
struct Painting {
  std::shared_ptr<const tracer::Picture> picture;  // nullptr: nothing to show yet, or an error
  std::shared_ptr<const tracer::Snapshot> snapshot;
  tracer::ViewOptions view;
  tracer::BoxSources boxes;
  double milliseconds = 0.0;  // that painting took
  std::string error;
};

// Its thread comes after the window's and before those that trace; a worker that traces helps it
// after the tile at hand. The newest request wins; all calls return at once.
class Painter {
 public:
  using Wake = std::function<void()>;

  explicit Painter(Wake wake);  // called from the painter's thread after each new painting
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;
  ~Painter();  // waits for the picture being painted

  void submit(std::shared_ptr<const tracer::Snapshot> snapshot, const tracer::ViewOptions& view,
              const tracer::BoxSources& boxes = {});
  std::shared_ptr<const Painting> painting() const;
  bool busy() const;

 private:
  struct Request {
    std::shared_ptr<const tracer::Snapshot> snapshot;
    tracer::ViewOptions view;
    tracer::BoxSources boxes;
  };

  void work(const std::stop_token& quit);

  const Wake wake_;
  mutable std::mutex mutex_;
  std::condition_variable_any submitted_;
  std::optional<Request> waiting_;
  bool painting_now_ = false;
  std::shared_ptr<const Painting> painting_ = std::make_shared<Painting>();
  std::jthread thread_;  // last: it uses everything above
};

// What the viewport shows and exported pictures contain: the colours, the boxes and the legends, as
// they are asked for. Gives the message of a tracer::Error in `error`. `kept` are boxes that may
// serve again; they become those of this picture.
Painting paint(std::shared_ptr<const tracer::Snapshot> snapshot, const tracer::ViewOptions& view,
               const tracer::BoxSources& boxes = {},
               std::shared_ptr<const tracer::NodeBoxes>* kept = nullptr);

}  // namespace app
