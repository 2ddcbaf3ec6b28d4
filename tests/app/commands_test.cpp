#include <sstream>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/commands/command_line.h"

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
}

TEST(List, UnknownTableIsWrongUsageAndNamesTheKnownOnes) {
  const Result result = run({"list", "planets"});
  EXPECT_EQ(result.status, exit_usage);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.error, HasSubstr("unknown list 'planets'; known: scenes, builders"));
}

}  // namespace
}  // namespace app
