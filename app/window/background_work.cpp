#include "app/window/background_work.h"

#include <chrono>

#include "app/peers/peers.h"
#include "tracer/bvh/flatten.h"

namespace app {
namespace {

// A BVH has to last so long before it is measured: while time plays, each frame has another one.
constexpr std::chrono::milliseconds settle_time{200};

// Waits; false if stopped meanwhile.
bool rest(std::chrono::milliseconds time, const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  wake.wait_for(lock, stop, time, [&] { return stop.stop_requested(); });
  return !stop.stop_requested();
}

void start_comparison(BackgroundWork& work, const std::vector<tracer::BuildOptions>& options,
                      const tracer::Snapshot& snapshot) {
  if (!snapshot.scene || !snapshot.settings.look) return;
  tracer::ComparisonView view;
  view.camera = snapshot.settings.look->camera;
  view.width = snapshot.settings.render.width;
  view.height = snapshot.settings.render.height;
  view.time = snapshot.settings.time;
  view.motion = snapshot.settings.motion;
  work.compared = snapshot.scene;
  work.comparison.start(TurnKind::measures_time,
                        [scene = snapshot.scene, look = *snapshot.settings.look, options, view](
                            const tracer::Job& job, const auto& publish) {
                          return tracer::compare_builds(*scene, look, options, view, job, publish);
                        });
}

void start_benchmark(BackgroundWork& work, const ui::BenchmarkRequest& request,
                     const tracer::Snapshot& snapshot) {
  if (!snapshot.bvh || !snapshot.settings.look) return;
  work.benched = snapshot.scene;
  work.benchmark.start(
      TurnKind::measures_time,
      [request, scene = snapshot.scene, bvh = snapshot.bvh, settings = snapshot.settings](
          const tracer::Job& job, const BackgroundRun<tracer::Benchmark>::Publish& publish) {
        const tracer::BenchmarkScene wanted{*scene, *settings.look, settings.time, settings.motion};
        if (!request.flatten) return run_benchmark(wanted, request.options, peers(), job, publish);
        const tracer::Scene one = tracer::flattened(*scene, bvh->instances);
        return run_benchmark({one, *settings.look}, request.options, peers(), job, publish);
      });
}

void start_check(BackgroundWork& work, const tracer::Snapshot& snapshot) {
  if (!snapshot.scene || !snapshot.bvh) return;
  work.checks.start(TurnKind::computes, [scene = snapshot.scene, bvh = snapshot.bvh](
                                            const tracer::Job& job, const auto&) {
    const uint64_t rays = tracer::default_ray_count(*scene);
    return ui::Checked{bvh, tracer::validate(*scene, *bvh, rays, job)};
  });
}

}  // namespace

ui::Work work_of(const BackgroundWork& work) {
  ui::Work seen;
  seen.measures = work.measures.state();
  seen.comparison = work.comparison.state();
  seen.benchmark = work.benchmark.state();
  seen.missing_peers = missing_peers();
  seen.checks = work.checks.state();
  seen.timeline = work.timeline.state();
  seen.timeline_of = work.timeline_of;
  seen.inspection = work.inspection.state();
  seen.visits = work.visits.state();
  seen.hot_spots = work.hot_spots.state();
  seen.icicle = work.icicle.state();
  seen.node_pixels = work.node_pixels.state();
  seen.splits = work.splits.state();
  seen.rays = work.rays.state();
  seen.replay = work.replay.state();
  seen.measuring_time = work.turns.measuring();
  return seen;
}

void keep_measured(BackgroundWork& work, const tracer::Snapshot& snapshot) {
  if (!snapshot.bvh || snapshot.bvh == work.measured) return;
  const bool pictured = snapshot.samples > 0 && snapshot.stage >= tracer::Stage::refine;
  if (!pictured) {
    if (work.measured) work.measures.cancel();  // of a tree that is gone
    return;
  }
  work.measured = snapshot.bvh;
  work.measures.start(
      TurnKind::computes,
      [scene = snapshot.scene, bvh = snapshot.bvh, before = work.measures.state().result](
          const tracer::Job& job, const BackgroundRun<tracer::Measures>::Publish& publish) {
        if (!rest(settle_time, job.stop)) return before ? *before : tracer::Measures{};
        return tracer::measure(*scene, bvh, before.get(), job, publish);
      });
}

void drop_stale(BackgroundWork& work, const tracer::Snapshot& snapshot,
                const tracer::Settings& wanted) {
  if (work.compared && work.compared != snapshot.scene) {
    work.comparison.forget();
    work.compared.reset();
  }
  // The session cannot load another scene while it is paused for this one.
  if (work.compared && wanted.source != snapshot.settings.source) work.comparison.cancel();
  if (work.benched && work.benched != snapshot.scene) {
    work.benchmark.forget();
    work.benched.reset();
  }
  if (work.benched && wanted.source != snapshot.settings.source) work.benchmark.cancel();
  if (!work.timeline_of) return;
  if (work.timeline_of->source != wanted.source) work.timeline.cancel();
  if (work.timeline_of->source != snapshot.settings.source) {
    work.timeline.forget();
    work.timeline_of.reset();
  }
}

void carry_out(BackgroundWork& work, const ui::Requests& requests,
               const tracer::Snapshot& snapshot) {
  if (requests.compare) start_comparison(work, *requests.compare, snapshot);
  if (requests.benchmark) start_benchmark(work, *requests.benchmark, snapshot);
  if (requests.cancel_benchmark) work.benchmark.cancel();
  if (requests.check_trees) start_check(work, snapshot);
  if (requests.cancel_check) work.checks.cancel();
  if (requests.cancel_comparison) work.comparison.cancel();
  if (requests.cancel_timeline) work.timeline.cancel();
}

void start_timeline(BackgroundWork& work, const tracer::Snapshot& snapshot,
                    const tracer::Settings& settings, const tracer::TimelineOptions& options) {
  if (!snapshot.rest) return;
  work.timeline_of = std::make_shared<const tracer::Settings>(settings);
  work.timeline.start(
      TurnKind::measures_time,
      [rest = snapshot.rest, of = work.timeline_of, options](
          const tracer::Job& job, const BackgroundRun<tracer::Timeline>::Publish& publish) {
        return tracer::measure_timeline(rest, *of, options, job, publish);
      });
}

}  // namespace app
