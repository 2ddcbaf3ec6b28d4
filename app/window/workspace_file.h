// What the workspace remembers from one start to the next: layout, recent files, window size.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace app {

struct Remembered {
  int width = 0;  // of the window, points; 0: not known
  int height = 0;
  std::string layout;  // ui::layout_to_json

  bool operator==(const Remembered&) const = default;
};

// bvhscope/workspace.json below $XDG_CONFIG_HOME, else below $HOME/.config; nothing if neither is
// set to an absolute path.
std::optional<std::filesystem::path> workspace_file();

struct Recalled {
  Remembered remembered;
  std::string notice;  // what the user should know: an unusable file was put aside
};

// Never fails: what cannot be read is not remembered. A file with rubbish in it is renamed to
// workspace.json.bad-1 (-2, ...) and kept.
Recalled recall(const std::filesystem::path& file);

// Makes the folder if it is not there. Throws tracer::Error.
void remember(const std::filesystem::path& file, const Remembered& remembered);

}  // namespace app
