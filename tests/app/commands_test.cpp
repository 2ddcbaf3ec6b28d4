#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "app/commands/assertion.h"
#include "app/commands/command.h"
#include "app/commands/command_line.h"
#include "app/commands/scene_options.h"
#include "tests/tracer/temporary_folder.h"
#include "tracer/file_io.h"
#include "tracer/scene/load_image.h"

namespace app {
namespace {

using testing::HasSubstr;

struct Result {
  int status;
  std::string out, error;
};

Result run(const std::vector<std::string>& arguments) {
  std::ostringstream out;
  std::ostringstream error;
  const int status = run_command(arguments, out, error);
  return {status, out.str(), error.str()};
}

TEST(CommandLine, VersionAndHelp) {
  EXPECT_EQ(run({"--version"}).status, exit_fine);
  EXPECT_THAT(run({"--version"}).out, testing::MatchesRegex("bvhscope [0-9.]+\n"));
  EXPECT_THAT(run({"--help"}).out, HasSubstr("list"));
  EXPECT_THAT(run({"list", "--help"}).out, HasSubstr("colormaps"));
}

TEST(List, HasTheTables) {
  EXPECT_THAT(run({"list", "scenes"}).out, HasSubstr("teapots"));
  EXPECT_THAT(run({"list", "builders"}).out, HasSubstr("binned"));
  EXPECT_THAT(run({"list", "layouts"}).out, HasSubstr("binary"));
  EXPECT_THAT(run({"list", "views"}).out, HasSubstr("wireframe"));
  EXPECT_THAT(run({"list", "counters"}).out, HasSubstr("nodes"));
  EXPECT_THAT(run({"list", "ray-classes"}).out, HasSubstr("refraction"));
  EXPECT_THAT(run({"list", "colormaps"}).out, HasSubstr("turbo"));
  EXPECT_THAT(run({"list", "tone-maps"}).out, HasSubstr("aces"));
  EXPECT_THAT(run({"list", "box-sets"}).out, HasSubstr("ancestors"));
  EXPECT_THAT(run({"list", "node-measures"}).out, HasSubstr("observed"));
  EXPECT_THAT(run({"list", "deformers"}).out, HasSubstr("turns from end to end"));
  EXPECT_THAT(run({"list", "motions"}).out, HasSubstr("bounce"));
  EXPECT_THAT(run({"list", "updates"}).out, HasSubstr("growth"));
}

TEST(List, UnknownTableIsWrongUsageAndNamesTheKnownOnes) {
  const Result result = run({"list", "planets"});
  EXPECT_EQ(result.status, exit_usage);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.error, HasSubstr("unknown list 'planets'; known: scenes, builders"));
}

// A picture of a few pixels of a scene that is made in no time.
std::vector<std::string> small_render(const std::string& file) {
  return {"render", "needles",   "--set", "triangles=50", "--size", "40x30", "--spp",
          "1",      "--threads", "2",     "-o",           file};
}

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::string bytes_of(const std::filesystem::path& file) {
  return tracer::read_file(file, 1 << 24);
}

TEST(Render, WritesAPngOfTheAskedSize) {
  const TemporaryFolder folder;
  const std::string file = folder.path / "a.png";
  const Result result = run(small_render(file));
  EXPECT_EQ(result.status, exit_fine) << result.error;
  EXPECT_EQ(result.out + result.error, "");
  const tracer::Texture picture = tracer::load_texture(file);
  EXPECT_EQ(picture.width, 40u);
  EXPECT_EQ(picture.height, 30u);
}

TEST(Render, EveryViewAndCounterCanBeWritten) {
  const TemporaryFolder folder;
  const std::string file = folder.path / "a.png";
  for (const std::string id :
       {"albedo", "uv", "uv_checker", "normal", "shading_normal", "facing", "depth", "barycentric",
        "triangle", "instance", "material", "wireframe", "counter", "cost", "ray_depth"}) {
    EXPECT_EQ(run(small_render(file) + std::vector<std::string>{"--view", id}).status, exit_fine)
        << id;
  }
}

TEST(Render, DrawsBoxes) {
  const TemporaryFolder folder;
  const std::string file = folder.path / "a.png";
  using Words = std::vector<std::string>;
  ASSERT_EQ(run(small_render(file)).status, exit_fine);
  const std::string without = bytes_of(file);
  for (const Words& words :
       {Words{"--boxes", "1:3"}, Words{"--boxes", "2", "--box-fill", "--box-no-wire"},
        Words{"--boxes", "leaves", "--box-tree", "blas", "--box-color", "sah", "--box-log"},
        Words{"--boxes", "1:3", "--box-color", "observed", "--box-rays", "shadow"},
        Words{"--boxes", "children", "--box-node", "0:0"},
        Words{"--boxes", "node", "--box-node", "tlas:0", "--box-width", "2"}}) {
    const Result result = run(small_render(file) + words);
    EXPECT_EQ(result.status, exit_fine) << words[1] << result.error;
    EXPECT_NE(bytes_of(file), without) << words[1];
  }
  const Result none = run(small_render(file) + Words{"--boxes", "200"});
  EXPECT_EQ(none.status, exit_fine);
  EXPECT_THAT(none.error, HasSubstr("no such nodes"));
}

TEST(Render, SaysWhatIsWrongWithBoxes) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::vector<std::string>& words) {
    const Result result = run(small_render(folder.path / "a.png") + words);
    EXPECT_EQ(result.status, exit_usage) << words.back();
    return result.error;
  };
  EXPECT_THAT(error_of({"--boxes", "5:3"}), HasSubstr("3:5"));
  EXPECT_THAT(error_of({"--boxes", "twigs"}), HasSubstr("leaves"));
  EXPECT_THAT(error_of({"--boxes", "1:999"}), HasSubstr("255"));
  EXPECT_THAT(error_of({"--boxes", "children"}), HasSubstr("--box-node"));
  EXPECT_THAT(error_of({"--boxes", "node", "--box-node", "0"}), HasSubstr("MESH:NODE"));
  EXPECT_THAT(error_of({"--boxes", "1", "--box-no-wire"}), HasSubstr("--box-fill"));
  EXPECT_THAT(error_of({"--boxes", "1", "--box-color", "beauty"}), HasSubstr("sah"));
}

