#include "tracer/analyze/comparison.h"

#include <algorithm>
#include <exception>
#include <new>

#include "tracer/analyze/epo.h"
#include "tracer/analyze/quality.h"
#include "tracer/clock.h"
#include "tracer/render/passes.h"

namespace tracer {
namespace {

// A median of several builds, unless they take long.
constexpr int most_builds = 5;
constexpr double enough_build_ms = 400.0;
// Passes that count nothing, for the speed.
constexpr int most_passes = 8;
constexpr double enough_trace_ms = 300.0;

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

std::vector<std::shared_ptr<const Blas>> build_timed(const Scene& scene, const Job& job,
                                                     ComparedBuild& row) {
  std::vector<double> times;
  std::vector<std::shared_ptr<const Blas>> blases;
  const auto all = Clock::now();
  while (times.size() < most_builds && (times.empty() || ms_since(all) < enough_build_ms)) {
    blases.clear();
    const auto start = Clock::now();
    blases = build_blases(scene, row.options, nullptr, job.stop);
    if (job.stopped()) return {};
    times.push_back(ms_since(start));
  }
  row.builds = int(times.size());
  row.build_ms = median(times);
  return blases;
}

void trace(const World& world, const ComparisonView& view, const Job& job, ComparedBuild& row) {
  const CameraFrame camera = frame(view.camera, view.width, view.height);
  Film film = first_pass(world, camera, job.stop);
  if (job.stopped()) return;
  const RayStatistics primary = ray_statistics(film)[int(RayClass::primary)];
  row.nodes_per_ray = primary.nodes.mean;
  row.triangles_per_ray = primary.triangles.mean;

  RayRate rate;
  const auto start = Clock::now();
  for (int pass = 0; pass < most_passes && ms_since(start) < enough_trace_ms; ++pass)
    rate += next_pass(world, camera, film, job.stop)[int(RayClass::primary)];
  if (rate.seconds > 0.0) row.mrays_per_s = 1e-6 * double(rate.rays) / rate.seconds;
}

// part(fraction of this row, what is done)
template <class Part>
void measure_row(const Scene& scene, const Look& look, const Job& job, const Part& part,
                 ComparedBuild& row) {
  part(0.0f, "building");
  auto blases = build_timed(scene, job, row);
  if (job.stopped()) return;
  const SceneBvh bvh =
      place_instances(scene, std::move(blases), row.options, row.view.time, row.view.motion);
  const TreeStatistics trees = blas_statistics(bvh);
  row.sah = trees.sah;
  row.nodes = trees.nodes;
  row.depth = trees.max_depth;
  row.bytes = trees.bytes;
  if (row.build_ms > 0.0) row.mtris_per_s = 1e-3 * double(trees.primitives) / row.build_ms;
  part(0.4f, "measuring EPO");
  const Epo epo = blas_epo(scene, bvh, epo_limits, job.stop);
  row.epo = epo.value;
  row.epo_standard_error = epo.standard_error;
  part(0.6f, "tracing");
  RenderOptions options;
  options.width = row.view.width;
  options.height = row.view.height;
  options.ray_depth = 0;
  options.shadows = false;
  trace({scene, bvh, look, options}, row.view, job, row);
}

constexpr ComparisonColumn columns[] = {
    {"build_ms", "Build", "ms",
     "Wall time of the trees of all meshes with all threads: the median of up to five builds",
     [](const ComparedBuild& row) { return row.build_ms; }, 2},
    {"mtris_per_s", "Mtri/s", "", "Million triangles of the meshes, built a second",
     [](const ComparedBuild& row) { return row.mtris_per_s; }, 2},
    {"sah", "SAH", "",
     "Surface area heuristic: sum over inner nodes of A(node) / A(root) Ct, and over leaves of "
     "A(node) / A(root) count Ci; weighted by triangles; unit: the costs",
     [](const ComparedBuild& row) { return row.sah; }, 2},
    {"epo", "EPO", "",
     "End-point overlap: what a ray pays at its ends for boxes that have nothing to do with the "
     "surface there. Sum over nodes n of C(n) A(surface not below n, inside box(n)) / A(surface), "
     "by random points; unit: the costs",
     [](const ComparedBuild& row) { return row.epo; }, 2},
    {"nodes", "Nodes", "", "Inner nodes and leaves of the trees of all meshes",
     [](const ComparedBuild& row) { return double(row.nodes); }, 0},
    {"depth", "Depth", "", "Edges from the root to the deepest leaf",
     [](const ComparedBuild& row) { return double(row.depth); }, 0},
    {"mib", "MiB", "", "2^20 bytes of nodes, references and leaf triangles, of all meshes",
     [](const ComparedBuild& row) { return double(row.bytes) / (1 << 20); }, 2},
    {"nodes_per_ray", "Nodes/ray", "",
     "Inner nodes that a primary ray visits, of both levels, on average over the picture",
     [](const ComparedBuild& row) { return row.nodes_per_ray; }, 2},
    {"triangles_per_ray", "Tests/ray", "", "Triangle tests of a primary ray, on average",
     [](const ComparedBuild& row) { return row.triangles_per_ray; }, 2},
    {"cost", "Cost", "",
     "What a primary ray costs: nodes Ct + triangle tests Ci, on average; unit: the costs",
     measured_cost, 2},
    {"mrays_per_s", "Mrays/s", "",
     "Million primary rays that one thread traverses in a second, without shading; from passes "
     "that count nothing",
     [](const ComparedBuild& row) { return row.mrays_per_s; }, 2},
};

}  // namespace

double measured_cost(const ComparedBuild& build) {
  return build.nodes_per_ray * double(build.options.traversal_cost) +
         build.triangles_per_ray * double(build.options.intersection_cost);
}

std::vector<ComparedBuild> compare_builds(
    const Scene& scene, const Look& look, std::span<const BuildOptions> options,
    const ComparisonView& view, const Job& job,
    const std::function<void(std::vector<ComparedBuild>)>& publish) {
  std::vector<ComparedBuild> rows(options.size());
  for (size_t i = 0; i < rows.size(); ++i) {
    rows[i].options = options[i];
    rows[i].view = view;
  }
  for (size_t i = 0; i < rows.size() && !job.stopped(); ++i) {
    ComparedBuild row = rows[i];
    const std::string name = describe(row.options);
    const auto part = [&](float fraction, std::string_view what) {
      job.progress((float(i) + fraction) / float(rows.size()), name + ": " + std::string(what));
    };
    try {
      measure_row(scene, look, job, part, row);
      row.state = BuildState::done;
    } catch (const std::bad_alloc&) {
      row.error = "there is not enough memory for it";
    } catch (const std::exception& error) {
      row.error = error.what();
    }
    if (job.stopped()) break;
    if (!row.error.empty()) row.state = BuildState::failed;
    rows[i] = row;
    if (publish) publish(rows);
  }
  return rows;
}

std::span<const ComparisonColumn> comparison_columns() {
  return columns;
}

std::vector<bool> pareto_front(std::span<const ComparedBuild> builds) {
  const auto beats = [](const ComparedBuild& a, const ComparedBuild& b) {
    const double cost_a = measured_cost(a), cost_b = measured_cost(b);
    return a.build_ms <= b.build_ms && cost_a <= cost_b &&
           (a.build_ms < b.build_ms || cost_a < cost_b);
  };
  std::vector<bool> front(builds.size());
  for (size_t i = 0; i < builds.size(); ++i) {
    front[i] = builds[i].state == BuildState::done &&
               std::none_of(builds.begin(), builds.end(), [&](const ComparedBuild& other) {
                 return other.state == BuildState::done && beats(other, builds[i]);
               });
  }
  return front;
}

std::optional<Blend> fit_blend(std::span<const ComparedBuild> builds) {
  std::vector<BlendSample> samples;
  for (const ComparedBuild& build : builds) {
    if (build.state != BuildState::done) continue;
    samples.push_back({build.sah, build.epo, measured_cost(build)});
  }
  return fit_blend(samples);
}

}  // namespace tracer
