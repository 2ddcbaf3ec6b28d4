// settings -> stages -> snapshots: the one way through the library. Commands and tests run it on
// their own thread; the window gives it one.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "tracer/analyze/overlap.h"
#include "tracer/analyze/quality.h"
#include "tracer/analyze/refit_growth.h"
#include "tracer/animation.h"
#include "tracer/bvh/scene_bvh.h"
#include "tracer/render/film.h"
#include "tracer/render/whitted.h"
#include "tracer/stage.h"

namespace tracer {

// Everything the window shows, at one moment. Never changes once published.
struct Snapshot {
  Settings settings;                   // that made it; look is filled in
  std::shared_ptr<const Scene> scene;  // its meshes are those of the moment, deformed
  std::shared_ptr<const Scene> rest;   // before it was deformed
  std::shared_ptr<const SceneBvh> bvh;
  std::shared_ptr<const TreeStatistics> blas_statistics, tlas_statistics;
  std::shared_ptr<const std::array<RayStatistics, ray_class_count>> ray_statistics;  // of pass 0
  WastedEntries wasted_entries;                                                      // too
  Film film;

  Stage stage = Stage::none;  // running or owed; none: all done
  bool stopped = false;       // the stage was stopped and is owed
  float progress = 0.0f;      // of the running stage, 0..1
  std::string doing;          // in words
  int samples = 0;            // complete passes in the film
  double load_ms = 0.0;
  double build_ms = 0.0;          // wall time of the newest builds: all BLASes
  UpdateFacts update;             // how the trees came to the shape of the moment
  RefitGrowth growth;             // of their nodes since the build
  double pass_ms = 0.0;           // wall time of the last complete pass
  double first_picture_ms = 0.0;  // from the begin of the render stage to a complete coarse picture
  RayRates rates{};               // of the passes that count nothing
  std::array<int, stage_count> stage_runs{};  // how often each stage ran in this pipeline
  std::optional<SceneSource> failed_source;   // what the last load could not bring
  std::string error;               // of the last load or build that failed; the rest is older
  uint64_t scene_generation = 0;   // counts the scenes loaded
  uint64_t render_generation = 0;  // counts the films begun
};

using Publish = std::function<void(std::shared_ptr<const Snapshot>)>;

class Pipeline {
 public:
  // Runs what is stale until the film is complete or a stop is asked for, publishing as it goes, in
  // turn, from whichever thread has something new. A stopped stage stays owed. Bad input does not
  // throw: the snapshot carries the error and the last good results, and what failed is not tried
  // again until its settings change.
  void run(const Settings& settings, const std::stop_token& stop, const Publish& publish);

  std::shared_ptr<const Snapshot> snapshot() const { return last_; }

 private:
  class Run;
  struct Loaded {
    std::shared_ptr<const Scene> scene;
    SceneSource source;
    double milliseconds = 0.0;
  };

  Stage stale_ = Stage::load;
  Loaded loaded_;         // not yet built
  AnimationCache trees_;  // of the snapshot's scene at rest
  std::optional<SceneSource> failed_source_;
  std::optional<BuildOptions> failed_build_;
  std::vector<std::shared_ptr<const Blas>> blases_;
  std::shared_ptr<const Snapshot> last_ = std::make_shared<Snapshot>();
};

}  // namespace tracer
