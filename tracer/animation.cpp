// Which trees a moment of an animation has, by strategy.
#include "tracer/animation.h"

#include <atomic>
#include <cmath>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "tracer/analyze/quality.h"
#include "tracer/choice.h"
#include "tracer/clock.h"

namespace tracer {
namespace {

using Blases = std::vector<std::shared_ptr<const Blas>>;

// One call of pose_trees: its inputs, and what it has spent.
class Poser {
 public:
  Poser(const Animation& animation, AnimationCache& cache, const Job& job, BuildLog* log)
      : animation_(animation), cache_(cache), job_(job), log_(log) {
    if (cache.deformer != animation.deformer || cache.update != animation.update) {
      cache.built.reset();
      cache.deformer = animation.deformer;
      cache.update = animation.update;
    }
  }

  PosedTrees at(float time) {
    PosedTrees result;
    auto start = Clock::now();
    result.scene = shape(time);
    result.facts.deformed = result.scene != animation_.rest;
    if (result.facts.deformed) result.facts.deform_ms = ms_since(start);
    Source source = trees_for(time, result.scene);
    if (job_.stopped()) return {};
    result.facts.built_time = source.time;
    if (!source.fits) {
      start = Clock::now();
      source.blases = refit_to(source.blases, *result.scene);
      result.facts.refitted = true;
      result.facts.refit_ms = ms_since(start);
      result.facts.warning = split_warning(source.blases);
    }
    result.blases = std::move(source.blases);
    result.facts.build_ms = build_ms_;
    return result;
  }

 private:
  struct Source {
    Blases blases;
    float time = -1.0f;
    bool fits = false;  // built over just this shape
  };

  std::shared_ptr<const Scene> shape(float time) const {
    return deformed(animation_.rest, animation_.deformer, time);
  }

  Source trees_for(float time, const std::shared_ptr<const Scene>& scene) {
    const std::string& strategy = animation_.update.strategy;
    if (!is_active(animation_.deformer)) {
      cache_.copies.clear();
      return {rest_trees(), -1.0f, true};
    }
    if (strategy == "rebuild") return {built_over(*scene), time, true};
    if (strategy == "every") return periodic(time, scene);
    if (strategy == "growth") return grown_to(time, scene);
    return {rest_trees(), -1.0f, scene == animation_.rest};
  }

  Blases built_over(const Scene& scene) {
    const auto start = Clock::now();
    Blases blases = build_blases(scene, animation_.build, log_, job_.stop);
    build_ms_ += ms_since(start);
    return blases;
  }

  const Blases& rest_trees() {
    if (cache_.rest.empty()) cache_.rest = built_over(*animation_.rest);
    return cache_.rest;
  }

  Blases refit_to(const Blases& built, const Scene& scene) {
    Blases result(built.size());
    cache_.copies.resize(built.size());
    tbb::parallel_for(size_t{0}, built.size(), [&](size_t i) {
      result[i] = refit_copy(built[i], scene.meshes[i], cache_.copies[i]);
    });
    return result;
  }

  static std::shared_ptr<const Blas> refit_copy(const std::shared_ptr<const Blas>& built,
                                                const Mesh& mesh,
                                                std::vector<AnimationCache::Copy>& copies) {
    for (AnimationCache::Copy& copy : copies) {
      if (copy.of != built || copy.blas.use_count() > 1) continue;
      std::atomic_thread_fence(std::memory_order_acquire);  // after the last reader let go of it
      refit(*copy.blas, mesh);
      return copy.blas;
    }
    std::erase_if(copies, [&](const AnimationCache::Copy& copy) { return copy.of != built; });
    constexpr size_t most_copies = 3;  // shown, being traced, being refitted
    std::shared_ptr<Blas> blas = refitted(*built, mesh);
    if (copies.size() < most_copies) copies.push_back({built, blas});
    return blas;
  }

  double sah_of(const Blases& blases) const {
    SceneBvh bvh;
    bvh.blases = blases;
    bvh.options = animation_.build;
    return blas_statistics(bvh).sah;
  }

  // A held shape is that of frame 0.
  int64_t frame_of(float time) const {
    if (!is_moving(animation_.deformer)) return 0;
    return frame_at(time, animation_.update.frames_per_second);
  }
  float start_of(int64_t frame) const {
    return time_of(frame, animation_.update.frames_per_second);
  }

