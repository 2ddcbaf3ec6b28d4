// What `bvhscope bench` does not measure: that a probe which records nothing costs nothing, and how
// soon the viewport answers. Both sides take turns; ratios of medians are printed. Usage:
// tests_bench [SCENE ...]
#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "tracer/analyze/quality.h"
#include "tracer/analyze/ray_sets.h"
#include "tracer/analyze/take_turns.h"
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

// Median seconds of each.
struct Pair {
  double a, b;
};
Pair in_turns(const std::function<void()>& a, const std::function<void()>& b) {
  const std::function<void()> works[] = {a, b};
  const auto seconds = take_turns(works, {.turns = turns}, nullptr, nullptr);
  return {spread_of(seconds[0]).median, spread_of(seconds[1]).median};
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
  const TriangleRay test = triangle_ray(origin, direction, box);
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

void bench_hooks(const std::string& name, const SceneBvh& bvh, const std::vector<Ray>& rays) {
  SceneBvh one;
  one.blases = {bvh.blases[0]};
  one.instances.resize(1);
  const Box box = box_of(bvh.blases[0]->tree.nodes[0]);
  one.tlas = build({{&box, 1}}, {}, nullptr, {});
  Sum with, without;
  const Pair times = in_turns(
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
      times.push_back(seconds_of(2, [&] {  // by the clock
        Picture picture = colorize(*pipeline.snapshot(), options);
        draw_legend(picture, options);
      }));
    }
    const double median = spread_of(std::move(times)).median;
    if (median <= most) continue;
    most = median;
    slowest = view.id;
  }
  fmt::print(
      "{:28} coarse picture after an edit {:.1f} ms; colouring the slowest view ({}) {:.1f} ms\n",
      name, spread_of(coarse).median, slowest, 1e3 * most);
}

void bench(const std::string& name) {
  const Scene scene = load_scene(parse_scene_source(name), {});
  const SceneBvh bvh = place_instances(scene, build_blases(scene, {}, nullptr, {}), {}, 0.0f);
  RaySetOptions rays{scene.camera, width, height, {"primary"}};
  const std::vector<RaySet> sets = make_ray_sets(scene, bvh, scene.lights, rays, {});
  const TreeStatistics statistics = blas_statistics(bvh);
  fmt::print("{:28} {} triangles, SAH {:.2f}, depth {}\n", name, statistics.primitives,
             statistics.sah, statistics.max_depth);
  bench_hooks(name, bvh, sets.front().rays);
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
