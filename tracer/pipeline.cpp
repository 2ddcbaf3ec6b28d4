// The stages in their order, what makes them stale, and what is published meanwhile.
#include "tracer/pipeline.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <new>
#include <thread>

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "tracer/clock.h"
#include "tracer/error.h"
#include "tracer/memory.h"
#include "tracer/render/trace_film.h"

namespace tracer {

namespace {

// A refinement changes little from one picture to the next; colouring and drawing them would take
// a good part of the processor.
constexpr std::chrono::milliseconds publish_interval{30};
constexpr std::chrono::milliseconds refine_interval{100};
// A stop does not end a render stage before it was worth to begin: while the user drags, every edit
// shows at least its coarse picture, unless that takes too long.
constexpr double min_render_ms = 40.0;
constexpr double max_grace_ms = 100.0;

std::string reason(const std::exception& error, const char* what) {
  if (dynamic_cast<const std::bad_alloc*>(&error) == nullptr) return error.what();
  return fmt::format(
      "there is not enough memory to {} this scene; close other programs or choose "
      "a smaller one",
      what);
}

}  // namespace

// One run: the snapshot in the making, and what it takes to publish it.
class Pipeline::Run {
 public:
  Run(Pipeline& pipeline, const Settings& settings, const std::stop_token& stop,
      const Publish& publish)
      : pipeline_(pipeline),
        settings_(clamped(settings)),
        stop_(stop),
        publish_to_(publish),
        next_(*pipeline.last_) {
    if (next_.scene) {
      if (settings_.source == pipeline_.failed_source_) {
        settings_.source = next_.settings.source;
      } else {  // asked for again, it is tried again
        pipeline_.failed_source_.reset();
        next_.failed_source.reset();
      }
      if (settings_.build == pipeline_.failed_build_) settings_.build = next_.settings.build;
    }
  }

  void run() {
    next_.stopped = false;
    gave_up_ = !next_.scene && settings_.source == pipeline_.failed_source_;
    if (next_.scene && settings_.source == next_.settings.source) {
      settings_.look = fitted(settings_.look, *next_.scene);
    }
    pipeline_.stale_ = first_stage();
    while (pipeline_.stale_ != Stage::none && !gave_up_ && !stop_.stop_requested()) {
      begin(pipeline_.stale_);
      pipeline_.stale_ = run_stage(pipeline_.stale_);
    }
    next_.stage = gave_up_ ? Stage::none : pipeline_.stale_;
    next_.stopped = next_.stage != Stage::none;
    publish();
  }

 private:
  Stage first_stage() {
    Loaded& loaded = pipeline_.loaded_;
    if (loaded.scene && loaded.source == settings_.source) {
      settings_.look = fitted(settings_.look, *loaded.scene);
      return Stage::build;
    }
    loaded = {};
    if (!next_.scene) return Stage::load;
    // A load or build that was stopped has left nothing in next_ that could be stale; but it may
    // have hidden a render stage that was owed before it.
    return std::min(std::max(pipeline_.stale_, Stage::render),
                    first_stale(next_.settings, settings_));
  }

  // Returns the stage to run next: the same one if it was stopped.
  Stage run_stage(Stage stage) {
    switch (stage) {
      case Stage::load:
        return load();
      case Stage::build:
        return build();
      case Stage::refit:
        return refit();
      case Stage::top_level:
        return place();
      case Stage::render:
        return render();
      case Stage::refine:
        return refine();
      case Stage::none:
        break;
    }
    return Stage::none;
  }

  void begin(Stage stage) {
    next_.stage = stage;
    next_.progress = 0.0f;
    next_.doing = name(stage);
    ++next_.stage_runs[static_cast<size_t>(stage)];
    publish();
  }

