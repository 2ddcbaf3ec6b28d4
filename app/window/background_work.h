// The window's work beside the session, and what starts it.
#pragma once

#include <functional>
#include <memory>

#include "app/window/background_run.h"
#include "ui/workspace.h"

namespace app {

// Which rays are logged, and in which film and BVH.
struct RaysWanted {
  ui::RayRequest request;
  uint64_t film = 0;
  std::shared_ptr<const tracer::SceneBvh> bvh;
  bool operator==(const RaysWanted&) const = default;
};

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
        rays(turns, wake) {}

  Turns turns;
  BackgroundRun<tracer::Measures> measures;
  BackgroundRun<std::vector<tracer::ComparedBuild>> comparison;
  BackgroundRun<ui::Checked> checks;
  BackgroundRun<tracer::Timeline> timeline;
  BackgroundRun<tracer::Inspection> inspection;
  BackgroundRun<tracer::CountedVisits> visits;
  BackgroundRun<ui::LoggedRays> rays;
  std::shared_ptr<const tracer::SceneBvh> measured;     // what `measures` was started for last
  std::shared_ptr<const tracer::Scene> compared;        // what `comparison` was started for last
  std::shared_ptr<const tracer::SceneBvh> inspected;    // what `inspection` was started for last
  uint64_t visited = 0;                                 // the film that `visits` was started for
  RaysWanted logged;                                    // what `rays` was started for last
  std::shared_ptr<const tracer::Settings> timeline_of;  // what `timeline` was started with last
};

// As panels see it.
ui::Work work_of(const BackgroundWork& work);

// Measures each new BVH once its first picture is complete; once a frame.
void keep_measured(BackgroundWork& work, const tracer::Snapshot& snapshot);

// Lists the nodes and counts the visits that panels on show ask for, of the newest complete
// picture; once a frame.
void keep_inspected(BackgroundWork& work, const ui::Requests& requests,
                    const tracer::Snapshot& snapshot);

// Logs the rays that a panel on show asks for, once for each film and BVH; once a frame.
void keep_logged(BackgroundWork& work, const ui::Requests& requests,
                 const tracer::Snapshot& snapshot);

// The rays of a request whose pixel is inside the picture, at once.
ui::LoggedRays logged(const ui::RayRequest& request, const tracer::Snapshot& snapshot);

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
