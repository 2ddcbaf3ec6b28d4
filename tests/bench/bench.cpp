// Speed against Embree (single rays, robust mode) in one run: both sides take turns, and medians
// and their ratio are printed. Hits and the sum of their distances are compared before anything
// counts. Usage: tests_bench [SCENE ...]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <functional>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "tests/embree_scene.h"
#include "tracer/analyze/quality.h"
#include "tracer/bvh/traverse.h"
#include "tracer/error.h"
#include "tracer/pipeline.h"
#include "tracer/render/colorize.h"
#include "tracer/render/views.h"

namespace {

using namespace tracer;

constexpr int turns = 7;
constexpr int width = 1280;
constexpr int height = 720;

using Clock = double (*)();

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
// Of this thread: not disturbed by what else the machine does.
double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double seconds_of(Clock clock, const std::function<void()>& work) {
  const double start = clock();
  work();
  return clock() - start;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

// Median seconds of each, after one turn of warm-up.
struct Pair {
  double a, b;
};
Pair take_turns(Clock clock, const std::function<void()>& a, const std::function<void()>& b) {
  std::vector<double> times_a, times_b;
  for (int turn = 0; turn <= turns; ++turn) {
    const double time_a = seconds_of(clock, a);
    const double time_b = seconds_of(clock, b);
    if (turn == 0) continue;
    times_a.push_back(time_a);
    times_b.push_back(time_b);
  }
  return {median(times_a), median(times_b)};
}

// In tiles of 8 x 8 pixels.
std::vector<Ray> primary_rays(const Camera& camera) {
  std::vector<Ray> rays;
  const CameraFrame view = frame(camera, width, height);
  for (int tile = 0; tile < width / 8 * (height / 8); ++tile) {
    for (int i = 0; i < 64; ++i) {
      const int x = tile % (width / 8) * 8 + i % 8;
      const int y = tile / (width / 8) * 8 + i / 8;
      rays.push_back(primary_ray(view, vec2(x, y) + 0.5f));
    }
  }
  return rays;
}

struct Sum {
  uint64_t hits = 0;
  double t = 0.0;

  void add(const Hit& hit) {
    if (!is_hit(hit)) return;
    ++hits;
    t += hit.t;
  }
};

// The traversal without any hooks, written out by hand for one instance: what NoProbe has to equal.
Hit intersect_without_hooks(const SceneBvh& bvh, const Ray& ray) {
  Hit hit;
  if (!is_valid(ray)) return hit;
  const BoxRay top = box_ray(ray.origin, ray.direction);
  if (!box_span(bvh.tlas.nodes[0], top, ray.t_min, ray.t_max).hit) return hit;
  const PlacedInstance& instance = bvh.instances[bvh.tlas.references[0]];
  const Blas& blas = *bvh.blases[instance.mesh];
  const vec3 origin(instance.to_object * vec4(ray.origin, 1.0f));
  const vec3 direction(instance.to_object * vec4(ray.direction, 0.0f));
  const BoxRay box = box_ray(origin, direction);
  const TriangleRay test = triangle_ray(origin, direction, box.inverse);
  struct Waiting {
    uint32_t node;
    float entry;
  };
  std::array<Waiting, max_tree_depth> stack;
  uint32_t waiting = 0;
  float t_max = ray.t_max;
  uint32_t index = 0;
  if (!box_span(blas.tree.nodes[0], box, ray.t_min, t_max).hit) return hit;
  while (true) {
    const BvhNode& node = blas.tree.nodes[index];
    if (is_leaf(node)) {
      for (uint32_t i = node.first; i < node.first + node.count; ++i) {
        const TriangleHit found = intersect(blas.triangles[i], test, ray.t_min, t_max);
        if (!found.hit) continue;
        const uint32_t triangle = blas.tree.references[i];
        if (found.t == hit.t && !is_before(0, triangle, hit)) continue;
        hit = {found.t, found.u, found.v, triangle, 0};
        t_max = found.t;
      }
    } else {
      const BvhNode* nodes = blas.tree.nodes.data();
      __builtin_prefetch(nodes + nodes[node.first].first);
      __builtin_prefetch(nodes + nodes[node.first + 1].first);
      const BoxPairSpan span = box_pair_span(&blas.tree.nodes[node.first], box, ray.t_min, t_max);
      if (span.hit == 3) {
        uint32_t far = 0;
        if (span.entry[0] <= span.entry[1]) {
          keep_branch();
          far = 1;
        }
        stack[waiting++] = {node.first + far, span.entry[far]};
        index = node.first + 1 - far;
        continue;
      }
      if (span.hit != 0) {
        index = node.first;
        if (span.hit == 2) {
          keep_branch();
          ++index;
        }
        continue;
      }
    }
    do {
      if (waiting == 0) return hit;
      --waiting;
    } while (stack[waiting].entry > t_max * exit_padding);
    index = stack[waiting].node;
  }
}

void bench_rays(const std::string& name, const SceneBvh& bvh, const test::EmbreeScene& embree,
                const std::vector<Ray>& rays) {
  Sum ours, theirs;
  const Pair times = take_turns(
      cpu_seconds,
      [&] {
        ours = {};
        NoProbe probe;
        for (const Ray& ray : rays)
          ours.add(intersect(bvh, ray, probe));
      },
      [&] {
        theirs = {};
        for (const Ray& ray : rays)
          theirs.add(embree.intersect(ray));
      });
  const double mrays = 1e-6 * static_cast<double>(rays.size());
  fmt::print(
      "{:28} primary, 1 thread   {:7.2f} Mrays/s, Embree {:7.2f}   ratio {:.2f}   hits {} {}, "
      "sum t {:.6g} {:.6g}\n",
      name, mrays / times.a, mrays / times.b, times.b / times.a, ours.hits, theirs.hits, ours.t,
      theirs.t);
  const double hit_difference =
      std::abs(static_cast<double>(ours.hits) - static_cast<double>(theirs.hits));
  if (hit_difference > 1e-4 * static_cast<double>(rays.size())) throw Error("the hits differ");
}

void bench_hooks(const std::string& name, const SceneBvh& bvh, const std::vector<Ray>& rays) {
  SceneBvh one;
  one.blases = {bvh.blases[0]};
  one.instances.resize(1);
  const Box box = box_of(bvh.blases[0]->tree.nodes[0]);
  one.tlas = build({{&box, 1}}, {}, nullptr, {});
  Sum with, without;
  const Pair times = take_turns(
      cpu_seconds,
      [&] {
        with = {};
        NoProbe probe;
        for (const Ray& ray : rays)
          with.add(intersect(one, ray, probe));
      },
      [&] {
        without = {};
        for (const Ray& ray : rays)
          without.add(intersect_without_hooks(one, ray));
      });
  fmt::print("{:28} one instance, NoProbe against no hooks   ratio {:.3f}\n", name,
             times.b / times.a);
  if (with.hits != without.hits || with.t != without.t) throw Error("the hits differ");
}

// Our builder beside the one of Embree that does the same.
struct BuildPeers {
  const char* builder;
  RTCBuildQuality quality;
  const char* peer;
};
constexpr BuildPeers build_peers[] = {
    {"binned", RTC_BUILD_QUALITY_MEDIUM, "medium"},
    {"lbvh", RTC_BUILD_QUALITY_LOW, "low"},
    {"sbvh", RTC_BUILD_QUALITY_HIGH, "high"},
};

void bench_build(const std::string& name, const Scene& scene, const SceneBvh& bvh,
                 const BuildPeers& peers) {
  // Embree splits triangles only where it need not be robust.
  const bool robust = peers.quality != RTC_BUILD_QUALITY_HIGH;
  test::EmbreeScene embree(scene, bvh.instances, 0, robust, peers.quality);
  BuildOptions options;
  options.builder = peers.builder;
  std::vector<std::shared_ptr<const Blas>> blases;
  const Pair times = take_turns(
      wall_seconds, [&] { blases = build_blases(scene, options, nullptr, {}); },
      [&] { embree.rebuild(); });
  uint64_t triangles = 0, size = 0;
  for (const auto& blas : blases) {
    triangles += blas->tree.references.size();
    size += bytes(*blas);
  }
  fmt::print(
      "{:28} {:6} all threads  {:7.1f} ms, Embree {:6} {:7.1f} ms   ratio {:.2f}   {:.1f} "
      "bytes/reference\n",
      name, peers.builder, 1e3 * times.a, peers.peer, 1e3 * times.b, times.b / times.a,
      static_cast<double>(size) / static_cast<double>(triangles));
}

// How soon the viewport answers: a coarse picture after an edit, and other colours of what is
// there.
void bench_answers(const std::string& name) {
  Settings settings;
  settings.source = parse_scene_source(name);
  settings.render.width = width;
  settings.render.height = height;
  settings.render.samples = 1;
  Pipeline pipeline;
  pipeline.run(settings, {}, nullptr);
  std::vector<double> coarse;
  for (int turn = 0; turn < turns; ++turn) {
    settings.look = pipeline.snapshot()->settings.look;
    settings.look->ambient += 0.01f;
    pipeline.run(settings, {}, nullptr);
    coarse.push_back(pipeline.snapshot()->first_picture_ms);
  }
  std::string_view slowest;
  double most = 0.0;
  for (const ViewRow& view : views()) {
    ViewOptions options;
    options.view = view.id;
    std::vector<double> times;
    for (int turn = 0; turn < turns; ++turn) {
      times.push_back(seconds_of(wall_seconds, [&] {
        Picture picture = colorize(*pipeline.snapshot(), options);
        draw_legend(picture, options);
      }));
    }
    if (median(times) <= most) continue;
    most = median(times);
    slowest = view.id;
  }
  fmt::print(
      "{:28} coarse picture after an edit {:.1f} ms; colouring the slowest view ({}) {:.1f} ms\n",
      name, median(coarse), slowest, 1e3 * most);
}

void bench(const std::string& name) {
  const Scene scene = load_scene(parse_scene_source(name), {});
  const SceneBvh bvh = place_instances(scene, build_blases(scene, {}, nullptr, {}), {}, 0.0f);
  test::EmbreeScene embree(scene, bvh.instances, 0);
  const std::vector<Ray> rays = primary_rays(scene.camera);
  const TreeStatistics statistics = blas_statistics(bvh);
  fmt::print("{:28} {} triangles, SAH {:.2f}, depth {}\n", name, statistics.primitives,
             statistics.sah, statistics.max_depth);
  bench_rays(name, bvh, embree, rays);
  bench_hooks(name, bvh, rays);
  for (const BuildPeers& peers : build_peers)
    bench_build(name, scene, bvh, peers);
  bench_answers(name);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> names(argv + 1, argv + argc);
  if (names.empty()) names = {"teapots", "terrain:triangles=1000000"};
  try {
    for (const std::string& name : names)
      bench(name);
  } catch (const std::exception& error) {
    fmt::print(stderr, "tests_bench: {}\n", error.what());
    return 1;
  }
  return 0;
}
