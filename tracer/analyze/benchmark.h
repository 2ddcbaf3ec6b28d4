// Build times and rays a second: builder x layout x kernel x ray class, beside a peer in one run.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tracer/analyze/peer.h"
#include "tracer/analyze/ray_sets.h"
#include "tracer/analyze/take_turns.h"
#include "tracer/progress.h"
#include "tracer/settings.h"

namespace tracer {

// What is traced: the scene as it stands at a moment, seen from the camera.
struct BenchmarkScene {
  const Scene& scene;
  Look look;  // camera and lights
  float time = 0.0f;
  InstanceMotion motion{};
};

// Empty lists mean all rows of their table.
struct BenchmarkOptions {
  std::vector<BuildOptions> builds = {{}};  // their layout is replaced by those below
  std::vector<std::string> layouts, kernels;
  std::vector<std::string> classes;  // of rays
  std::string isa;                   // "": the preferred one (ray_kernels.h)
  bool fast = false;                 // the fast tests beside the watertight ones, of peers too
  std::vector<int> threads = {1};    // each at least 1
  int width = 1280, height = 720;    // pixels of a view
  int turns = 5;                     // measured, after one of warm-up
  bool rays = true;                  // else builds alone
  std::vector<Ray> own_rays;         // traced as class "file", beside the classes
  bool only_own_rays = false;
};
inline constexpr int max_turns = 1000;

// A build, ours or (who not empty) of a peer.
struct BuildTiming {
  std::string who;
  std::string builder;  // of a peer's: the builder of ours that it was measured beside
  std::string layout;   // of a peer: its quality
  int threads = 1;
  Spread ms;
  int builds = 0;  // measured
  double mtris_per_s = 0.0;
  double sah = 0.0;                 // 0: not known
  double bytes_per_triangle = 0.0;  // nodes and triangles as traced
  double ratio = 0.0;               // the peer's time over ours; 0: no peer has such a build
};

// One way of tracing one set of rays with one number of threads.
struct RayTiming {
  std::string who;  // as above
  std::string builder;
  std::string layout;  // of a peer: its quality
  std::string kernel;
  std::string isa;     // "": it is the same for all
  int width = 1;       // of a peer's kernel: rays together
  bool robust = true;  // watertight tests; of a peer: as watertight as it can be
  std::string ray_class, view;
  bool any_hit = false;
  int threads = 1;
  uint64_t rays = 0, hits = 0;
  double sum_t = 0.0;   // of nearest hits, in units of the directions; 0 for any hit
  uint64_t differ = 0;  // rays that the first row of the set answers otherwise
  bool agrees = true;   // differ is within what is expected
  Spread mrays_per_s;
  int turns = 0;  // measured
  // Ours over the peer's fastest kernel of this width, robust or not as ours is.
  struct Ratio {
    int width;
    double value;
    bool operator==(const Ratio&) const = default;
  };
  std::vector<Ratio> ratios;  // by rising width; empty: no peer
};

struct Benchmark {
  std::vector<BuildTiming> builds;
  std::vector<RayTiming> rays;      // by builder, class, view and threads: ours, then the peers'
  std::vector<std::string> faults;  // sentences about rows that disagree
  bool complete = false;            // else it was stopped
};

// A nearest hit that differs by rounding counts as the same; of a peer's rays this share may
// differ, since it rounds otherwise at edges and silhouettes, and of rays by fast tests, which may
// slip through there, the larger one. Of ours by watertight tests none.
inline constexpr double tolerated_share = 1e-4;
inline constexpr double tolerated_share_of_fast = 1e-3;

// The kernel, and which tests it takes if not the watertight ones.
std::string kernel_text(const RayTiming& row);

// Throws Error for bad build options. Publishes what is there after each group of rows; stopped,
// returns what there is. Other work on the machine falsifies times.
Benchmark run_benchmark(const BenchmarkScene& scene, const BenchmarkOptions& options,
                        std::span<const PeerRow> peers, const Job& job,
                        const std::function<void(Benchmark)>& publish = nullptr);

// 1 and the number of the machine's threads.
std::vector<int> usual_threads();

// Rows of the tables above that the options choose.
std::vector<std::string> chosen_layouts(const BenchmarkOptions& options);
std::vector<std::string> chosen_kernels(const BenchmarkOptions& options, std::string_view layout);

}  // namespace tracer
