// The window's work beside the session, and what starts it.
#pragma once

#include <functional>
#include <memory>

#include "app/window/asked_work.h"
#include "app/window/kept_run.h"
#include "ui/workspace.h"

namespace app {

// A thread for each kind of work; all wait most of the time.
struct BackgroundWork {
  BackgroundWork(Session& session, const std::function<void()>& wake)
      : turns(session),
        measures(turns, wake),
        comparison(turns, wake),
        benchmark(turns, wake),
        checks(turns, wake),
        timeline(turns, wake),
        inspection(turns, wake),
        visits(turns, wake),
        hot_spots(turns, wake),
        icicle(turns, wake),
        node_pixels(turns, wake),
        splits(turns, wake),
        rays(turns, wake),
        replay(turns, wake) {}

  Turns turns;
  BackgroundRun<tracer::Measures> measures;
  BackgroundRun<std::vector<tracer::ComparedBuild>> comparison;
  BackgroundRun<tracer::Benchmark> benchmark;
  BackgroundRun<ui::Checked> checks;
  BackgroundRun<tracer::Timeline> timeline;
  KeptRun<std::shared_ptr<const tracer::SceneBvh>, tracer::Inspection> inspection;
  KeptRun<uint64_t, tracer::CountedVisits> visits;  // of a film
  KeptRun<HotWanted, tracer::HotSpots> hot_spots;
  KeptRun<tracer::IcicleSources, tracer::Icicle> icicle;
  KeptRun<PixelsWanted, ui::WatchedPixels> node_pixels;
  KeptRun<SplitsWanted, tracer::NodeSplits> splits;
  KeptRun<RaysWanted, ui::LoggedRays> rays;
  KeptRun<ReplayWanted, tracer::Replay> replay;
  std::shared_ptr<const tracer::SceneBvh> measured;     // what `measures` was started for last
  std::shared_ptr<const tracer::Scene> compared;        // what `comparison` was started for last
  std::shared_ptr<const tracer::Scene> benched;         // what `benchmark` was started for last
  std::shared_ptr<const tracer::Settings> timeline_of;  // what `timeline` was started with last
};

// As panels see it.
ui::Work work_of(const BackgroundWork& work);

// Measures each new BVH once its first picture is complete; once a frame.
void keep_measured(BackgroundWork& work, const tracer::Snapshot& snapshot);

// Stops what is about a scene that is gone, or that the wanted settings leave; once a frame.
void drop_stale(BackgroundWork& work, const tracer::Snapshot& snapshot,
                const tracer::Settings& wanted);

// Starts and stops what panels have asked for.
void carry_out(BackgroundWork& work, const ui::Requests& requests,
               const tracer::Snapshot& snapshot);

// Measures update strategies over the frames of the snapshot's scene, while the session rests.
void start_timeline(BackgroundWork& work, const tracer::Snapshot& snapshot,
                    const tracer::Settings& settings, const tracer::TimelineOptions& options);

}  // namespace app
