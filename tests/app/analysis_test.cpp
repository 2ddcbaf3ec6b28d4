// report, validate, trace and timeline.
#include <cstdlib>
#include <filesystem>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/commands/assertion.h"
#include "run_command.h"
#include "tests/tracer/temporary_folder.h"
#include "tracer/file_io.h"
#include "tracer/scene/load_image.h"

namespace app {
namespace {

using testing::HasSubstr;

const std::vector<std::string> small_report = {"report",        "needles", "--set",
                                               "triangles=500", "--size",  "32x32"};

TEST(Report, TextByDefaultAndJsonOnRequest) {
  const TemporaryFolder folder;
  const std::string file = folder.path / "a.json";
  const Result result = run(small_report + std::vector<std::string>{"--json", file});
  EXPECT_EQ(result.status, exit_fine) << result.error;
  EXPECT_THAT(result.out, HasSubstr("SAH"));
  const tracer::Json json = tracer::Json::parse(bytes_of(file));
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["scene"]["triangles"], 500);
  EXPECT_EQ(json["builds"][0]["references"], 500);
  EXPECT_EQ(json["builds"][0]["rays"]["primary"]["count"], 1024);
  EXPECT_GT(json["builds"][0]["rays"]["primary"]["mrays_per_s"], 0.0);
}

TEST(Report, JsonToTheOutputStreamIsNothingElse) {
  const Result result = run(small_report + std::vector<std::string>{"--json", "-"});
  EXPECT_TRUE(tracer::Json::accept(result.out));
}

TEST(Report, TracesWithTheChosenKernels) {
  const Result result =
      run(small_report + std::vector<std::string>{"--layout", "wide8", "--kernel", "shadow=single",
                                                  "--kernel", "primary=stream", "--json", "-"});
  const tracer::Json rays = tracer::Json::parse(result.out)["builds"][0]["rays"];
  EXPECT_EQ(rays["primary"]["kernel"], "stream");
  EXPECT_EQ(rays["primary"]["in_streams"], 1.0);
  EXPECT_EQ(rays["shadow"]["kernel"], "single");
  EXPECT_EQ(rays["reflection"]["kernel"], "automatic");
}

TEST(Report, SeveralBuilders) {
  const Result result =
      run(small_report + std::vector<std::string>{"-b", "binned", "-b", "binned", "--json", "-"});
  const tracer::Json json = tracer::Json::parse(result.out);
  ASSERT_EQ(json["builds"].size(), 2u);
  EXPECT_EQ(json["builds"][0]["sah"], json["builds"][1]["sah"]);
}

TEST(Report, HasTheMeasures) {
  const Result result = run(small_report + std::vector<std::string>{"--json", "-"});
  const tracer::Json build = tracer::Json::parse(result.out)["builds"][0];
  for (const char* field :
       {"epo", "epo_standard_error", "overlap", "empty_space", "epo_traversal_cost"}) {
    EXPECT_GT(build[field].get<double>(), 0.0) << field;
  }
  for (const char* field : {"tlas_epo", "tlas_overlap", "tlas_empty_space", "tlas_instance_overlap",
                            "tlas_wasted_entries"}) {
    EXPECT_GE(build[field].get<double>(), 0.0) << field;
  }
  EXPECT_LE(build["epo_standard_error"].get<double>(), 0.011 * build["epo"].get<double>());
  EXPECT_THAT(run(small_report).out, HasSubstr("EPO"));
  EXPECT_THAT(run(small_report).out, HasSubstr("watertight tests"));
  EXPECT_THAT(run(small_report + std::vector<std::string>{"--fast"}).out, HasSubstr("fast tests"));
}

TEST(Report, SaysWhetherInstancesAreRebraided) {
  for (const bool on : {false, true}) {
    std::vector<std::string> words = small_report + std::vector<std::string>{"--json", "-"};
    if (on) words.push_back("--rebraid");
    EXPECT_EQ(tracer::Json::parse(run(words).out)["builds"][0]["options"]["rebraid"], on);
  }
}

const std::vector<std::string> small_validation = {"validate",      "needles", "--set",
                                                   "triangles=500", "--rays",  "300"};

TEST(Validate, ASoundSceneIsFine) {
  const TemporaryFolder folder;
  const std::string file = folder.path / "a.json";
  const Result result = run(small_validation + std::vector<std::string>{"--json", file});
  EXPECT_EQ(result.status, exit_fine) << result.error;
  EXPECT_THAT(result.out, HasSubstr("300 rays against brute force, 0 differ; errors 0"));
  const tracer::Json json = tracer::Json::parse(bytes_of(file));
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["scene"]["triangles"], 500);
  EXPECT_EQ(json["findings"], tracer::Json::array());
  EXPECT_EQ(json["rays_checked"], 300);
  EXPECT_EQ(json["mismatches"], 0);
}

TEST(Validate, JsonToTheOutputStreamIsNothingElse) {
  EXPECT_TRUE(
      tracer::Json::accept(run(small_validation + std::vector<std::string>{"--json", "-"}).out));
}

// The middle of the showcase has rays of several classes.
const std::vector<std::string> small_trace = {"trace",   "showcase", "--size",
                                              "160x120", "--pixel",  "80,60"};

