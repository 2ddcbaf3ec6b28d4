// The benchmark's order: for each builder the builds, then every set of rays.
#include "tracer/analyze/benchmark.h"

#include <algorithm>

#include <fmt/format.h>

#include "tracer/analyze/benchmark_parts.h"
#include "tracer/bvh/ray_kernels.h"
#include "tracer/error.h"
#include "tracer/machine.h"

namespace tracer {
namespace {

// Of a peer's distances, as a share of the scene's size.
constexpr float tolerated_distance = 1e-5f;

// What is needed before anything is timed: where the instances stand, and the rays.
struct Prepared {
  std::vector<PlacedInstance> instances;
  std::vector<RaySet> sets;
  float size = 0.0f;  // of the scene
};

Prepared prepare(const BenchmarkScene& scene, const BenchmarkOptions& options, const Job& job) {
  job.progress(0.0f, "making rays");
  BuildOptions quick;
  quick.builder = "lbvh";
  auto blases = build_blases(scene.scene, quick, nullptr, job.stop);
  if (job.stopped()) return {};
  const SceneBvh bvh =
      place_instances(scene.scene, std::move(blases), quick, scene.time, scene.motion);
  Prepared prepared;
  prepared.instances = bvh.instances;
  prepared.size = glm::length(extent(bounds(bvh)));
  if (!options.rays) return prepared;
  const RaySetOptions wanted{scene.look.camera, options.width, options.height, options.classes};
  if (!options.only_own_rays)
    prepared.sets = make_ray_sets(scene.scene, bvh, scene.look.lights, wanted, job.stop);
  if (!options.own_rays.empty())
    prepared.sets.push_back({"file", "", false, false, options.own_rays});
  return prepared;
}

std::vector<PeerTree> peer_trees(const BenchmarkScene& scene, const BuildOptions& build,
                                 std::span<const PlacedInstance> instances,
                                 std::span<const PeerRow> peers, bool fast) {
  std::vector<PeerTree> trees;
  for (const PeerRow& peer : peers) {
    std::string quality(peer.other_quality);
    for (const PeerQualityRow& row : peer.qualities)
      if (row.builder == build.builder) quality = row.id;
    for (const bool robust : {true, false})
      if (robust || fast)
        trees.push_back(
            {&peer, quality, robust, peer.build(scene.scene, instances, quality, robust)});
  }
  return trees;
}

// Each piece of work takes about as long as another.
class Progress {
 public:
  Progress(const Job& job, size_t parts) : job_(job), parts_(parts) {}
  void next(const std::string& what) { job_.progress(float(done_++) / float(parts_), what); }

 private:
  const Job& job_;
  size_t parts_, done_ = 0;
};

std::string title(const BuildOptions& build, const RaySet& set) {
  return fmt::format("{}: {} rays{}{}", build.builder, set.id, set.view.empty() ? "" : ", ",
                     set.view);
}

template <class Row>
std::vector<std::string> chosen(std::span<const Row> rows, const std::vector<std::string>& ids) {
  std::vector<std::string> result;
  for (const Row& row : rows) {
    if (ids.empty() || std::find(ids.begin(), ids.end(), row.id) != ids.end())
      result.emplace_back(row.id);
  }
  return result;
}

}  // namespace

Benchmark run_benchmark(const BenchmarkScene& scene, const BenchmarkOptions& options,
                        std::span<const PeerRow> peers, const Job& job,
                        const std::function<void(Benchmark)>& publish) {
  for (const BuildOptions& build : options.builds)
    check(build);
  Benchmark result;
  const Prepared prepared = prepare(scene, options, job);
  std::vector<std::vector<float>> references(prepared.sets.size());
  Progress progress(job, options.builds.size() * (1 + prepared.sets.size()));
  for (const BuildOptions& build : options.builds) {
    if (job.stopped()) return result;
    progress.next(build.builder + ": building");
    const std::vector<SceneBvh> bvhs =
        time_builds(scene, options, build, prepared.instances, peers, job, result);
    if (job.stopped()) return result;
    if (publish) publish(result);
    std::vector<PeerTree> trees;
    if (!prepared.sets.empty())
      trees = peer_trees(scene, build, prepared.instances, peers, options.fast);
    for (size_t i = 0; i < prepared.sets.size(); ++i) {
      progress.next(title(build, prepared.sets[i]));
      time_rays({prepared.sets[i], bvhs, trees, references[i], tolerated_distance * prepared.size},
                options, job, result);
      if (job.stopped()) return result;
      if (publish) publish(result);
    }
  }
  result.complete = true;
  return result;
}

std::string kernel_text(const RayTiming& row) {
  return row.robust ? row.kernel : row.kernel + ", fast";
}

std::vector<int> usual_threads() {
  const int all = thread_count();
  return all == 1 ? std::vector<int>{1} : std::vector<int>{1, all};
}

std::vector<std::string> chosen_layouts(const BenchmarkOptions& options) {
  return chosen(layouts(), options.layouts);
}

std::vector<std::string> chosen_kernels(const BenchmarkOptions& options, std::string_view layout) {
  std::vector<std::string> kernels = chosen(ray_kernels(), options.kernels);
  std::erase_if(kernels, [&](const std::string& id) { return !has_kernel(layout, id); });
  return kernels;
}

}  // namespace tracer
