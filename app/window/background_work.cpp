#include "app/window/background_work.h"

#include <chrono>

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

void start_check(BackgroundWork& work, const tracer::Snapshot& snapshot) {
  if (!snapshot.scene || !snapshot.bvh) return;
  work.checks.start(TurnKind::computes, [scene = snapshot.scene, bvh = snapshot.bvh](
                                            const tracer::Job& job, const auto&) {
    const uint64_t rays = tracer::default_ray_count(*scene);
    return ui::Checked{bvh, tracer::validate(*scene, *bvh, rays, job)};
  });
}

void keep_hot_spots(BackgroundWork& work, int ray_class, const tracer::Snapshot& snapshot) {
  const auto inspection = work.inspection.state().result;
  const auto counted = work.visits.state().result;
  if (!inspection || !counted || inspection->bvh != snapshot.bvh || counted->bvh != snapshot.bvh) {
    return;
  }
  tracer::HotSpots& of = work.hot_of;
  if (of.inspection == inspection && of.counted == counted && of.ray_class == ray_class) return;
  of = {inspection, counted, ray_class, 0.0, {}};
  work.hot_spots.start(
      TurnKind::computes,
      [scene = snapshot.scene, inspection, counted, ray_class](const tracer::Job& job,
                                                               const auto&) {
        return tracer::hot_spots(*scene, inspection, counted, ray_class, most_hot_spots, job);
      },
      true);
}

void keep_watched(BackgroundWork& work, const tracer::Watched& node,
                  const tracer::Snapshot& snapshot) {
  if (work.watched_film == snapshot.render_generation && work.watched == node) return;
  work.watched_film = snapshot.render_generation;
  work.watched = node;
  work.node_pixels.start(
      TurnKind::computes,
      [film = snapshot.render_generation, scene = snapshot.scene, bvh = snapshot.bvh, node,
       look = *snapshot.settings.look,
       options = snapshot.settings.render](const tracer::Job& job, const auto&) {
        const tracer::World world{*scene, *bvh, look, options};
        const tracer::CameraFrame camera =
            tracer::frame(look.camera, options.width, options.height);
        return ui::WatchedPixels{film, tracer::node_pixels(world, bvh, camera, node, job)};
      },
      true);
}

// Of the newest tables; again when what its widths or colours are made of is there.
void keep_icicle(BackgroundWork& work, const tracer::IcicleOptions& options) {
  const tracer::IcicleSources sources =
      tracer::icicle_sources(options, work.inspection.state().result, work.visits.state().result,
                             work.measures.state().result);
  if (!sources.inspection || sources == work.icicle_of) return;
  work.icicle_of = sources;
  work.icicle.start(
      TurnKind::computes,
      [sources](const tracer::Job& job, const auto&) { return tracer::make_icicle(sources, job); },
      true);
}

// Once the tree's table is there.
void keep_split(BackgroundWork& work, const ui::NodePlace& place,
                const tracer::Snapshot& snapshot) {
  if (work.split_of == snapshot.bvh && work.split_node == place) return;
  const auto inspection = work.inspection.state().result;
  if (!inspection || inspection->bvh != snapshot.bvh) return;
  const tracer::TreeTable* table = tracer::table_of(*inspection, place.mesh);
  if (table == nullptr || place.node >= table->nodes.size()) return;
  work.split_of = snapshot.bvh;
  work.split_node = place;
  work.splits.start(
      TurnKind::computes,
      [scene = snapshot.scene, bvh = snapshot.bvh, inspection, table, place](const tracer::Job& job,
                                                                             const auto&) {
        return tracer::node_splits(*scene, bvh, *table, place.mesh, place.node, job);
      },
      true);
}

}  // namespace

ui::Work work_of(const BackgroundWork& work) {
  ui::Work seen;
  seen.measures = work.measures.state();
  seen.comparison = work.comparison.state();
  seen.checks = work.checks.state();
  seen.timeline = work.timeline.state();
  seen.timeline_of = work.timeline_of;
  seen.inspection = work.inspection.state();
  seen.visits = work.visits.state();
  seen.hot_spots = work.hot_spots.state();
  seen.icicle = work.icicle.state();
  seen.node_pixels = work.node_pixels.state();
  seen.splits = work.splits.state();
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

tracer::CountedVisits counted_visits(const tracer::Snapshot& snapshot, const tracer::Job& job) {
  const tracer::RenderOptions& options = snapshot.settings.render;
  const tracer::World world{*snapshot.scene, *snapshot.bvh, *snapshot.settings.look, options};
  const tracer::CameraFrame camera =
      tracer::frame(world.look.camera, options.width, options.height);
  return {snapshot.bvh, tracer::count_visits(world, camera, job)};
}

void keep_inspected(BackgroundWork& work, const ui::Requests& requests,
                    const tracer::Snapshot& snapshot) {
  const bool pictured = snapshot.samples > 0 && snapshot.stage >= tracer::Stage::refine;
  if (!snapshot.bvh || !pictured) return;
  if (requests.inspect && work.inspected != snapshot.bvh) {
    work.inspected = snapshot.bvh;
    work.inspection.start(
        TurnKind::computes,
        [bvh = snapshot.bvh, before = work.inspection.state().result](const tracer::Job& job,
                                                                      const auto&) {
          return tracer::inspect(bvh, before.get(), job);
        },
        true);
  }
  if (requests.count_visits && work.visited != snapshot.render_generation) {
    work.visited = snapshot.render_generation;
    work.visits.start(
        TurnKind::computes,
        [snapshot](const tracer::Job& job, const auto&) { return counted_visits(snapshot, job); },
        true);
  }
  if (requests.hot_spots) keep_hot_spots(work, *requests.hot_spots, snapshot);
  if (requests.icicle) keep_icicle(work, *requests.icicle);
  if (requests.node_pixels) keep_watched(work, *requests.node_pixels, snapshot);
  if (requests.node_splits) keep_split(work, *requests.node_splits, snapshot);
}

void drop_stale(BackgroundWork& work, const tracer::Snapshot& snapshot,
                const tracer::Settings& wanted) {
  if (work.compared && work.compared != snapshot.scene) {
    work.comparison.forget();
    work.compared.reset();
  }
  // The session cannot load another scene while it is paused for this one.
  if (work.compared && wanted.source != snapshot.settings.source) work.comparison.cancel();
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
