// The trees of a scene at one moment of its animation: deformed, then refitted or built anew.
#pragma once

#include <optional>

#include "tracer/bvh/refit.h"
#include "tracer/bvh/update.h"
#include "tracer/progress.h"
#include "tracer/scene/deform.h"

namespace tracer {

// Which meshes move how, and what becomes of their trees.
struct Animation {
  std::shared_ptr<const Scene> rest;  // as loaded
  BuildOptions build;
  Deformer deformer;
  UpdateOptions update;
};

// What the update of a frame was and cost.
struct UpdateFacts {
  bool deformed = false;
  bool refitted = false;  // the trees were built over another shape
  float built_time =
      -1.0f;               // seconds; the moment whose shape the trees were built over; -1: at rest
  double deform_ms = 0.0;  // wall time, all meshes
  double refit_ms = 0.0;   // wall time, all BLASes
  double build_ms = 0.0;   // wall time of the builds that this moment asked for
  std::string warning;     // what a refit could not keep

  bool operator==(const UpdateFacts&) const = default;
};

struct PosedTrees {
  std::shared_ptr<const Scene> scene;
  std::vector<std::shared_ptr<const Blas>> blases;
  UpdateFacts facts;
};

// What goes on from one moment to the next; it never changes the result. Forget it when the scene
// or the build options change.
struct AnimationCache {
  std::vector<std::shared_ptr<const Blas>> rest;  // trees of the scene as loaded

  // The newest trees that were built on the way, and up to which frame that is known.
  struct Built {
    std::vector<std::shared_ptr<const Blas>> blases;
    int64_t frame = 0, swing = 0, seen = -1;
    double sah = 0.0;
  };
  std::optional<Built> built;

  // Refitted copies that nobody looks at any more are refitted again: fresh memory for each frame
  // would cost more than the refit.
  struct Copy {
    std::shared_ptr<const Blas> of;
    std::shared_ptr<Blas> blas;
  };
  std::vector<std::vector<Copy>> copies;  // a few a mesh
  Deformer deformer;                      // that `built` belongs to
  UpdateOptions update;
};

// Frame 0 is at time 0. The last frame that has begun.
int64_t frame_at(float time, float frames_per_second);
float time_of(int64_t frame, float frames_per_second);

// A pure function of animation and time: which trees are kept from when follows from the strategy
// and the frames since time 0, not from what was asked for before. A stopped job gives no trees.
// `log` counts the references of a build. Throws Error for bad options.
PosedTrees pose_trees(const Animation& animation, float time, AnimationCache& cache, const Job& job,
                      BuildLog* log = nullptr);

}  // namespace tracer
