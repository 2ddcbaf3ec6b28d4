// Rays a second: all kernels with one set of rays, in turns, their answers compared first.
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "tracer/analyze/benchmark_parts.h"
#include "tracer/bvh/ray_kernels.h"
#include "tracer/choice.h"

namespace tracer {
namespace {

// Rays that a kernel gets at once: a multiple of what any kernel takes together.
constexpr size_t chunk = 4096;

// Somebody who traces the set.
struct Entrant {
  RayTiming row;
  std::function<void(size_t first, size_t last)> trace;
  std::function<float(size_t ray)> t;
};

// What our kernels write, one after the other.
struct Answers {
  std::vector<Hit> hits;
  std::vector<uint8_t> blocked;
};

std::string isa_of(const BenchmarkOptions& options, std::string_view layout,
                   std::string_view kernel) {
  if (find_row(layouts(), layout)->width == 2 && kernel == "single") return "";
  return options.isa.empty() ? std::string(preferred_isa().id) : options.isa;
}

Entrant our_entrant(const RaySet& set, const SceneBvh& bvh, const std::string& kernel, bool robust,
                    const BenchmarkOptions& options, Answers& answers) {
  Entrant entrant;
  entrant.row.builder = bvh.options.builder;
  entrant.row.layout = bvh.options.layout;
  entrant.row.kernel = kernel;
  entrant.row.isa = isa_of(options, bvh.options.layout, kernel);
  entrant.row.robust = robust;
  const RayKernel found =
      ray_kernel(bvh.options.layout, kernel, options.isa, robust ? Tests::watertight : Tests::fast);
  const std::span<const Ray> rays = set.rays;
  if (set.any_hit) {
    const std::span<uint8_t> blocked = answers.blocked;
    entrant.trace = [=, &bvh](size_t first, size_t last) {
      found.occluded(bvh, rays.subspan(first, last - first), blocked.subspan(first, last - first));
    };
    entrant.t = [=](size_t ray) { return blocked[ray] != 0 ? 0.0f : infinity; };
  } else {
    const std::span<Hit> hits = answers.hits;
    entrant.trace = [=, &bvh](size_t first, size_t last) {
      found.intersect(bvh, rays.subspan(first, last - first), hits.subspan(first, last - first));
    };
    entrant.t = [=](size_t ray) { return hits[ray].t; };
  }
  return entrant;
}

Entrant peer_entrant(const RaySet& set, const PeerTree& tree, const PeerKernelRow& kernel,
                     std::string_view builder) {
  PeerTracer tracer = tree.scene.tracer(kernel.id, set);
  Entrant entrant;
  entrant.row.who = tree.peer->id;
  entrant.row.builder = builder;
  entrant.row.layout = tree.quality;
  entrant.row.kernel = kernel.id;
  entrant.row.width = kernel.width;
  entrant.row.robust = tree.robust;
  entrant.trace = std::move(tracer.trace);
  entrant.t = std::move(tracer.t);
  return entrant;
}

std::vector<Entrant> entrants_of(const RayGroup& group, const BenchmarkOptions& options,
                                 Answers& answers) {
  std::vector<Entrant> entrants;
  for (const SceneBvh& bvh : group.bvhs) {
    for (const std::string& kernel : chosen_kernels(options, bvh.options.layout)) {
      entrants.push_back(our_entrant(group.set, bvh, kernel, true, options, answers));
      if (options.fast)
        entrants.push_back(our_entrant(group.set, bvh, kernel, false, options, answers));
    }
  }
  for (const PeerTree& tree : group.peers) {
    for (const PeerKernelRow& kernel : tree.peer->kernels) {
      if (kernel.coherent_only && !group.set.coherent) continue;
      Entrant entrant = peer_entrant(group.set, tree, kernel, group.bvhs.front().options.builder);
      if (entrant.trace) entrants.push_back(std::move(entrant));
    }
  }
  for (Entrant& entrant : entrants) {
    entrant.row.ray_class = group.set.id;
    entrant.row.view = group.set.view;
    entrant.row.any_hit = group.set.any_hit;
    entrant.row.rays = group.set.rays.size();
  }
  return entrants;
}

void trace_all(const Entrant& entrant, size_t rays, int threads, const std::stop_token& stop) {
  const auto part = [&](size_t first) {
    if (!stop.stop_requested()) entrant.trace(first, std::min(first + chunk, rays));
  };
  if (threads == 1) {
    for (size_t first = 0; first < rays; first += chunk)
      part(first);
    return;
  }
  tbb::parallel_for(size_t{0}, (rays + chunk - 1) / chunk, [&](size_t i) { part(i * chunk); });
}

// How far a distance may be off; that of our watertight tests may not be off at all.
bool is_same(float ours, float theirs, float tolerance) {
  if (ours == theirs) return true;
  if (!std::isfinite(ours) || !std::isfinite(theirs)) return false;
  return std::abs(ours - theirs) <= tolerance + 1e-4f * std::abs(ours) * (tolerance > 0.0f);
}

std::string name_of(const RayTiming& row) {
  return fmt::format("{} {} {}", row.who.empty() ? row.builder : row.who, row.layout,
                     kernel_text(row));
}

// Sums what the entrant answered, and holds it against the reference.
void check_answers(Entrant& entrant, const RayGroup& group) {
  RayTiming& row = entrant.row;
  const bool is_first = group.reference.empty();
  if (is_first) group.reference.resize(row.rays);
  const bool is_exact = row.who.empty() && row.robust;
  const float tolerance = is_exact ? 0.0f : group.tolerance;
  row.hits = row.differ = 0;
  row.sum_t = 0.0;
  for (size_t i = 0; i < row.rays; ++i) {
    const float t = entrant.t(i);
    if (is_first) group.reference[i] = t;
    const float length = glm::length(group.set.rays[i].direction);
    if (!is_same(group.reference[i], t, tolerance / length)) ++row.differ;
    if (t == infinity) continue;
    ++row.hits;
    row.sum_t += double(t);
  }
  const double share = row.robust ? tolerated_share : tolerated_share_of_fast;
  const double tolerated = is_exact ? 0.0 : 2.0 + share * double(row.rays);
  row.agrees = double(row.differ) <= tolerated;
}

void add_ratios(std::span<RayTiming> rows) {
  std::map<int, double> of_peers[2];  // the best ones by width; fast and robust
  for (const RayTiming& row : rows) {
    if (row.who.empty()) continue;
    double& best = of_peers[row.robust][row.width];
    best = std::max(best, row.mrays_per_s.median);
  }
  for (RayTiming& row : rows) {
    if (!row.who.empty()) continue;
    for (const auto& [width, speed] : of_peers[row.robust]) {
      if (speed > 0.0) row.ratios.push_back({width, row.mrays_per_s.median / speed});
    }
  }
}

void time_with(const RayGroup& group, std::span<Entrant> entrants, int threads,
               const BenchmarkOptions& options, const Job& job, Benchmark& result) {
  std::vector<std::function<void()>> works;
  for (const Entrant& entrant : entrants) {
    works.emplace_back([&, threads] { trace_all(entrant, entrant.row.rays, threads, job.stop); });
  }
  const auto seconds = take_turns(
      works, {.threads = threads, .turns = options.turns, .stop = job.stop},
      [&](size_t i) { check_answers(entrants[i], group); }, nullptr);
  if (job.stopped()) return;
  const size_t first = result.rays.size();
  for (size_t i = 0; i < entrants.size(); ++i) {
    RayTiming& row = result.rays.emplace_back(entrants[i].row);
    row.threads = threads;
    std::vector<double> rates;
    for (const double value : seconds[i])
      if (value > 0.0) rates.push_back(1e-6 * double(row.rays) / value);
    row.turns = int(rates.size());
    row.mrays_per_s = spread_of(std::move(rates));
    if (row.agrees) continue;
    result.faults.push_back(
        fmt::format("{}{}{}, {} threads: {} answers {} of {} rays otherwise than {}", row.ray_class,
                    row.view.empty() ? "" : ", ", row.view, threads, name_of(row), row.differ,
                    row.rays, name_of(result.rays[first])));
  }
  add_ratios(std::span(result.rays).subspan(first));
}

}  // namespace

void time_rays(const RayGroup& group, const BenchmarkOptions& options, const Job& job,
               Benchmark& result) {
  Answers answers;
  if (group.set.any_hit) {
    answers.blocked.resize(group.set.rays.size());
  } else {
    answers.hits.resize(group.set.rays.size());
  }
  std::vector<Entrant> entrants = entrants_of(group, options, answers);
  for (const int threads : options.threads) {
    if (job.stopped()) return;
    time_with(group, entrants, threads, options, job, result);
  }
}

}  // namespace tracer
