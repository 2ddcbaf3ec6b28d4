// settings -> stages -> snapshots: the one way through the library. Commands and tests run it on
// their own thread; the window gives it one.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "tracer/bvh/scene_bvh.h"
#include "tracer/render/film.h"
#include "tracer/settings.h"

namespace tracer {

enum class Stage { load, build, top_level, render, refine, none };
inline constexpr int stage_count = 5;  // without none
std::string_view name(Stage stage);

// The first stage whose result an edit makes stale; later ones are stale too.
Stage first_stale(const Settings& was, const Settings& now);

struct RayRate {
  uint64_t rays = 0;
  double seconds = 0.0;  // of all threads together, in the passes that count nothing
};

// Everything the window shows, at one moment. Never changes once published.
struct Snapshot {
  Settings settings;  // that made it; look is filled in
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const SceneBvh> bvh;
  Film film;

  Stage stage = Stage::none;      // running now; none: all done
  float progress = 0.0f;          // of the running stage, 0..1
  std::string doing;              // in words
  int samples = 0;                // complete passes in the film
  double pass_ms = 0.0;           // wall time of the last complete pass
  double first_picture_ms = 0.0;  // from the start of the render stage to a complete coarse picture
  std::array<RayRate, ray_class_count> rates;  // by RayClass
  std::array<int, stage_count> stage_runs{};   // how often each stage ran in this pipeline
  std::string error;              // of the last stage that failed; the rest is the last good result
  uint64_t scene_generation = 0;  // counts the scenes loaded
  uint64_t render_generation = 0;  // counts the films begun
};

using Publish = std::function<void(std::shared_ptr<const Snapshot>)>;

class Pipeline {
 public:
  // Runs what is stale until the film is complete or a stop is asked for, publishing as it goes; a
  // stopped stage stays owed. Never throws for bad input: the snapshot carries the error.
  void run(const Settings& settings, std::stop_token stop, const Publish& publish);

  std::shared_ptr<const Snapshot> snapshot() const { return last_; }

 private:
  struct Work;
  Stage stale_ = Stage::load;
  Settings done_;  // settings of the results kept
  std::shared_ptr<const Scene> scene_;
  std::vector<std::shared_ptr<const Blas>> blases_;
  std::shared_ptr<const SceneBvh> bvh_;
  std::shared_ptr<const Snapshot> last_ = std::make_shared<Snapshot>();
};

}  // namespace tracer
