// What panels on show ask for, frame by frame: it is made once for each picture, tree or choice,
// and kept until there is something newer.
#pragma once

#include <memory>

#include "ui/workspace.h"

namespace app {

struct BackgroundWork;

inline constexpr size_t most_hot_spots = 100;  // listed

// What each kind of work was started for.
struct HotWanted {
  std::shared_ptr<const tracer::Inspection> inspection;
  std::shared_ptr<const tracer::CountedVisits> counted;
  int ray_class = tracer::ray_class_count;
  bool operator==(const HotWanted&) const = default;
};
struct PixelsWanted {
  tracer::Watched node;
  uint64_t film = 0;
  bool operator==(const PixelsWanted&) const = default;
};
struct SplitsWanted {
  ui::NodePlace place;
  std::shared_ptr<const tracer::SceneBvh> bvh;
  bool operator==(const SplitsWanted&) const = default;
};
struct RaysWanted {
  ui::RayRequest request;
  uint64_t film = 0;
  std::shared_ptr<const tracer::SceneBvh> bvh;
  bool operator==(const RaysWanted&) const = default;
};
struct ReplayWanted {
  std::shared_ptr<const void> tree;  // a BLAS; of the TLAS all of the BVH
  uint32_t mesh = tracer::none;
  bool operator==(const ReplayWanted&) const = default;
};

// Makes what is asked for of the newest complete picture; once a frame.
void keep_inspected(BackgroundWork& work, const ui::Requests& requests,
                    const tracer::Snapshot& snapshot);

// Logs the rays that a panel on show asks for, once for each film and BVH; once a frame.
void keep_logged(BackgroundWork& work, const ui::Requests& requests,
                 const tracer::Snapshot& snapshot);

// Makes all of it at once, for a picture of the workspace.
void answer(ui::Work& work, const ui::Requests& requests, const tracer::Snapshot& snapshot);

}  // namespace app
