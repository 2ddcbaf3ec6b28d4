// Update strategies side by side over the frames of an animation: what each frame's tree is worth,
// and what it costs.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tracer/progress.h"
#include "tracer/settings.h"

namespace tracer {

// Frames from, from + step ... up to `to`; `width` x `height` pixels are traced in each.
struct TimelineOptions {
  int64_t from = 0, to = 59, step = 1;
  int width = 320, height = 180;
  std::vector<std::string> strategies = {"refit", "every", "rebuild"};  // ids of UpdateRows

  bool operator==(const TimelineOptions&) const = default;
};
inline constexpr int64_t max_timeline_frames = 2000;  // measured ones
inline constexpr int64_t last_frame = 1'000'000;

// One swing of the deformer (two seconds of one that is held), in at most `most` frames.
TimelineOptions one_swing(const Deformer& deformer, const UpdateOptions& update, int64_t most = 60);

// Times are wall times of all threads together.
struct TimelineSample {
  int64_t frame = 0;
  float time = 0.0f;  // seconds
  double sah = 0.0;   // of the BLASes, as TreeStatistics
  double growth = 1.0;
  double nodes_per_ray = 0.0;  // inner nodes of both levels that a primary ray visits, the mean
  double deform_ms = 0.0, refit_ms = 0.0, build_ms = 0.0, tlas_ms = 0.0;
  double trace_ms = 0.0;  // one sample a pixel with all its bounces, nothing counted

  // What the strategy decides on: without the deformation, which is the same for all.
  double tree_ms() const { return refit_ms + build_ms + tlas_ms; }
  double frame_ms() const { return deform_ms + tree_ms() + trace_ms; }
};

struct TimelineCurve {
  std::string strategy;
  std::vector<TimelineSample> samples;
};

struct Timeline {
  TimelineOptions options;
  Deformer deformer;
  UpdateOptions update;
  std::string builder;
  std::vector<TimelineCurve> curves;  // as many samples in each
  std::string warning;                // what a refit could not keep
};

// Measures frame by frame, the strategies in turns, and publishes after each frame. Uses the
// settings' build options, deformer, update options, motion, look (or the scene's own) and render
// options but for the size. SAH and nodes per ray are the same for any number of threads. Stopped:
// what was measured until then. Throws Error for bad options or a scene that nothing deforms.
Timeline measure_timeline(const std::shared_ptr<const Scene>& rest, const Settings& settings,
                          const TimelineOptions& options, const Job& job,
                          const std::function<void(Timeline)>& publish = nullptr);

}  // namespace tracer
