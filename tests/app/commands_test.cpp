// The command line, its lists, bad input, and the program itself.
#include <cstdlib>
#include <filesystem>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "app/commands/scene_options.h"
#include "run_command.h"
#include "tests/tracer/temporary_folder.h"
#include "tracer/file_io.h"
#include "tracer/scene/load_image.h"

namespace app {
namespace {

using testing::HasSubstr;

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
      {{"render", "teapots", "-o", png, "--kernel", "packet"}, exit_usage, "write CLASS=KERNEL"},
      {{"render", "teapots", "-o", png, "--kernel", "x=packet"}, exit_usage, "out of primary"},
      {{"render", "teapots", "-o", png, "--kernel", "shadow=x"}, exit_usage, "automatic, single"},
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