  void publish() {
    const std::lock_guard lock(mutex_);
    publish_locked();
  }
  void publish_locked() {
    published_ = Clock::now();
    pipeline_.last_ = std::make_shared<Snapshot>(next_);
    if (publish_to_) publish_to_(pipeline_.last_);
  }
  void publish_if_due() {
    const auto interval = next_.stage == Stage::refine ? refine_interval : publish_interval;
    if (Clock::now() - published_ >= interval) publish_locked();
  }
  void report(float progress, std::string_view doing) {
    const std::lock_guard lock(mutex_);
    next_.progress = progress;
    next_.doing = doing;
    publish_if_due();
  }

  Stage load() {
    const auto start = Clock::now();
    Job job{stop_, [this](float fraction, std::string_view what) { report(fraction, what); }};
    std::shared_ptr<const Scene> scene;
    try {
      scene = std::make_shared<const Scene>(load_scene(settings_.source, job));
    } catch (const std::exception& error) {
      if (stop_.stop_requested()) return Stage::load;
      pipeline_.failed_source_ = settings_.source;
      next_.failed_source = settings_.source;
      return give_up(reason(error, "load"));
    }
    // Kept aside until it is built: a failure leaves everything as it was.
    pipeline_.loaded_ = {scene, settings_.source, ms_since(start)};
    settings_.look = fitted(settings_.look, *scene);
    return Stage::build;
  }

  // Goes on with the last good scene and BVH, if there are any, and with what else is stale.
  Stage give_up(const std::string& error) {
    next_.error = error;
    pipeline_.loaded_ = {};
    if (!next_.scene) {
      gave_up_ = true;
      return Stage::load;
    }
    settings_.source = next_.settings.source;
    settings_.build = next_.settings.build;
    settings_.look = fitted(settings_.look, *next_.scene);
    return first_stale(next_.settings, settings_);
  }

  Animation animation(std::shared_ptr<const Scene> rest) const {
    return {std::move(rest), settings_.build, settings_.deformer, settings_.update};
  }

  Stage build() {
    const Loaded loaded = pipeline_.loaded_;
    const std::shared_ptr<const Scene> rest = loaded.scene ? loaded.scene : next_.rest;
    // Trees over the shape at rest serve the next times, too.
    const bool same = !loaded.scene && settings_.build == next_.settings.build;
    AnimationCache trees = same ? pipeline_.trees_ : AnimationCache{};
    PosedTrees posed;
    try {
      posed = posed_trees(rest, trees);
    } catch (const std::exception& error) {
      pipeline_.failed_build_ = settings_.build;
      return give_up(reason(error, "build a BVH over"));
    }
    if (stop_.stop_requested()) return Stage::build;

    const std::lock_guard lock(mutex_);
    if (loaded.scene) {
      ++next_.scene_generation;
      next_.load_ms = loaded.milliseconds;
      next_.film = {};  // its hits are of another scene
      next_.samples = 0;
    }
    next_.settings.source = settings_.source;
    next_.settings.build = settings_.build;
    next_.settings.look = settings_.look;
    next_.error.clear();
    pipeline_.failed_source_.reset();
    next_.failed_source.reset();
    pipeline_.failed_build_.reset();
    next_.rest = rest;
    pipeline_.trees_ = std::move(trees);
    pipeline_.loaded_ = {};
    take(std::move(posed));
    return Stage::render;
  }

  Stage refit() {
    PosedTrees posed;
    try {
      posed = posed_trees(next_.rest, pipeline_.trees_);
    } catch (const std::exception& error) {
      next_.error = reason(error, "deform");
      settings_.time = next_.settings.time;
      settings_.deformer = next_.settings.deformer;
      settings_.update = next_.settings.update;
      return first_stale(next_.settings, settings_);
    }
    if (stop_.stop_requested()) return Stage::refit;
    const std::lock_guard lock(mutex_);
    take(std::move(posed));
    return Stage::render;
  }

