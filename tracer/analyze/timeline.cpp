// Poses, updates and traces each frame under each strategy.
#include "tracer/analyze/timeline.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tracer/analyze/quality.h"
#include "tracer/analyze/refit_growth.h"
#include "tracer/animation.h"
#include "tracer/choice.h"
#include "tracer/clock.h"
#include "tracer/error.h"
#include "tracer/render/passes.h"

namespace tracer {
namespace {

void check(const TimelineOptions& options, const Settings& settings) {
  if (!is_active(settings.deformer)) {
    throw Error(
        "no mesh changes its shape, so there is nothing to refit or rebuild; choose a deformer "
        "with "
        "an amount other than 0");
  }
  if (options.from < 0 || options.to < options.from || options.to > last_frame ||
      options.step < 1) {
    throw Error(fmt::format("frames {}:{}:{} are not a range within 0:{}", options.from, options.to,
                            options.step, last_frame));
  }
  if ((options.to - options.from) / options.step + 1 > max_timeline_frames) {
    throw Error(
        fmt::format("more than {} frames to measure; take a larger step", max_timeline_frames));
  }
  if (options.width < 1 || options.height < 1 || options.width > max_image_size ||
      options.height > max_image_size) {
    throw Error(
        fmt::format("a picture of {} x {} pixels cannot be traced", options.width, options.height));
  }
  for (const std::string& strategy : options.strategies) {
    UpdateOptions update = settings.update;
    update.strategy = strategy;
    tracer::check(update);
  }
}

class Measuring {
 public:
  Measuring(const std::shared_ptr<const Scene>& rest, const Settings& settings,
            const TimelineOptions& options, const Job& job)
      : settings_(settings), options_(options), job_(job) {
    look_ = settings.look ? *settings.look : look_of(*rest);
    settings_.render.width = options.width;
    settings_.render.height = options.height;
    camera_ = frame(look_.camera, options.width, options.height);
    for (const std::string& strategy : options.strategies) {
      animations_.push_back({rest, settings.build, settings.deformer, settings.update});
      animations_.back().update.strategy = strategy;
    }
    caches_.resize(animations_.size());
  }

  // The trees at rest, which every strategy begins with and nobody pays for.
  bool prepare() {
    const std::shared_ptr<const Scene>& rest = animations_[0].rest;
    const auto trees = build_blases(*rest, settings_.build, nullptr, job_.stop);
    for (AnimationCache& cache : caches_)
      cache.rest = trees;
    return !job_.stopped();
  }

  // Leaves the sample half done if stopped.
  TimelineSample sample(size_t strategy, int64_t frame, std::string& warning) {
    const Animation& animation = animations_[strategy];
    AnimationCache& cache = caches_[strategy];
    const float rate = settings_.update.frames_per_second;
    const Job quiet{job_.stop, {}};
    // What other frames should have paid for must not be paid in this one: trees built on the way,
    // and the memory of the first refit.
    const UpdateRow& row = *find_row(updates(), animation.update.strategy);
    const int64_t before = known_[strategy];
    const bool skipped = (row.uses_every || row.uses_growth) && before != frame - 1;
    if (skipped && frame > 0) pose_trees(animation, time_of(frame - 1, rate), cache, quiet);
    if (row.id == "refit" && before < 0) {
      pose_trees(animation, time_of(frame + 1, rate), cache, quiet);
    }
    known_[strategy] = frame;

    TimelineSample result;
    result.frame = frame;
    result.time = time_of(frame, rate);
    const PosedTrees posed = pose_trees(animation, result.time, cache, quiet);
    if (job_.stopped()) return result;
    if (!posed.facts.warning.empty()) warning = posed.facts.warning;
    const SceneBvh bvh =
        place_instances(*posed.scene, posed.blases, settings_.build, result.time, settings_.motion);
    result.deform_ms = posed.facts.deform_ms;
    result.refit_ms = posed.facts.refit_ms;
    result.build_ms = posed.facts.build_ms;
    result.tlas_ms = bvh.tlas_ms;
    result.sah = blas_statistics(bvh).sah;
    result.growth = refit_growth(bvh).mean;
    const World world{*posed.scene, bvh, look_, settings_.render};
    Film film = first_pass(world, camera_, job_.stop);
    if (job_.stopped()) return result;
    result.nodes_per_ray = ray_statistics(film)[int(RayClass::primary)].nodes.mean;
    result.trace_ms = std::min(pass_ms(world, film), pass_ms(world, film));
    return result;
  }

 private:
  // Wall time of one sample a pixel.
  double pass_ms(const World& world, Film& film) const {
    const auto start = Clock::now();
    next_pass(world, camera_, film, job_.stop);
    return ms_since(start);
  }

  Settings settings_;
  const TimelineOptions& options_;
  const Job& job_;
  Look look_;
  CameraFrame camera_;
  std::vector<Animation> animations_;  // one a strategy, as the next two
  std::vector<AnimationCache> caches_;
  std::vector<int64_t> known_ = std::vector<int64_t>(options_.strategies.size(), -1);
};

}  // namespace

TimelineOptions one_swing(const Deformer& deformer, const UpdateOptions& update, int64_t most) {
  TimelineOptions options;
  const double seconds = is_moving(deformer) ? 1.0 / double(deformer.speed) : 2.0;
  const double frames = std::max(seconds * double(update.frames_per_second), 2.0);
  options.to = std::min(int64_t(std::lround(frames)), last_frame);
  const int64_t steps = std::max<int64_t>(most - 1, 1);
  options.step = std::max<int64_t>((options.to + steps - 1) / steps, 1);
  options.to = options.to / options.step * options.step;
  return options;
}

Timeline measure_timeline(const std::shared_ptr<const Scene>& rest, const Settings& settings,
                          const TimelineOptions& options, const Job& job,
                          const std::function<void(Timeline)>& publish) {
  check(options, settings);
  Timeline timeline;
  timeline.options = options;
  timeline.deformer = settings.deformer;
  timeline.update = settings.update;
  timeline.builder = settings.build.builder;
  for (const std::string& strategy : options.strategies)
    timeline.curves.push_back({strategy, {}});
  job.progress(0.0f, "building the trees at rest");
  Measuring measuring(rest, settings, options, job);
  if (options.strategies.empty() || !measuring.prepare()) return timeline;
  for (int64_t frame = options.from; frame <= options.to; frame += options.step) {
    job.progress(float(frame - options.from) / float(options.to - options.from + 1),
                 fmt::format("frame {} of {} to {}", frame, options.from, options.to));
    std::vector<TimelineSample> samples;
    for (size_t i = 0; i < timeline.curves.size(); ++i) {
      samples.push_back(measuring.sample(i, frame, timeline.warning));
      if (job.stopped()) return timeline;
    }
    for (size_t i = 0; i < samples.size(); ++i)
      timeline.curves[i].samples.push_back(samples[i]);
    if (publish) publish(timeline);
  }
  return timeline;
}

}  // namespace tracer