  // A shape that is the rest mesh has the trees of the rest mesh.
  Blases built_at(int64_t frame) {
    const std::shared_ptr<const Scene> scene = shape(start_of(frame));
    return scene == animation_.rest ? rest_trees() : built_over(*scene);
  }

  bool same_shape(float a, float b) const { return a == b || !is_moving(animation_.deformer); }

  Source periodic(float time, const std::shared_ptr<const Scene>& scene) {
    const int64_t every = animation_.update.every;
    const int64_t frame = frame_of(time) / every * every;
    if (!cache_.built || cache_.built->frame != frame) {
      Blases blases = built_at(frame);
      if (job_.stopped()) return {};
      cache_.built = AnimationCache::Built{blases, frame, 0, frame, 0.0};
    }
    const bool at_rest = scene == animation_.rest && cache_.built->blases == cache_.rest;
    return {cache_.built->blases, start_of(frame), at_rest || same_shape(time, start_of(frame))};
  }

  // The first frame of the swing that `time` is in. Each swing begins at rest, so what comes before
  // it need not be gone through.
  int64_t swing_begin(float time) const {
    const Deformer& deformer = animation_.deformer;
    if (!is_moving(deformer)) return 0;
    const double swing = std::floor(double(deformer.speed) * double(time) + 1e-6);
    const double start = swing / double(deformer.speed);
    return int64_t(std::ceil(start * double(animation_.update.frames_per_second) - 1e-3));
  }

  // Goes through the frames of the swing up to now as an engine would.
  Source grown_to(float time, const std::shared_ptr<const Scene>& scene) {
    const int64_t last = frame_of(time);
    const int64_t first = std::min(swing_begin(time), last);
    std::optional<AnimationCache::Built>& built = cache_.built;
    if (!built || built->swing != first || built->seen > last) {
      const Blases& rest = rest_trees();
      if (job_.stopped()) return {};
      built = AnimationCache::Built{rest, -1, first, first - 1, sah_of(rest)};
    }
    while (built->seen < last) {
      if (job_.stopped()) return {};
      const int64_t frame = built->seen + 1;
      job_.progress(float(frame - first) / float(last - first + 1), "following the growth");
      const std::shared_ptr<const Scene> then = shape(start_of(frame));
      const double sah = then == animation_.rest && built->frame < 0
                             ? built->sah
                             : sah_of(refit_to(built->blases, *then));
      if (sah > double(animation_.update.growth) * built->sah) {
        Blases blases = then == animation_.rest ? rest_trees() : built_over(*then);
        if (job_.stopped()) return {};
        built->sah = sah_of(blases);
        built->blases = std::move(blases);
        built->frame = frame;
      }
      built->seen = frame;
    }
    if (built->frame < 0) return {built->blases, -1.0f, scene == animation_.rest};
    return {built->blases, start_of(built->frame), same_shape(time, start_of(built->frame))};
  }

  std::string split_warning(const Blases& blases) const {
    size_t split = 0;
    for (size_t i = 0; i < blases.size(); ++i)
      split += has_split_references(*blases[i], animation_.rest->meshes[i]) ? 1 : 0;
    if (split == 0) return {};
    return fmt::format(
        "{} of {} trees have split references; a refit gives their leaves the boxes of whole "
        "triangles, which are larger: rebuild instead, or choose a builder that splits no "
        "triangles",
        split, blases.size());
  }

  const Animation& animation_;
  AnimationCache& cache_;
  const Job& job_;
  BuildLog* log_;
  double build_ms_ = 0.0;
};

}  // namespace

int64_t frame_at(float time, float frames_per_second) {
  return int64_t(std::floor(double(time) * double(frames_per_second) + 1e-3));
}

float time_of(int64_t frame, float frames_per_second) {
  return float(double(frame) / double(frames_per_second));
}

PosedTrees pose_trees(const Animation& animation, float time, AnimationCache& cache, const Job& job,
                      BuildLog* log) {
  check(animation.update);
  return Poser(animation, cache, job, log).at(time);
}

}  // namespace tracer