TEST(Render, MinusIsTheOutputStream) {
  const Result result = run(small_render("-"));
  EXPECT_EQ(result.status, exit_fine);
  EXPECT_EQ(result.out.substr(1, 3), "PNG");
}

TEST(Render, WritesLight) {
  const TemporaryFolder folder;
  EXPECT_EQ(run(small_render(folder.path / "a.exr")).status, exit_fine);
  EXPECT_EQ(bytes_of(folder.path / "a.exr").substr(0, 4), "\x76\x2f\x31\x01");
  EXPECT_EQ(run(small_render(folder.path / "a.HDR")).status, exit_fine);
  EXPECT_EQ(bytes_of(folder.path / "a.HDR").substr(0, 10), "#?RADIANCE");
}

TEST(Render, SameBytesForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  for (const char* ending : {".png", ".exr"}) {
    const std::string one = folder.path / (std::string("one") + ending);
    const std::string two = folder.path / (std::string("two") + ending);
    const std::vector<std::string> line = {"render", "showcase", "--size", "100x70", "--spp", "3"};
    ASSERT_EQ(run(line + std::vector<std::string>{"--threads", "1", "-o", one}).status, exit_fine);
    ASSERT_EQ(run(line + std::vector<std::string>{"--threads", "2", "-o", two}).status, exit_fine);
    EXPECT_EQ(bytes_of(one), bytes_of(two)) << ending;
  }
}

TEST(Render, OptionsChangeThePicture) {
  const TemporaryFolder folder;
  const std::string file = folder.path / "a.png";
  const std::vector<std::string> line = {"render", "showcase", "--size", "60x45", "-o", file};
  ASSERT_EQ(run(line).status, exit_fine);
  const std::string plain = bytes_of(file);
  const std::vector<std::vector<std::string>> changes = {
      {"--eye", "-3,4,5"},    {"--target", "1,0,0"},  {"--fov", "70"},      {"--orthographic"},
      {"--no-shadows"},       {"--depth", "0"},       {"--spp", "2"},       {"--exposure", "-1"},
      {"--tone-map", "none"}, {"--counter", "nodes"}, {"--rays", "shadow"}, {"--view", "depth"},
      {"--set", "detail=3"}};
  for (const std::vector<std::string>& change : changes) {
    EXPECT_EQ(run(line + change).status, exit_fine) << change[0];
    EXPECT_NE(bytes_of(file), plain) << change[0];
  }
}

