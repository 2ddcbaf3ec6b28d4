// bvhscope bench, and Embree beside it.
#include <cstring>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "app/peers/peers.h"
#include "run_command.h"
#include "tests/tracer/temporary_folder.h"
#include "tracer/analyze/benchmark.h"
#include "tracer/bvh/traverse.h"

namespace app {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// A scene that is built in no time, few rays, one turn.
std::vector<std::string> small_bench() {
  return {"bench", "needles", "--set", "triangles=200", "--size", "40x32", "--turns", "1"};
}

json json_of(const std::vector<std::string>& more) {
  const Result result = run(small_bench() + more + std::vector<std::string>{"--json", "-"});
  EXPECT_EQ(result.status, exit_fine) << result.error;
  return json::parse(result.out, nullptr, false);
}

TEST(Bench, PrintsTables) {
  const Result result = run(small_bench() + std::vector<std::string>{"--threads", "1"});
  EXPECT_EQ(result.status, exit_fine) << result.error;
  EXPECT_THAT(result.out, HasSubstr("build, ms"));
  EXPECT_THAT(result.out, HasSubstr("binned, primary rays, camera view, 1 thread: 1280 rays"));
  EXPECT_THAT(result.out, HasSubstr("quantised8"));
  EXPECT_THAT(result.out, HasSubstr(missing_peers()));
  EXPECT_EQ(result.error, "");
}

TEST(Bench, JsonHasBuildsRaysAndPeers) {
  const json all = json_of({"-b", "lbvh", "-b", "median", "--class", "primary", "--class", "shadow",
                            "--layout", "wide8", "--threads", "2"});
  EXPECT_EQ(all["schema"], 1);
  ASSERT_EQ(all["builds"].size(), 2u);
  EXPECT_EQ(all["builds"][0]["builder"], "lbvh");
  EXPECT_EQ(all["builds"][1]["builder"], "median");
  for (const json& row : all["rays"]) {
    EXPECT_EQ(row["layout"], "wide8");
    EXPECT_EQ(row["threads"], 2);
    EXPECT_TRUE(row["class"] == "primary" || row["class"] == "shadow");
    EXPECT_TRUE(row["agrees"]);
    EXPECT_GT(row["mrays_per_s"], 0.0);
  }
  EXPECT_EQ(all["rays"].size() % 8, 0u);  // two builders, classes and views
  EXPECT_EQ(all["peers"].empty(), peers().empty());
  EXPECT_EQ(all["peer_builds"].empty(), peers().empty());
}

TEST(Bench, FastMeasuresBothKindsOfTests) {
  const json all = json_of({"--fast", "--class", "primary", "--layout", "wide8", "--threads", "1"});
  EXPECT_EQ(all["settings"]["fast"], true);
  for (const char* rows : {"rays", "peers"}) {
    size_t fast = 0;
    for (const json& row : all[rows])
      fast += row["robust"] == false ? 1 : 0;
    EXPECT_EQ(2 * fast, all[rows].size()) << rows;
  }
}

TEST(Bench, WritesCsv) {
  const Result result =
      run(small_bench() + std::vector<std::string>{"--class", "random", "--threads", "1", "--csv",
                                                   "-", "--layout", "binary", "--no-peers"});
  EXPECT_EQ(result.status, exit_fine) << result.error;
  EXPECT_THAT(result.out, testing::StartsWith("what,who,builder,"));
  EXPECT_THAT(result.out, HasSubstr("\nbuild,bvhscope,binned,binary,,,,,1,"));
  EXPECT_THAT(result.out, HasSubstr("\nrays,bvhscope,binned,binary,single,,random,,1,"));
  EXPECT_THAT(result.out, testing::Not(HasSubstr("embree")));
}

TEST(Bench, TracesTheRaysOfAFile) {
  const TemporaryFolder folder;
  const float rays[] = {0, 50, 0, 0,    0, -1, 0, 1e9f, 0, 50, 0, 0,
                        0, 1,  0, 1e9f, 0, 50, 0, 0,    0, 0,  0, 1e9f};
  std::string bytes(sizeof(rays), '\0');
  std::memcpy(bytes.data(), rays, sizeof(rays));
  const auto file = folder.file("some.rays", bytes);
  const Result result =
      run(small_bench() + std::vector<std::string>{"--rays", file.string(), "--json", "-"});
  EXPECT_EQ(result.status, exit_fine) << result.error;
  EXPECT_THAT(result.error, HasSubstr("1 rays were left out"));
  const json all = json::parse(result.out, nullptr, false);
  ASSERT_FALSE(all["rays"].empty());
  for (const json& row : all["rays"]) {
    EXPECT_EQ(row["class"], "file");
    EXPECT_EQ(row["rays"], 2);
    EXPECT_LE(row["hits"], 1);
  }
}

TEST(Bench, FlattenMakesOneMesh) {
  const std::vector<std::string> base = {"bench",     "teapots", "--size", "16x16",    "--turns",
                                         "1",         "--class", "random", "--layout", "wide8",
                                         "--threads", "1",       "--json", "-"};
  const Result instanced = run(base), flat = run(base + std::vector<std::string>{"--flatten"});
  ASSERT_EQ(instanced.status, exit_fine) << instanced.error;
  ASSERT_EQ(flat.status, exit_fine) << flat.error;
  const json a = json::parse(instanced.out), b = json::parse(flat.out);
  EXPECT_GT(a["scene"]["instances"], 1);
  EXPECT_EQ(b["scene"]["instances"], 1);
  EXPECT_EQ(b["scene"]["triangles"], a["scene"]["instanced_triangles"]);
  EXPECT_NEAR(a["rays"][0]["hits"].get<double>(), b["rays"][0]["hits"].get<double>(), 2.0);
}

TEST(Bench, OptionsChangeWhatIsMeasured) {
  const json quick = json_of({"--quick", "--threads", "1", "--class", "random"});
  EXPECT_EQ(quick["settings"]["width"], 40) << "--size wins";
  EXPECT_EQ(quick["settings"]["turns"], 1) << "so does --turns";
  const Result plain = run({"bench", "needles", "--set", "triangles=50", "--quick", "--threads",
                            "1", "--builds-only", "--json", "-"});
  const json builds = json::parse(plain.out, nullptr, false);
  EXPECT_EQ(builds["settings"]["width"], 640);
  EXPECT_EQ(builds["settings"]["turns"], 3);
  EXPECT_TRUE(builds["rays"].empty());
  EXPECT_FALSE(builds["builds"].empty());
}

TEST(Bench, SaysWhatIsWrong) {
  const auto fails = [](const std::vector<std::string>& more, int status, const char* what) {
    const Result result = run(small_bench() + more);
    EXPECT_EQ(result.status, status) << what;
    EXPECT_THAT(result.error, HasSubstr(what));
    EXPECT_EQ(result.out, "");
  };
  fails({"--rays", "no-such.rays"}, exit_failed, "no-such.rays");
  fails({"--isa", "mmx"}, exit_usage, "mmx");
  fails({"--kernel", "none"}, exit_usage, "unknown kernel 'none'");
  fails({"--class", "x"}, exit_usage, "unknown class of rays 'x'");
  fails({"--layout", "x"}, exit_usage, "unknown layout 'x'");
  fails({"--turns", "0"}, exit_usage, "--turns");
  fails({"--json", "-", "--csv", "-"}, exit_usage, "only one of them");
}

TEST(Bench, ListsWhatCanBeChosen) {
  EXPECT_THAT(run({"list", "kernels"}).out, HasSubstr("single"));
  EXPECT_FALSE(run({"list", "isas"}).out.empty());
  EXPECT_THAT(run({"list", "bench-classes"}).out, HasSubstr("diffuse"));
}

// With what was found: every kernel of every peer answers as we do, with and without instances.
TEST(Peers, AnswerAsWeDo) {
  for (const bool instanced : {false, true}) {
    tracer::Scene scene =
        tracer::load_scene(tracer::parse_scene_source("needles:triangles=500"), {});
    if (instanced) {
      scene.instances.push_back(scene.instances[0]);
      scene.instances.back().transform[3][0] += 3.0f;
    }
    tracer::BenchmarkOptions options;
    options.layouts = {"binary"};
    options.width = 61;  // not a multiple of a packet
    options.height = 37;
    options.turns = 1;
    const tracer::Benchmark result = run_benchmark({scene, look_of(scene)}, options, peers(), {});
    EXPECT_TRUE(result.complete);
    EXPECT_THAT(result.faults, testing::IsEmpty());
    for (const tracer::PeerRow& peer : peers()) {
      for (const tracer::PeerKernelRow& kernel : peer.kernels) {
        const auto used = [&](const tracer::RayTiming& row) {
          return row.who == peer.id && row.kernel == kernel.id && row.hits > 0;
        };
        const bool is_there = std::any_of(result.rays.begin(), result.rays.end(), used);
        EXPECT_EQ(is_there, !(instanced && kernel.coherent_only)) << kernel.id;
      }
    }
  }
}

}  // namespace
}  // namespace app