TEST(Trace, TextByDefaultAndJsonOnRequest) {
  const TemporaryFolder folder;
  const std::string file = folder.path / "a.json";
  const Result result = run(small_trace + std::vector<std::string>{"--json", file});
  EXPECT_EQ(result.status, exit_fine) << result.error;
  EXPECT_THAT(result.out, HasSubstr("pixel 80, 60 of 160 x 120"));
  EXPECT_THAT(result.out, HasSubstr("Steps of ray 0 (primary)"));
  const tracer::Json json = tracer::Json::parse(bytes_of(file));
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["settings"]["width"], 160);
  ASSERT_GT(json["rays"].size(), 1u);
  for (const tracer::Json& ray : json["rays"]) {
    uint32_t nodes = 0;
    for (const tracer::Json& step : ray["steps"])
      nodes += step["kind"] == "node" && step["result"] == "entered";
    EXPECT_EQ(ray["counters"]["nodes"], nodes);
  }
}

TEST(Trace, JsonToTheOutputStreamIsNothingElse) {
  EXPECT_TRUE(tracer::Json::accept(run(small_trace + std::vector<std::string>{"--json", "-"}).out));
}

TEST(Trace, TheSameForAnyNumberOfThreads) {
  const auto traced = [](const char* threads) {
    return run(small_trace + std::vector<std::string>{"--threads", threads, "--ray", "all"}).out;
  };
  const std::string one = traced("1");
  EXPECT_GT(one.size(), 1000u);
  EXPECT_EQ(one, traced("2"));
}

TEST(Trace, TheStepsOfNoRayOrAll) {
  const std::string none = run(small_trace + std::vector<std::string>{"--ray", "none"}).out;
  EXPECT_THAT(none, testing::Not(HasSubstr("Steps of")));
  const std::string all = run(small_trace + std::vector<std::string>{"--ray", "all"}).out;
  EXPECT_THAT(all, HasSubstr("Steps of ray 1 "));
}

TEST(Timeline, TableAndJson) {
  const TemporaryFolder folder;
  const std::string file = folder.path / "t.json";
  const std::vector<std::string> line = {
      "timeline", "needles:triangles=50", "--deform", "twist", "--size", "20x10", "--frames",
      "0:4:2"};
  const Result result = run(line + std::vector<std::string>{"--json", file});
  EXPECT_EQ(result.status, exit_fine) << result.error;
  EXPECT_THAT(result.out, HasSubstr("rebuild every 8"));
  EXPECT_THAT(result.out, HasSubstr("All frames together"));
  const auto json = nlohmann::json::parse(bytes_of(file));
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["timeline"]["curves"].size(), 3u);
  EXPECT_EQ(json["timeline"]["curves"][0]["frames"].size(), 3u);
  EXPECT_EQ(json["timeline"]["curves"][0]["frames"][1]["frame"], 2);
  const Result only = run(line + std::vector<std::string>{"--strategy", "growth", "--json", "-"});
  EXPECT_EQ(nlohmann::json::parse(only.out)["timeline"]["curves"][0]["strategy"], "growth");
}

TEST(Timeline, WhatCannotBeMeasuredIsWrongUsage) {
  EXPECT_EQ(run({"timeline", "needles"}).status, exit_usage);
  EXPECT_THAT(run({"timeline", "needles"}).error, HasSubstr("--deform twist"));
  for (const char* frames : {"5", "5:", "5:2", "a:b", "0:9:0", "0:9999999", "1:2:3:4", "-1:4"}) {
    EXPECT_EQ(run({"timeline", "needles", "--deform", "twist", "--frames", frames}).status,
              exit_usage)
        << frames;
  }
}

TEST(Report, AssertionsDecideTheExitStatus) {
  const auto status = [](const std::vector<std::string>& assertions) {
    std::vector<std::string> line = small_report;
    for (const std::string& text : assertions)
      line = line + std::vector<std::string>{"--assert", text};
    return run(line).status;
  };
  EXPECT_EQ(status({"sah<1e9"}), exit_fine);
  EXPECT_EQ(status({"sah < 1e9", "references==500", "rays.primary.count>=1"}), exit_fine);
  EXPECT_EQ(status({"sah<0.5"}), exit_assertion);
  EXPECT_EQ(status({"sah<1e9", "scene.triangles>500"}), exit_assertion);
  EXPECT_EQ(status({"sahara<1"}), exit_usage);
  EXPECT_THAT(run(small_report + std::vector<std::string>{"--assert", "references!=500"}).error,
              HasSubstr("binned: references is 500, not != 500"));
}

TEST(Assertion, Grammar) {
  EXPECT_EQ(parse_assertion(" rays.primary.nodes.mean >= -1.5e2 ").field,
            "rays.primary.nodes.mean");
  EXPECT_EQ(parse_assertion("sah<=40").comparison, "<=");
  EXPECT_EQ(parse_assertion("sah<=40").limit, 40.0);
  for (const char* wrong :
       {"", "sah", "<3", "sah<", "sah=3", "sah<3x", "sah<<3", "s/ah<3", "a b<3"}) {
    EXPECT_THROW(parse_assertion(wrong), UsageError) << wrong;
  }
}

}  // namespace
}  // namespace app