TEST(Render, HeatMapOptionsChangeThePicture) {
  const TemporaryFolder folder;
  const std::string file = folder.path / "a.png";
  const std::vector<std::string> line = {"render",  "needles", "--set", "triangles=50", "--size",
                                         "500x300", "-o",      file,    "--view",       "cost"};
  ASSERT_EQ(run(line).status, exit_fine);
  const std::string plain = bytes_of(file);
  const std::vector<std::vector<std::string>> changes = {
      {"--colormap", "turbo"}, {"--range", "0:7.5"}, {"--log"},
      {"--no-legend"},         {"--leaf-size", "1"}, {"--bins", "2"},
      {"--tree-depth", "2"},   {"--ct", "9"},        {"--ci", "9"}};
  for (const std::vector<std::string>& change : changes) {
    EXPECT_EQ(run(line + change).status, exit_fine) << change[0];
    EXPECT_NE(bytes_of(file), plain) << change[0];
  }
}

TEST(Render, TimeMovesTheTeapots) {
  const TemporaryFolder folder;
  const std::string file = folder.path / "a.png";
  const std::vector<std::string> line = {"render", "teapots", "--set", "detail=2", "--size",
                                         "80x45",  "--spp",   "1",     "-o",       file};
  ASSERT_EQ(run(line).status, exit_fine);
  const std::string plain = bytes_of(file);
  ASSERT_EQ(run(line + std::vector<std::string>{"--time", "1.5"}).status, exit_fine);
  EXPECT_NE(bytes_of(file), plain);
}

TEST(Render, ADeformerAndAMotionChangeThePicture) {
  const TemporaryFolder folder;
  const std::string still = folder.path / "still.png";
  run(small_render(still));
  const std::vector<std::vector<std::string>> changes = {
      {"--deform", "twist", "--amount", "1", "--axis", "y", "--speed", "0"},
      {"--deform", "explode", "--time", "2"},
      {"--motion", "spin", "--time", "0.5"}};
  for (const std::vector<std::string>& change : changes) {
    const std::string file = folder.path / "moved.png";
    EXPECT_EQ(run(small_render(file) + change).status, exit_fine);
    EXPECT_NE(bytes_of(file), bytes_of(still)) << change[1];
  }
}

TEST(Render, NoAmountIsNoDeformer) {
  const TemporaryFolder folder;
  const std::string still = folder.path / "still.png";
  const std::string nothing = folder.path / "nothing.png";
  run(small_render(still));
  run(small_render(nothing) + std::vector<std::string>{"--deform", "twist", "--amount", "0"});
  EXPECT_EQ(bytes_of(nothing), bytes_of(still));
}

TEST(Render, ASessionBringsItsSettingsAndTheLineChangesThem) {
  const TemporaryFolder folder;
  tracer::SavedSession session;
  session.settings.source = tracer::parse_scene_source("needles:triangles=50");
  session.settings.render.width = 33;
  session.settings.render.height = 22;
  session.settings.render.samples = 1;
  session.view.view = "normal";
  tracer::write_session(folder.path / "a.bvhscope", session);
  const std::string file = folder.path / "a.png";
  ASSERT_EQ(run({"render", folder.path / "a.bvhscope", "-o", file}).status, exit_fine);
  const tracer::Texture saved = tracer::load_texture(file);
  EXPECT_EQ(saved.width, 33u);
  ASSERT_EQ(
      run({"render", folder.path / "a.bvhscope", "-o", file, "--size", "44x22", "--view", "depth"})
          .status,
      exit_fine);
  EXPECT_EQ(tracer::load_texture(file).width, 44u);
}

struct BadLine {
  std::vector<std::string> arguments;
  int status;
  std::string message;
};