  PosedTrees posed_trees(const std::shared_ptr<const Scene>& rest, AnimationCache& trees) {
    uint64_t total = 0;
    for (const Mesh& mesh : rest->meshes)
      total += mesh.triangles.size();
    if (settings_.build.optimizer != "none") total *= 2;
    BuildLog log;
    std::atomic<float> followed{0.0f};
    const std::jthread ticker = report_while([&] {
      const auto done = static_cast<float>(log.placed + log.optimized);
      const float built = done / static_cast<float>(std::max<uint64_t>(total, 1));
      const std::string_view doing = next_.stage == Stage::refit ? "refitting"
                                     : log.optimized > 0         ? "optimizing"
                                                                 : "building";
      report(std::min(std::max(built, followed.load()), 1.0f), doing);
    });
    const Job job{stop_, [&](float fraction, std::string_view) { followed = fraction; }};
    return pose_trees(animation(rest), settings_.time, trees, job, &log);
  }

  void take(PosedTrees posed) {
    next_.scene = std::move(posed.scene);
    next_.update = posed.facts;
    if (posed.facts.build_ms > 0.0) next_.build_ms = posed.facts.build_ms;
    next_.settings.deformer = settings_.deformer;
    next_.settings.update = settings_.update;
    pipeline_.blases_ = std::move(posed.blases);
    place_now();
    next_.blas_statistics = std::make_shared<const TreeStatistics>(blas_statistics(*next_.bvh));
    next_.growth = refit_growth(*next_.bvh);
  }

  Stage place() {
    const std::lock_guard lock(mutex_);
    place_now();
    return Stage::render;
  }

  void place_now() {
    next_.bvh = std::make_shared<const SceneBvh>(place_instances(
        *next_.scene, pipeline_.blases_, settings_.build, settings_.time, settings_.motion));
    next_.settings.build.rebraid = settings_.build.rebraid;
    next_.settings.time = settings_.time;
    next_.settings.motion = settings_.motion;
    next_.tlas_statistics = std::make_shared<const TreeStatistics>(tlas_statistics(*next_.bvh));
  }

  Stage render() {
    const auto start = Clock::now();
    render_begin_ = start;
    coarse_done_ = false;
    const uint64_t needed = film_bytes(settings_.render.width, settings_.render.height);
    if (needed > memory_available() / 2) {
      next_.error = fmt::format(
          "a picture of {} x {} pixels needs {:.1f} GiB of memory, more than "
          "half of what is free; choose a smaller size",
          settings_.render.width, settings_.render.height, static_cast<double>(needed) / (1 << 30));
      return Stage::none;
    }
    {
      const std::lock_guard lock(mutex_);
      if (!pipeline_.failed_source_ && !pipeline_.failed_build_) next_.error.clear();
      next_.settings.look = settings_.look;
      next_.settings.render = settings_.render;
      next_.samples = 0;
      next_.rates = {};
      next_.ray_statistics = nullptr;
      next_.wasted_entries = {};
      ++next_.render_generation;
    }
    Film coarse = empty_film(settings_.render.width, settings_.render.height);
    const World world{*next_.scene, *next_.bvh, *next_.settings.look, next_.settings.render};
    const CameraFrame camera = camera_frame();
    for (int stride = coarsest_stride; stride >= 1; stride /= 2) {
      Film finer = coarse;
      // The picture before stays until there is a complete coarse one.
      Film& shown = stride == coarsest_stride ? finer : next_.film;
      for_tiles("first pass", [&](int tile, Whitted& whitted) {
        auto traced =
            trace_first_pass(world, camera, tile, stride, coarse.tiles[tile].get(), whitted);
        const std::lock_guard lock(mutex_);
        finer.tiles[tile] = traced;
        shown.tiles[tile] = std::move(traced);
      });
      if (must_stop()) return Stage::render;
      coarse = finer;
      const std::lock_guard lock(mutex_);
      if (stride == coarsest_stride) {
        next_.film = std::move(finer);
        coarse_done_ = true;
        next_.first_picture_ms = ms_since(start);
      }
      publish_locked();
    }
    auto statistics = std::make_shared<const std::array<RayStatistics, ray_class_count>>(
        ray_statistics(next_.film));
    const WastedEntries wasted = wasted_entries(next_.film);
    const std::lock_guard lock(mutex_);
    next_.ray_statistics = std::move(statistics);
    next_.wasted_entries = wasted;
    next_.samples = 1;
    next_.pass_ms = ms_since(start);
    return Stage::refine;
  }

