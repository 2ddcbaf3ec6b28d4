// Build times and rays a second, beside a peer that is made up for the tests.
#include "tracer/analyze/benchmark.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gmock/gmock.h>

#include "tests/tracer/make_scene.h"
#include "tracer/analyze/benchmark_report.h"
#include "tracer/bvh/flatten.h"
#include "tracer/bvh/ray_kernels.h"
#include "tracer/bvh/traverse.h"
#include "tracer/error.h"

namespace tracer::test {
namespace {

using testing::HasSubstr;

Scene small_scene() {
  Scene scene = scene_of({sphere(6), grid(3)});
  scene.camera.eye = {0.5f, 1, 4};
  scene.lights = {{.position = {1, 0.4f, 0.8f}}};  // seen from everywhere
  scene.instances.push_back(scene.instances[0]);
  scene.instances[2].transform[3] = vec4(2, 0.5f, 0, 1);
  return scene;
}

BenchmarkOptions few_rays() {
  BenchmarkOptions options;
  options.width = 24;
  options.height = 16;
  options.turns = 2;
  return options;
}

Benchmark measured(const Scene& scene, const BenchmarkOptions& options,
                   std::span<const PeerRow> peers = {}) {
  return run_benchmark({scene, look_of(scene)}, options, peers, {});
}

// A peer that traces as we do; `off` is added to each distance of its wide kernel.
constexpr PeerKernelRow kernels[] = {{"one", "One", "", 1},
                                     {"wide", "Wide", "", 16},
                                     {"hint", "Hint", "", 16, true},
                                     {"never", "Never", "", 4}};
constexpr PeerQualityRow qualities[] = {{"good", "binned"}};

template <int off, bool off_if_robust = true>
PeerScene build_peer(const Scene& scene, std::span<const PlacedInstance>, std::string_view,
                     bool robust) {
  const auto bvh = std::make_shared<const SceneBvh>(bvh_of(scene));
  PeerScene peer;
  peer.rebuild = [] {};
  peer.bytes = 1000;
  peer.tracer = [bvh, robust](std::string_view kernel, const RaySet& set) -> PeerTracer {
    if (kernel == "never") return {};
    const auto found = std::make_shared<std::vector<float>>(set.rays.size());
    const float wrong = kernel == "wide" && (off_if_robust || !robust) ? 0.01f * off : 0.0f;
    return {[=, &set](size_t first, size_t last) {
              NoProbe probe;
              for (size_t i = first; i < last; ++i) {
                const Hit hit = intersect(*bvh, set.rays[i], probe);
                (*found)[i] = !is_hit(hit) ? infinity : set.any_hit ? 0.0f : hit.t * (1.0f + wrong);
              }
            },
            [found](size_t ray) { return (*found)[ray]; }};
  };
  return peer;
}

const PeerRow honest[] = {{"peer", "Peer", "1.2", kernels, qualities, "other", build_peer<0>}};
const PeerRow lying[] = {{"peer", "Peer", "1.2", kernels, qualities, "other", build_peer<1>}};

const PeerRow fast_lying[] = {
    {"peer", "Peer", "1.2", kernels, qualities, "other", build_peer<1, false>}};

TEST(Benchmark, MeasuresEveryLayoutKernelClassAndThreadCount) {
  BenchmarkOptions options = few_rays();
  options.threads = {1, 2};
  options.builds.resize(2);
  options.builds[1].builder = "lbvh";
  const Benchmark result = measured(small_scene(), options);
  EXPECT_TRUE(result.complete);
  EXPECT_TRUE(result.faults.empty());
  EXPECT_EQ(result.builds.size(), 2 * 2 * layouts().size());
  size_t ways = 0;
  for (const LayoutRow& layout : layouts())
    ways += chosen_kernels(options, layout.id).size();
  EXPECT_EQ(result.rays.size(), 2 * 2 * ways * 9);  // four classes from two views, and random ones
  std::set<std::string> layouts_seen, builders_seen;
  for (const RayTiming& row : result.rays) {
    layouts_seen.insert(row.layout);
    builders_seen.insert(row.builder);
    EXPECT_GT(row.mrays_per_s.median, 0.0);
    EXPECT_LE(row.mrays_per_s.low, row.mrays_per_s.high);
    EXPECT_EQ(row.turns, 2);
    EXPECT_TRUE(row.hits > 0 || row.any_hit) << row.ray_class;  // the light is seen from everywhere
    EXPECT_EQ(row.differ, 0u);
    EXPECT_TRUE(row.ratios.empty());
    EXPECT_EQ(row.sum_t > 0.0, !row.any_hit);
  }
  EXPECT_EQ(layouts_seen.size(), layouts().size());
  EXPECT_EQ(builders_seen.size(), 2u);
}

TEST(Benchmark, SumsWhatTheRaysHit) {
  const Scene scene = small_scene();
  BenchmarkOptions options = few_rays();
  options.classes = {"primary"};
  const Benchmark result = measured(scene, options);
  const SceneBvh bvh = bvh_of(scene);
  const auto sets = make_ray_sets(scene, bvh, {}, {scene.camera, 24, 16, {"primary"}}, {});
  uint64_t hits = 0;
  double sum = 0.0;
  for (const Ray& ray : sets[0].rays) {
    const Hit hit = brute_force(scene, bvh, ray);
    hits += is_hit(hit);
    sum += is_hit(hit) ? double(hit.t) : 0.0;
  }
  EXPECT_EQ(result.rays[0].view, "camera");
  EXPECT_EQ(result.rays[0].hits, hits);
  EXPECT_EQ(result.rays[0].sum_t, sum);
  EXPECT_EQ(result.rays[0].rays, 24u * 16u);
}

TEST(Benchmark, MeasuresOnlyWhatIsChosen) {
  BenchmarkOptions options = few_rays();
  options.layouts = {"wide8"};
  options.kernels = {"single"};
  options.classes = {"random"};
  options.isa = std::string(isas().back().id);
  const Benchmark result = measured(small_scene(), options);
  ASSERT_EQ(result.rays.size(), 1u);
  EXPECT_EQ(result.rays[0].layout, "wide8");
  EXPECT_EQ(result.rays[0].kernel, "single");
  EXPECT_EQ(result.rays[0].isa, isas().back().id);
  EXPECT_EQ(result.rays[0].ray_class, "random");
  EXPECT_EQ(result.rays[0].view, "");
  options.rays = false;
  EXPECT_TRUE(measured(small_scene(), options).rays.empty());
}

TEST(Benchmark, BytesATriangleAreThoseOfTheLayout) {
  BenchmarkOptions options = few_rays();
  options.rays = false;
  options.layouts = {"wide8"};
  const Scene scene = scene_of({sphere(12)});
  const Benchmark result = measured(scene, options);
  BuildOptions build;
  build.layout = "wide8";
  const auto blas = build_blas(scene.meshes[0], build, nullptr, {});
  ASSERT_EQ(result.builds.size(), 1u);
  EXPECT_DOUBLE_EQ(result.builds[0].bytes_per_triangle,
                   double(bytes(blas->wide)) / double(scene.meshes[0].triangles.size()));
  EXPECT_GT(result.builds[0].sah, 0.0);
  EXPECT_GT(result.builds[0].mtris_per_s, 0.0);
}

TEST(Benchmark, TracesOwnRays) {
  BenchmarkOptions options = few_rays();
  options.own_rays = {{{0.5f, 3, 0.5f}, 0, {0, -2, 0}, infinity},
                      {{9, 9, 9}, 0, {0, 1, 0}, infinity}};
  options.only_own_rays = true;
  const Benchmark result = measured(scene_of({grid(2)}), options);
  for (const RayTiming& row : result.rays) {
    EXPECT_EQ(row.ray_class, "file");
    EXPECT_EQ(row.rays, 2u);
    EXPECT_EQ(row.hits, 1u);
    EXPECT_EQ(row.sum_t, 1.5);
  }
  EXPECT_FALSE(result.rays.empty());
}

TEST(Benchmark, PutsPeersBeside) {
  BenchmarkOptions options = few_rays();
  options.layouts = {"binary", "wide8"};
  options.classes = {"primary", "diffuse"};
  const Benchmark result = measured(small_scene(), options, honest);
  EXPECT_TRUE(result.faults.empty());
  size_t hints = 0;
  for (const RayTiming& row : result.rays) {
    EXPECT_NE(row.kernel, "never");
    if (!row.who.empty()) {
      EXPECT_EQ(row.layout, "good");
      EXPECT_TRUE(row.ratios.empty());
      hints += row.kernel == "hint";
      continue;
    }
    ASSERT_EQ(row.ratios.size(), 2u);
    EXPECT_EQ(row.ratios[0].width, 1);
    EXPECT_EQ(row.ratios[1].width, 16);
    EXPECT_GT(row.ratios[1].value, 0.0);
  }
  EXPECT_EQ(hints, 2u) << "only for coherent rays, from two views";
  const RayTiming& ours = result.rays[0];
  double fastest = 0.0;
  for (const RayTiming& row : result.rays) {
    if (row.width == 16 && row.ray_class == "primary" && row.view == ours.view)
      fastest = std::max(fastest, row.mrays_per_s.median);
  }
  EXPECT_DOUBLE_EQ(ours.ratios[1].value, ours.mrays_per_s.median / fastest);
}

TEST(Benchmark, PeersBuildWhatCorresponds) {
  BenchmarkOptions options = few_rays();
  options.rays = false;
  options.layouts = {"binary"};
  options.builds.resize(2);
  options.builds[1].builder = "median";
  const Benchmark result = measured(small_scene(), options, honest);
  ASSERT_EQ(result.builds.size(), 3u);
  EXPECT_EQ(result.builds[1].who, "peer");
  EXPECT_EQ(result.builds[1].layout, "good");
  EXPECT_GT(result.builds[1].bytes_per_triangle, 0.0);
  EXPECT_EQ(result.builds[2].builder, "median");
  EXPECT_EQ(result.builds[2].ratio, 0.0);
}

TEST(Benchmark, APeerThatAnswersOtherwiseIsAFault) {
  BenchmarkOptions options = few_rays();
  options.layouts = {"binary"};
  options.classes = {"primary"};
  const Benchmark result = measured(small_scene(), options, lying);
  ASSERT_EQ(result.faults.size(), 2u);  // of both views
  EXPECT_THAT(result.faults[0], HasSubstr("peer good wide answers"));
  EXPECT_THAT(result.faults[0], HasSubstr("than binned binary single"));
  for (const RayTiming& row : result.rays)
    EXPECT_EQ(row.agrees, row.kernel != "wide") << row.kernel;
}

TEST(Benchmark, FastTestsAreMeasuredBesideTheOthersIfAskedFor) {
  BenchmarkOptions options = few_rays();
  options.layouts = {"binary", "wide8"};
  options.classes = {"primary", "shadow"};
  for (const RayTiming& row : measured(small_scene(), options, honest).rays)
    EXPECT_TRUE(row.robust);
  options.fast = true;
  const Benchmark result = measured(small_scene(), options, honest);
  EXPECT_TRUE(result.faults.empty());
  std::map<std::string, int> kinds;  // fast ones less robust ones
  std::map<bool, double> fastest;    // of the peer's packets in the first group
  for (const RayTiming& row : result.rays) {
    kinds[row.who + row.layout + row.kernel] += row.robust ? -1 : 1;
    EXPECT_EQ(kernel_text(row), row.kernel + (row.robust ? "" : ", fast"));
    const bool is_first = row.ray_class == result.rays[0].ray_class &&
                          row.view == result.rays[0].view && row.width == 16;
    if (is_first) fastest[row.robust] = std::max(fastest[row.robust], row.mrays_per_s.median);
  }
  for (const auto& [way, difference] : kinds)
    EXPECT_EQ(difference, 0) << way;
  for (const bool robust : {true, false}) {
    const RayTiming& row = result.rays[robust ? 0 : 1];
    EXPECT_EQ(row.robust, robust);
    EXPECT_DOUBLE_EQ(row.ratios[1].value, row.mrays_per_s.median / fastest[robust]);
  }
}

TEST(Benchmark, FastTestsThatAnswerOtherwiseAreAFault) {
  BenchmarkOptions options = few_rays();
  options.layouts = {"binary"};
  options.classes = {"primary"};
  EXPECT_TRUE(measured(small_scene(), options, fast_lying).faults.empty());
  options.fast = true;
  const Benchmark result = measured(small_scene(), options, fast_lying);
  ASSERT_EQ(result.faults.size(), 2u);  // of both views
  EXPECT_THAT(result.faults[0], HasSubstr("peer good wide, fast answers"));
}

TEST(Benchmark, StopsAndKeepsWhatThereIs) {
  std::stop_source stop;
  const Scene scene = small_scene();
  size_t published = 0;
  const Benchmark result = run_benchmark({scene, look_of(scene)}, few_rays(), {},
                                         {stop.get_token(), nullptr}, [&](const Benchmark& part) {
                                           published = part.rays.size();
                                           if (!part.rays.empty()) stop.request_stop();
                                         });
  EXPECT_FALSE(result.complete);
  EXPECT_GT(published, 0u);
  EXPECT_EQ(result.rays.size(), published);
}

TEST(Benchmark, RefusesBadBuildOptions) {
  BenchmarkOptions options = few_rays();
  options.builds[0].builder = "nobody";
  EXPECT_THROW(measured(small_scene(), options), Error);
}

TEST(BenchmarkReport, JsonHasTheFieldsOfEachRow) {
  const Scene scene = small_scene();
  BenchmarkOptions options = few_rays();
  options.layouts = {"binary", "wide4"};
  options.kernels = {"single"};
  options.classes = {"shadow"};
  const Benchmark result = measured(scene, options, honest);
  const Json json = benchmark_json({scene, options, honest, ""}, result);
  EXPECT_EQ(json.at("schema"), 1);
  EXPECT_EQ(json.at("scene").at("instances"), 3);
  EXPECT_EQ(json.at("builds").size(), 2u);
  for (const char* field : {"builder", "threads", "ms", "mtris_per_s", "sah", "bytes_per_triangle"})
    EXPECT_TRUE(json.at("builds").at(0).contains(field)) << field;
  EXPECT_EQ(json.at("peer_builds").size(), 1u);
  ASSERT_EQ(json.at("rays").size(), 4u);
  const Json& row = json.at("rays").at(0);
  EXPECT_EQ(row.at("kernel"), "single");
  EXPECT_EQ(row.at("class"), "shadow");
  EXPECT_TRUE(row.at("isa").is_null());
  EXPECT_TRUE(row.at("sum_t").is_null());
  EXPECT_EQ(row.at("mrays_per_s"), result.rays[0].mrays_per_s.median);
  const Json& peer = json.at("peers").at(0);
  EXPECT_EQ(peer.at("name"), "peer");
  EXPECT_EQ(peer.at("version"), "1.2");
  EXPECT_EQ(peer.at("robust"), true);
  EXPECT_EQ(peer.at("hits"), row.at("hits"));
}

TEST(BenchmarkReport, SaysWhichTestsWereFast) {
  const Scene scene = small_scene();
  BenchmarkOptions options = few_rays();
  options.layouts = {"wide4"};
  options.kernels = {"single"};
  options.classes = {"primary"};
  options.fast = true;
  const Benchmark result = measured(scene, options, honest);
  const BenchmarkFacts facts{scene, options, honest, ""};
  const Json json = benchmark_json(facts, result);
  EXPECT_EQ(json.at("settings").at("fast"), true);
  EXPECT_EQ(json.at("rays").at(0).at("robust"), true);
  EXPECT_EQ(json.at("rays").at(1).at("robust"), false);
  size_t fast_peers = 0;
  for (const Json& peer : json.at("peers"))
    fast_peers += peer.at("robust") == false;
  EXPECT_EQ(2 * fast_peers, json.at("peers").size());
  EXPECT_THAT(benchmark_text(facts, result), HasSubstr("single, fast "));
  EXPECT_THAT(benchmark_text(facts, result), HasSubstr("robust unless fast"));
}

TEST(BenchmarkReport, EveryCsvLineHasAsManyFields) {
  const Scene scene = small_scene();
  BenchmarkOptions options = few_rays();
  options.classes = {"primary", "shadow"};
  const Benchmark result = measured(scene, options, honest);
  const std::string csv = benchmark_csv(result);
  size_t lines = 0;
  std::set<size_t> fields;
  for (size_t at = 0; at < csv.size(); ++lines) {
    const size_t end = csv.find('\n', at);
    fields.insert(size_t(std::count(&csv[at], &csv[end], ',')));
    at = end + 1;
  }
  EXPECT_EQ(fields.size(), 1u);
  EXPECT_EQ(lines, 1 + result.builds.size() + result.rays.size());
}

TEST(BenchmarkReport, TextNamesWhatDiffersAndWhatIsMissing) {
  const Scene scene = small_scene();
  BenchmarkOptions options = few_rays();
  options.layouts = {"binary"};
  options.classes = {"primary"};
  const Benchmark result = measured(scene, options, lying);
  const std::string text = benchmark_text({scene, options, lying, "No such peer."}, result);
  EXPECT_THAT(text, HasSubstr("DIFFERENT: primary, camera"));
  EXPECT_THAT(text, HasSubstr("TOO MANY"));
  EXPECT_THAT(text, HasSubstr("No such peer."));
  EXPECT_THAT(text, HasSubstr("/16"));
  EXPECT_THAT(benchmark_text({scene, options, {}, ""}, {}), HasSubstr("Stopped"));
}

TEST(Flattened, HitsWhatTheInstancesHit) {
  Scene scene = small_scene();
  scene.materials.resize(3);
  scene.instances[2].material = 2;
  const SceneBvh bvh = bvh_of(scene);
  const Scene flat = flattened(scene, bvh.instances);
  ASSERT_EQ(flat.meshes.size(), 1u);
  ASSERT_EQ(flat.instances.size(), 1u);
  const size_t ball = scene.meshes[0].triangles.size(), floor = scene.meshes[1].triangles.size();
  EXPECT_EQ(flat.meshes[0].triangles.size(), 2 * ball + floor);
  EXPECT_EQ(flat.meshes[0].materials[0], 0u);
  EXPECT_EQ(flat.meshes[0].materials[ball + floor], 2u) << "the instance's own";
  const SceneBvh one = bvh_of(flat);
  NoProbe probe;
  size_t hits = 0;
  for (const RaySet& set : make_ray_sets(scene, bvh, {}, {scene.camera, 64, 48, {"primary"}}, {})) {
    for (const Ray& ray : set.rays) {
      const Hit a = intersect(bvh, ray, probe), b = intersect(one, ray, probe);
      if (!is_hit(a) || !is_hit(b)) continue;  // silhouettes may be rounded otherwise
      ++hits;
      EXPECT_NEAR(a.t, b.t, 1e-4f * a.t);
      const size_t first = a.instance == 0 ? 0 : a.instance == 1 ? ball : ball + floor;
      if (a.t == b.t) {
        EXPECT_EQ(b.triangle, first + a.triangle);
      }
    }
  }
  EXPECT_GT(hits, 1000u);
}

}  // namespace
}  // namespace tracer::test