TEST(BadInput, OneMessageThatSaysWhatToDo) {
  const TemporaryFolder folder;
  const std::string png = folder.path / "a.png";
  folder.file("empty.obj");
  const std::vector<BadLine> lines = {
      {{"render", "teapots"}, exit_usage, "--output is required"},
      {{"render", "-o", png}, exit_usage, "scene is required"},
      {{"render", "planet", "-o", png}, exit_failed, "planet: the file does not exist"},
      {{"render", "planet.obj", "-o", png}, exit_failed, "teapots"},
      {{"render", folder.path / "empty.obj", "-o", png}, exit_failed, "empty.obj"},
      {{"render", folder.path, "-o", png}, exit_failed, "is a folder"},
      {{"render", folder.path / "no.bvhscope", "-o", png}, exit_failed, "no.bvhscope"},
      {{"render", "teapots", "-o", png, "--view", "x"},
       exit_usage,
       "unknown view 'x'; known: shaded"},
      {{"render", "teapots", "-o", png, "-b", "x"},
       exit_usage,
       "unknown builder 'x'; known: binned"},
      {{"render", "teapots", "-o", png, "--layout", "x"}, exit_usage, "known: binary"},
      {{"render", "teapots", "-o", png, "--counter", "x"}, exit_usage, "known: nodes"},
      {{"render", "teapots", "-o", png, "--rays", "x"}, exit_usage, "known: all, primary"},
      {{"render", "teapots", "-o", png, "--colormap", "x"}, exit_usage, "known: viridis"},
      {{"render", "teapots", "-o", png, "--tone-map", "x"}, exit_usage, "known: none"},
      {{"render", "teapots", "-o", png, "--size", "0x10"}, exit_usage, "1 to 16384 pixels"},
      {{"render", "teapots", "-o", png, "--size", "100000x100000"},
       exit_usage,
       "1 to 16384 pixels"},
      {{"render", "teapots", "-o", png, "--size", "big"}, exit_usage, "write WxH"},
      {{"render", "teapots", "-o", png, "--spp", "0"}, exit_usage, "--spp"},
      {{"render", "teapots", "-o", png, "--depth", "33"}, exit_usage, "--depth"},
      {{"render", "teapots", "-o", png, "--threads", "0"}, exit_usage, "--threads"},
      {{"render", "teapots", "-o", png, "--eye", "1,2"}, exit_usage, "write X,Y,Z"},
      {{"render", "teapots", "-o", png, "--eye", "1,2,nan"}, exit_usage, "write X,Y,Z"},
      {{"render", "teapots", "-o", png, "--eye", "1,1,1", "--target", "1,1,1"},
       exit_usage,
       "same point"},
      {{"render", "teapots", "-o", png, "--fov", "180"}, exit_usage, "--fov"},
      {{"render", "teapots", "-o", png, "--fov", "nan"}, exit_usage, "number from 1 to 170"},
      {{"render", "teapots", "-o", png, "--exposure", "nan"}, exit_usage, "--exposure"},
      {{"render", "teapots", "-o", png, "--time", "nan"}, exit_usage, "--time"},
      {{"render", "teapots", "-o", png, "--time", "1e39"}, exit_usage, "--time"},
      {{"render", "teapots", "-o", png, "--spp", "1.5"}, exit_usage, "whole number from 1"},
      {{"render", "teapots", "-o", ""}, exit_usage, "-o '': pictures are"},
      {{"report", "teapots", "--assert", "sah<nan"}, exit_usage, "not a condition"},
      {{"validate"}, exit_usage, "scene is required"},
      {{"validate", "teapots", "--rays", "-1"}, exit_usage, "whole number from 0"},
      {{"validate", "planet"}, exit_failed, "planet: the file does not exist"},
      {{"trace", "teapots"}, exit_usage, "--pixel is required"},
      {{"trace", "teapots", "--pixel", "5"}, exit_usage, "write X,Y"},
      {{"trace", "teapots", "--pixel", "5,6,7"}, exit_usage, "'5,6,7' is not a pixel"},
      {{"trace", "teapots", "--pixel", "1.5,2"}, exit_usage, "whole pixels"},
      {{"trace", "teapots", "--pixel", "-1,2"}, exit_usage, "-1,2 is outside the picture"},
      {{"trace", "teapots", "--pixel", "64,2", "--size", "64x32"},
       exit_usage,
       "of 64 x 32 pixels X goes from 0 to 63 and Y from 0 to 31"},
      {{"trace", "teapots", "--pixel", "1,2", "--ray", "x"}, exit_usage, "number of a ray"},
      {{"trace", "needles", "--set", "triangles=50", "--pixel", "1,2", "--ray", "9"},
       exit_usage,
       "9 is none of the pixel's rays"},
      {{"trace", "planet", "--pixel", "1,2"}, exit_failed, "planet: the file does not exist"},
      {{"list"}, exit_usage, "One of: scenes, builders"},
      {{"render", "teapots", "-o", png, "--range", "5:5"}, exit_usage, "write LO:HI"},
      {{"render", "teapots", "-o", png, "--set", "detail"}, exit_usage, "write NAME=NUMBER"},
      {{"render", "bunny.obj", "-o", png, "--set", "detail=2"}, exit_usage, "is a file"},
      {{"render", "teapots", "-o", png, "--set", "wings=2"}, exit_failed, "wings"},
      {{"render", "teapots", "-o", png, "--bins", "1"}, exit_usage, "bins"},
      {{"render", "teapots", "-o", png, "--sky", "no.hdr"}, exit_failed, "no.hdr"},
      {{"render", "teapots", "-o", folder.path / "a.gif"}, exit_usage, ".png, .exr or .hdr"},
      {{"render", "teapots", "-o", folder.path / "a.exr", "--view", "uv"},
       exit_usage,
       "--view shaded"},
      {{"render", "teapots", "-o", folder.path / "no" / "a.png"},
       exit_failed,
       "folder does not exist"},
      {{"report", "teapots", "--json", folder.path}, exit_failed, "is a folder"},
      {{"report", "teapots", "--assert", "sah"}, exit_usage, "is not a condition"},
      {{"render", "teapots", "-o", png, "--nonsense"}, exit_usage, "--nonsense"},
  };
  for (const BadLine& line : lines) {
    const Result result = run(line.arguments);
    EXPECT_EQ(result.status, line.status) << testing::PrintToString(line.arguments);
    EXPECT_THAT(result.error, HasSubstr(line.message)) << testing::PrintToString(line.arguments);
    EXPECT_EQ(result.out, "");
    EXPECT_FALSE(std::filesystem::exists(png)) << testing::PrintToString(line.arguments);
  }
}

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

