// Folders, file endings and what a typed name means.
#include "ui/browse.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace ui {
namespace {

namespace fs = std::filesystem;

constexpr size_t max_entries = 10000;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

fs::path resolved(const FileBrowser& browser) {
  const char* home = std::getenv("HOME");
  if (browser.typed == "~" && home != nullptr) return home;
  if (browser.typed.starts_with("~/") && home != nullptr) {
    return fs::path(home) / browser.typed.substr(2);
  }
  return (browser.folder / browser.typed).lexically_normal();
}

}  // namespace

PurposeRow purpose_row(FilePurpose purpose) {
  switch (purpose) {
    case FilePurpose::open_scene:
      return {purpose, "Open a scene", "Open", "scenes", false, {".obj"}};
    case FilePurpose::open_sky:
      return {purpose, "Open a sky", "Open", "skies", false, {".hdr"}};
    case FilePurpose::save_picture:
      return {purpose, "Save the picture", "Save", "pictures", true, {".png", ".exr", ".hdr"}};
    case FilePurpose::open_session:
      return {purpose, "Open a session", "Open", "sessions", false, {".json"}};
    case FilePurpose::save_session:
      return {purpose, "Save the session", "Save", "sessions", true, {".json"}};
  }
  return {};
}

void open_browser(FileBrowser& browser, FilePurpose purpose) {
  browser.purpose = purpose;
  browser.opening = true;
  browser.confirm = false;
  browser.error.clear();
  browser.typed.clear();
  if (purpose == FilePurpose::save_picture) browser.typed = "picture.png";
  if (purpose == FilePurpose::save_session) browser.typed = "session.json";
  std::error_code error;
  if (browser.folder.empty()) browser.folder = fs::current_path(error);
  enter_folder(browser, browser.folder);
}

void enter_folder(FileBrowser& browser, const fs::path& folder) {
  std::error_code error;
  fs::directory_iterator files(folder, fs::directory_options::skip_permission_denied, error);
  if (error) {
    browser.error = folder.string() + ": " + error.message() + "; choose another folder.";
    return;
  }
  const std::vector<std::string> endings = purpose_row(browser.purpose).endings;
  std::vector<FileEntry> entries;
  for (; files != fs::directory_iterator() && entries.size() < max_entries;
       files.increment(error)) {
    if (error) break;
    FileEntry entry;
    entry.name = files->path().filename().string();
    if (entry.name.starts_with(".")) continue;
    std::error_code unreadable;
    entry.folder = files->is_directory(unreadable);
    const std::string ending = lower(files->path().extension().string());
    const bool known = std::find(endings.begin(), endings.end(), ending) != endings.end();
    if (!entry.folder && !known && !browser.all_files) continue;
    if (!entry.folder) entry.bytes = files->file_size(unreadable);
    if (unreadable) entry.bytes = 0;
    entries.push_back(std::move(entry));
  }
  std::sort(entries.begin(), entries.end(), [](const FileEntry& a, const FileEntry& b) {
    if (a.folder != b.folder) return a.folder;
    const std::string x = lower(a.name), y = lower(b.name);
    return x != y ? x < y : a.name < b.name;
  });
  browser.folder = folder;
  browser.entries = std::move(entries);
  browser.error.clear();
}

std::optional<fs::path> take_typed(FileBrowser& browser) {
  if (browser.typed.empty()) return {};
  const PurposeRow row = purpose_row(browser.purpose);
  fs::path file = resolved(browser);
  std::error_code error;
  if (fs::is_directory(file, error)) {
    enter_folder(browser, file);
    if (browser.error.empty()) browser.typed.clear();
    return {};
  }
  if (!row.save) {
    if (fs::exists(file, error)) return file;
    browser.error = file.string() + ": no such file; choose one from the list.";
    return {};
  }
  const std::string ending = lower(file.extension().string());
  if (std::find(row.endings.begin(), row.endings.end(), ending) == row.endings.end()) {
    file += row.endings.front();
  }
  if (!fs::is_directory(file.parent_path(), error)) {
    browser.error = file.parent_path().string() + ": no such folder; choose another one.";
    return {};
  }
  if (fs::exists(file, error) && !browser.confirm) {
    browser.confirm = true;
    return {};
  }
  return file;
}

}  // namespace ui
