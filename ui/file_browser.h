// A popup that lets the user choose a file to open or to save.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace ui {

enum class FilePurpose { open_scene, open_sky, save_picture, open_session, save_session };

struct FileEntry {
  std::string name;  // UTF-8
  bool folder = false;
  uint64_t bytes = 0;
};

struct FileBrowser {
  FilePurpose purpose = FilePurpose::open_scene;
  bool opening = false;  // becomes visible in the next frame
  bool visible = false;
  bool all_files = false;  // not only those with a known ending
  bool confirm = false;    // the file to save exists: the user is asked
  std::filesystem::path folder;
  std::vector<FileEntry> entries;  // of the folder; folders first, then by name
  std::string typed;               // a name in the folder, or a path
  std::string error;               // why the folder cannot be listed or the file not be taken
};

}  // namespace ui