#ifndef BVHSCOPE_GUI
TEST(Workspace, SaysThatItIsNotThere) {
  const Result result = run({"teapots"});
  EXPECT_EQ(result.status, exit_failed);
  EXPECT_THAT(result.error, HasSubstr("BVHSCOPE_GUI"));
}
#endif

// The program itself, through a shell.
int shell(const std::string& line) {
  const int status = std::system((std::string(BVHSCOPE_PROGRAM " ") + line).c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Program, ExitStatus) {
  EXPECT_EQ(shell("--version >/dev/null"), exit_fine);
  EXPECT_EQ(shell("list views >/dev/null"), exit_fine);
  EXPECT_EQ(shell("render planet -o - 2>/dev/null"), exit_failed);
  EXPECT_EQ(shell("list nothing 2>/dev/null"), exit_usage);
  EXPECT_EQ(shell("report needles --set triangles=50 --size 9x9 --assert 'sah<0' "
                  ">/dev/null 2>/dev/null"),
            exit_assertion);
  EXPECT_EQ(shell("list views >/dev/full 2>/dev/null"), exit_failed);
}

TEST(Program, ControlCStopsCleanly) {
  const TemporaryFolder folder;
  const std::string file = folder.path / "a.png";
  const std::string script = BVHSCOPE_PROGRAM " render teapots --spp 60000 --size 640x360 -o " +
                             file + " 2>/dev/null & id=$!; sleep 0.5; kill -INT $id; wait $id";
  // bash -m: a background job of another shell ignores SIGINT.
  const int status = std::system(("bash -mc '" + script + "' 2>/dev/null").c_str());
  EXPECT_EQ(WEXITSTATUS(status), exit_interrupted);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path));
}

}  // namespace
}  // namespace app
