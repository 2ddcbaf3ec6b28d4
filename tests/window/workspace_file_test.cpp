// What the workspace remembers: round trip, and rubbish put aside.
#include "app/window/workspace_file.h"

#include <cstdlib>
#include <optional>

#include <gtest/gtest.h>

#include "tests/tracer/temporary_folder.h"
#include "tracer/file_io.h"

namespace app {
namespace {

namespace fs = std::filesystem;

// Sets or clears an environment variable for one scope.
struct Variable {
  const char* name;
  std::optional<std::string> before;

  Variable(const char* variable, const char* value) : name(variable) {
    if (const char* old = std::getenv(name)) before = old;
    set(value);
  }
  ~Variable() { set(before ? before->c_str() : nullptr); }
  void set(const char* value) const { value ? setenv(name, value, 1) : unsetenv(name); }
};

TEST(WorkspaceFile, IsBelowTheConfigurationFolder) {
  const Variable config("XDG_CONFIG_HOME", "/somewhere");
  EXPECT_EQ(workspace_file(), fs::path("/somewhere/bvhscope/workspace.json"));
}

TEST(WorkspaceFile, IsBelowHomeWithoutOne) {
  const Variable config("XDG_CONFIG_HOME", nullptr);
  const Variable home("HOME", "/home/she");
  EXPECT_EQ(workspace_file(), fs::path("/home/she/.config/bvhscope/workspace.json"));
}

TEST(WorkspaceFile, IgnoresRelativeFolders) {
  const Variable config("XDG_CONFIG_HOME", "here");
  const Variable home("HOME", nullptr);
  EXPECT_FALSE(workspace_file());
}

TEST(WorkspaceFile, RecallsWhatWasRemembered) {
  const TemporaryFolder folder;
  const fs::path file = folder.path / "new/folder/workspace.json";
  const Remembered remembered{1200, 800, R"({"left":300})"};
  remember(file, remembered);
  const Recalled recalled = recall(file);
  EXPECT_EQ(recalled.remembered, remembered);
  EXPECT_EQ(recalled.notice, "");
}

TEST(WorkspaceFile, AMissingFileIsNothingToTell) {
  const TemporaryFolder folder;
  const Recalled recalled = recall(folder.path / "workspace.json");
  EXPECT_EQ(recalled.remembered, Remembered());
  EXPECT_EQ(recalled.notice, "");
}

TEST(WorkspaceFile, RubbishIsPutAsideAndKept) {
  const TemporaryFolder folder;
  for (const char* rubbish : {"", "{", "[1,2]", "\xff\xfe", R"({"layout":7})"}) {
    const fs::path file = folder.file("workspace.json", rubbish);
    const Recalled recalled = recall(file);
    EXPECT_EQ(recalled.remembered, Remembered()) << rubbish;
    EXPECT_NE(recalled.notice.find("workspace.json.bad-"), std::string::npos) << recalled.notice;
    EXPECT_FALSE(fs::exists(file));
  }
  EXPECT_EQ(tracer::read_file(folder.path / "workspace.json.bad-2", 100), "{");
  EXPECT_TRUE(fs::exists(folder.path / "workspace.json.bad-5"));
}

TEST(WorkspaceFile, AFolderInItsPlaceIsLeftAlone) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path / "workspace.json");
  const Recalled recalled = recall(folder.path / "workspace.json");
  EXPECT_NE(recalled.notice, "");
  EXPECT_TRUE(fs::is_directory(folder.path / "workspace.json"));
}

TEST(WorkspaceFile, ImpossibleWindowSizesAreIgnored) {
  const TemporaryFolder folder;
  const fs::path file =
      folder.file("workspace.json", R"({"window":{"width":-5,"height":1e30},"layout":{"left":1}})");
  EXPECT_EQ(recall(file).remembered.width, 0);
  EXPECT_EQ(recall(file).remembered.height, 0);
  EXPECT_EQ(recall(file).remembered.layout, R"({"left":1})");
}

TEST(WorkspaceFile, AFolderThatCannotBeMadeIsAnError) {
  const TemporaryFolder folder;
  const fs::path blocker = folder.file("file");
  const std::string message = message_of([&] {
    remember(blocker / "below/workspace.json", {1, 1, "{}"});
  });
  EXPECT_NE(message.find("below"), std::string::npos) << message;
}

}  // namespace
}  // namespace app
