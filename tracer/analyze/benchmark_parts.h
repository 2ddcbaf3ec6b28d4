// What the files of the benchmark share.
#pragma once

#include "tracer/analyze/benchmark.h"

namespace tracer {

// Times building with each layout and number of threads, peers between; appends rows. Gives the
// BVHs, one a chosen layout; fewer if stopped.
std::vector<SceneBvh> time_builds(const BenchmarkScene& scene, const BenchmarkOptions& options,
                                  const BuildOptions& build,
                                  std::span<const PlacedInstance> instances,
                                  std::span<const PeerRow> peers, const Job& job,
                                  Benchmark& result);

// A peer's scene for tracing, of the quality that goes with a builder.
struct PeerTree {
  const PeerRow* peer;
  std::string quality;
  bool robust;
  PeerScene scene;
};

// One set of rays and everything that traces it.
struct RayGroup {
  const RaySet& set;
  std::span<const SceneBvh> bvhs;
  std::span<const PeerTree> peers;
  std::vector<float>& reference;  // t of each ray; filled by the first that traces the set
  float tolerance;                // in units of the world: of a peer's distances
};

// Traces the set with every kernel and each number of threads in turns; appends rows.
void time_rays(const RayGroup& group, const BenchmarkOptions& options, const Job& job,
               Benchmark& result);

}  // namespace tracer
