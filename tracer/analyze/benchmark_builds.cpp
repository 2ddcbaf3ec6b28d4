// Build times, ours and the peer's in turns.
#include <algorithm>

#include <fmt/format.h>

#include "tracer/analyze/benchmark_parts.h"
#include "tracer/analyze/quality.h"

namespace tracer {
namespace {

// Further turns are left out once a group of builds has taken so long.
constexpr double enough_seconds = 4.0;

using Blases = std::vector<std::shared_ptr<const Blas>>;

// The layout with its triangles, as it is traced.
uint64_t traced_bytes(const Blas& blas) {
  const bool is_wide = !std::holds_alternative<std::monostate>(blas.wide);
  return is_wide ? bytes(blas.wide) : bytes(blas);
}

double triangles_of(const Scene& scene) {
  uint64_t sum = 0;
  for (const Mesh& mesh : scene.meshes)
    sum += mesh.triangles.size();
  return double(sum);
}

BuildTiming ours(const BenchmarkScene& scene, const BuildOptions& build, const SceneBvh& bvh) {
  BuildTiming row;
  row.builder = build.builder;
  row.layout = build.layout;
  row.sah = blas_statistics(bvh).sah;
  uint64_t size = 0;
  for (const auto& blas : bvh.blases)
    size += traced_bytes(*blas);
  row.bytes_per_triangle = double(size) / triangles_of(scene.scene);
  return row;
}

void fill_times(BuildTiming& row, std::vector<double> seconds, int threads, double triangles) {
  for (double& value : seconds)
    value *= 1e3;
  row.threads = threads;
  row.builds = int(seconds.size());
  row.ms = spread_of(std::move(seconds));
  if (row.ms.median > 0.0) row.mtris_per_s = 1e-3 * triangles / row.ms.median;
}

// A peer's build that corresponds to the builder.
struct PeerBuild {
  BuildTiming row;
  PeerScene scene;
};

std::vector<PeerBuild> peer_builds(const BenchmarkScene& scene, const BuildOptions& build,
                                   std::span<const PlacedInstance> instances,
                                   std::span<const PeerRow> peers) {
  std::vector<PeerBuild> builds;
  for (const PeerRow& peer : peers) {
    for (const PeerQualityRow& quality : peer.qualities) {
      if (quality.builder != build.builder) continue;
      PeerBuild& added = builds.emplace_back();
      added.scene = peer.build(scene.scene, instances, quality.id, !quality.not_robust);
      added.row.who = peer.id;
      added.row.builder = build.builder;
      added.row.layout = quality.id;
      added.row.bytes_per_triangle = double(added.scene.bytes) / triangles_of(scene.scene);
    }
  }
  return builds;
}

void add_ratios(std::span<BuildTiming> rows) {
  for (BuildTiming& row : rows) {
    if (!row.who.empty() || row.ms.median <= 0.0) continue;
    for (const BuildTiming& peer : rows) {
      if (!peer.who.empty() && peer.ms.median > 0.0) row.ratio = peer.ms.median / row.ms.median;
    }
  }
}

}  // namespace

std::vector<SceneBvh> time_builds(const BenchmarkScene& scene, const BenchmarkOptions& options,
                                  const BuildOptions& build,
                                  std::span<const PlacedInstance> instances,
                                  std::span<const PeerRow> peers, const Job& job,
                                  Benchmark& result) {
  std::vector<BuildOptions> wanted;
  for (const std::string& layout : chosen_layouts(options)) {
    wanted.push_back(build);
    wanted.back().layout = layout;
  }
  std::vector<Blases> blases(wanted.size());
  std::vector<PeerBuild> theirs = peer_builds(scene, build, instances, peers);
  std::vector<std::function<void()>> works;
  for (size_t i = 0; i < wanted.size(); ++i) {
    works.emplace_back([&, i] {
      blases[i].clear();
      blases[i] = build_blases(scene.scene, wanted[i], nullptr, job.stop);
    });
  }
  for (PeerBuild& peer : theirs)
    works.emplace_back([&peer] { peer.scene.rebuild(); });

  std::vector<SceneBvh> bvhs;
  for (const int threads : options.threads) {
    const TurnOptions turns{threads, options.turns, enough_seconds, job.stop};
    const auto seconds = take_turns(works, turns, nullptr, nullptr);
    if (job.stopped()) return {};
    if (bvhs.empty()) {
      for (size_t i = 0; i < wanted.size(); ++i)
        bvhs.push_back(
            place_instances(scene.scene, blases[i], wanted[i], scene.time, scene.motion));
    }
    const size_t first = result.builds.size();
    for (size_t i = 0; i < works.size(); ++i) {
      result.builds.push_back(i < wanted.size() ? ours(scene, wanted[i], bvhs[i])
                                                : theirs[i - wanted.size()].row);
      fill_times(result.builds.back(), seconds[i], threads, triangles_of(scene.scene));
    }
    add_ratios(std::span(result.builds).subspan(first));
  }
  return bvhs;
}

}  // namespace tracer
