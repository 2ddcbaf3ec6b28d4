// app -> ui -> tracer: what each folder may include. Windows and OpenGL belong to app alone.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

struct Include {
  std::string file;  // relative to the repository
  int line = 0;
  std::string header;
};

std::vector<Include> includes_below(const std::string& folder) {
  const fs::path root = BVHSCOPE_SOURCE_DIR;
  const std::regex pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<Include> includes;
  for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".h" && ending != ".cpp") continue;
    std::ifstream stream(entry.path());
    std::string line;
    std::smatch match;
    for (int number = 1; std::getline(stream, line); ++number) {
      if (!std::regex_search(line, match, pattern)) continue;
      includes.push_back({fs::relative(entry.path(), root).string(), number, match[1]});
    }
  }
  return includes;
}

bool starts_with_any(const std::string& header, const std::vector<std::string>& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](const std::string& prefix) { return header.starts_with(prefix); });
}

const std::vector<std::string> gui_headers = {"imgui", "backends/", "misc/"};
const std::vector<std::string> window_headers = {"GLFW/", "glad/", "GL/", "KHR/",
                                                 "EGL/",  "X11/",  "GLES"};

void expect_none(const std::string& folder, const std::vector<std::string>& forbidden) {
  const std::vector<Include> includes = includes_below(folder);
  EXPECT_FALSE(includes.empty()) << folder;
  for (const Include& include : includes) {
    EXPECT_FALSE(starts_with_any(include.header, forbidden))
        << include.file << ":" << include.line << ": includes " << include.header;
  }
}

TEST(IncludeDirection, TracerKnowsNoOneAbove) {
  expect_none("tracer", {"ui/", "app/", "tests/"});
}

TEST(IncludeDirection, TracerKnowsNoGui) {
  expect_none("tracer", gui_headers);
  expect_none("tracer", window_headers);
}

TEST(IncludeDirection, UiKnowsNoAppAndNoWindow) {
  expect_none("ui", {"app/", "tests/", "backends/"});
  expect_none("ui", window_headers);
}

TEST(IncludeDirection, CommandsKnowNoWindowSystem) {
  expect_none("app/commands", window_headers);
  expect_none("app/commands", gui_headers);
}

// math < scene < bvh < analyze, render < pipeline.
TEST(IncludeDirection, TracersRoomsKeepTheirOrder) {
  expect_none("tracer/math", {"tracer/scene/", "tracer/bvh/", "tracer/analyze/", "tracer/render/",
                              "tracer/pipeline"});
  expect_none("tracer/scene",
              {"tracer/bvh/", "tracer/analyze/", "tracer/render/", "tracer/pipeline"});
  expect_none("tracer/bvh", {"tracer/analyze/", "tracer/render/", "tracer/pipeline"});
}

TEST(IncludeDirection, OnlyTheWindowKnowsGlfw) {
  for (const Include& include : includes_below("app")) {
    if (!include.header.starts_with("GLFW/")) continue;
    EXPECT_TRUE(include.file == "app/window/window.cpp" || include.file == "app/window/keys.cpp")
        << include.file << ":" << include.line;
  }
}

}  // namespace