  Stage refine() {
    const World world{*next_.scene, *next_.bvh, *next_.settings.look, next_.settings.render};
    const CameraFrame camera = camera_frame();
    next_.settings.render.samples = settings_.render.samples;
    coarse_done_ = true;
    while (next_.samples < settings_.render.samples) {
      const auto start = Clock::now();
      const int target = next_.samples + 1;
      for_tiles("refining", [&](int tile, Whitted& whitted) {
        // A stopped pass has left some tiles ahead of others.
        const std::shared_ptr<const FilmTile> before = next_.film.tiles[tile];
        if (before->samples >= target) return;
        auto traced = trace_next_pass(world, camera, tile, *before, whitted);
        const std::lock_guard lock(mutex_);
        next_.film.tiles[tile] = std::move(traced);
      });
      if (must_stop()) return Stage::refine;
      const std::lock_guard lock(mutex_);
      next_.samples = target;
      next_.pass_ms = ms_since(start);
      publish_locked();
    }
    return Stage::none;
  }

  CameraFrame camera_frame() const {
    const RenderOptions& options = next_.settings.render;
    return frame(next_.settings.look->camera, options.width, options.height);
  }

  // function(tile, whitted) for all tiles in parallel, publishing now and then.
  template <class Function>
  void for_tiles(std::string_view doing, const Function& function) {
    const size_t count = empty_film(settings_.render.width, settings_.render.height).tiles.size();
    size_t done = 0;
    tbb::enumerable_thread_specific<Whitted> tracers;
    tbb::parallel_for(
        size_t{0}, count,
        [&](size_t tile) {
          if (must_stop()) return;
          Whitted& whitted = tracers.local();
          function(static_cast<int>(tile), whitted);
          const std::lock_guard lock(mutex_);
          next_.progress = static_cast<float>(++done) / static_cast<float>(count);
          next_.doing = doing;
          publish_if_due();
        },
        tbb::simple_partitioner{});
    const std::lock_guard lock(mutex_);
    for (const Whitted& whitted : tracers) {
      for (size_t i = 0; i < next_.rates.size(); ++i)
        next_.rates[i] += whitted.rates()[i];
    }
  }

  bool must_stop() const {
    if (!stop_.stop_requested()) return false;
    const double ms = ms_since(render_begin_);
    return ms > max_grace_ms || (coarse_done_ && ms > min_render_ms);
  }

  // A thread that calls the function again and again until it is destroyed.
  template <class Function>
  static std::jthread report_while(Function function) {
    return std::jthread([function](const std::stop_token& stop) {
      std::mutex mutex;
      std::condition_variable_any wake;
      std::unique_lock lock(mutex);
      while (!wake.wait_for(lock, stop, publish_interval, [&] { return stop.stop_requested(); })) {
        function();
      }
    });
  }

  Pipeline& pipeline_;
  Settings settings_;
  const std::stop_token& stop_;
  const Publish& publish_to_;
  std::mutex mutex_;  // guards next_ while other threads work
  Snapshot next_;
  Clock::time_point published_;
  bool gave_up_ = false;  // there is nothing to show, and will not be
  Clock::time_point render_begin_;
  bool coarse_done_ = false;
};

void Pipeline::run(const Settings& settings, const std::stop_token& stop, const Publish& publish) {
  Run(*this, settings, stop, publish).run();
}

}  // namespace tracer
