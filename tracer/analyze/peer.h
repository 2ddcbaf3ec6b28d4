// Other ray tracers that a benchmark measures beside ours. They are rows that the program passes
// in: the library knows none of them.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "tracer/analyze/ray_sets.h"
#include "tracer/bvh/scene_bvh.h"

namespace tracer {

// A way of the peer to trace.
struct PeerKernelRow {
  std::string_view id, label, help;
  int width = 1;               // rays together; ratios name it
  bool coherent_only = false;  // makes sense for coherent rays alone
};

// A way of the peer to build, and the builder of ours that does the same.
struct PeerQualityRow {
  std::string_view id, builder;
  bool not_robust = false;  // robust builds of this quality would do something else
};

// One kernel with one set of rays, brought into the form that the kernel wants beforehand.
struct PeerTracer {
  // Traces rays [first, last); several threads may trace different parts at once. `first` is a
  // multiple of 64.
  std::function<void(size_t first, size_t last)> trace;
  // Of a traced ray: the hit's t, 0 for any hit; infinity where nothing is hit.
  std::function<float(size_t ray)> t;
};

// A scene as the peer holds it.
struct PeerScene {
  std::function<void()> rebuild;  // the trees of all meshes again, from scratch
  // What the peer cannot do in this scene has no `trace`.
  std::function<PeerTracer(std::string_view kernel, const RaySet& rays)> tracer;
  uint64_t bytes = 0;  // that it took of the memory; 0: unknown
};

struct PeerRow {
  std::string_view id, label;
  std::string version;
  std::span<const PeerKernelRow> kernels;
  std::span<const PeerQualityRow> qualities;
  std::string_view other_quality;  // beside builders that no quality names
  // The instances stand as in `instances`. Robust: as watertight as the peer can be. What it
  // returns keeps the peer's memory; scene and instances may go.
  PeerScene (*build)(const Scene& scene, std::span<const PlacedInstance> instances,
                     std::string_view quality, bool robust) = nullptr;
};

}  // namespace tracer
