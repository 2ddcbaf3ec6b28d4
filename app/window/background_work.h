// The window's work beside the session, and what starts it.
#pragma once

#include <functional>
#include <memory>

#include "app/window/background_run.h"
#include "ui/workspace.h"

namespace app {

inline constexpr size_t most_hot_spots = 100;  // listed

// A thread for each kind of work; all wait most of the time.
struct BackgroundWork {
  BackgroundWork(Session& session, const std::function<void()>& wake)
      : turns(session),
        measures(turns, wake),
        comparison(turns, wake),
        checks(turns, wake),
        timeline(turns, wake),
        inspection(turns, wake),
        visits(turns, wake),
        hot_spots(turns, wake),
        icicle(turns, wake),
        node_pixels(turns, wake),
        splits(turns, wake) {}

  Turns turns;
  BackgroundRun<tracer::Measures> measures;
  BackgroundRun<std::vector<tracer::ComparedBuild>> comparison;
  BackgroundRun<ui::Checked> checks;
  BackgroundRun<tracer::Timeline> timeline;
  BackgroundRun<tracer::Inspection> inspection;
  BackgroundRun<tracer::CountedVisits> visits;
  BackgroundRun<tracer::HotSpots> hot_spots;
  BackgroundRun<tracer::Icicle> icicle;
  BackgroundRun<ui::WatchedPixels> node_pixels;
  BackgroundRun<tracer::NodeSplits> splits;
  std::shared_ptr<const tracer::SceneBvh> measured;     // what `measures` was started for last
  std::shared_ptr<const tracer::Scene> compared;        // what `comparison` was started for last
  std::shared_ptr<const tracer::SceneBvh> inspected;    // what `inspection` was started for last
  uint64_t visited = 0;                                 // the film that `visits` was started for
  tracer::HotSpots hot_of;                              // what `hot_spots` was started for last
  tracer::IcicleSources icicle_of;                      // what `icicle` was started for last
  std::shared_ptr<const tracer::Settings> timeline_of;  // what `timeline` was started with last
  uint64_t watched_film = 0;                            // what `node_pixels` was started for
  tracer::Watched watched;
  std::shared_ptr<const tracer::SceneBvh> split_of;  // what `splits` was started for
  ui::NodePlace split_node;
};

// As panels see it.
ui::Work work_of(const BackgroundWork& work);

// Measures each new BVH once its first picture is complete; once a frame.
void keep_measured(BackgroundWork& work, const tracer::Snapshot& snapshot);

// Lists the nodes, counts the visits and makes what else panels on show ask for, of the
// newest complete picture; once a frame.
void keep_inspected(BackgroundWork& work, const ui::Requests& requests,
                    const tracer::Snapshot& snapshot);

// Stops what is about a scene that is gone, or that the wanted settings leave; once a frame.
void drop_stale(BackgroundWork& work, const tracer::Snapshot& snapshot,
                const tracer::Settings& wanted);

// Of the snapshot's picture.
tracer::CountedVisits counted_visits(const tracer::Snapshot& snapshot, const tracer::Job& job);

// Starts and stops what panels have asked for.
void carry_out(BackgroundWork& work, const ui::Requests& requests,
               const tracer::Snapshot& snapshot);

// Measures update strategies over the frames of the snapshot's scene, while the session rests.
void start_timeline(BackgroundWork& work, const tracer::Snapshot& snapshot,
                    const tracer::Settings& settings, const tracer::TimelineOptions& options);

}  // namespace app
