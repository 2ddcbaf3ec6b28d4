#include "app/window/workspace_file.h"

#include <cstdlib>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tracer/error.h"
#include "tracer/file_io.h"

namespace app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr uint64_t max_bytes = 4u << 20;
constexpr int max_side = 16384;

// The XDG base directory specification ignores relative paths.
std::optional<fs::path> absolute_path(const char* variable) {
  const char* value = std::getenv(variable);
  if (value == nullptr || *value != '/') return {};
  return fs::path(value);
}

int side(const Json& window, const char* key) {
  if (!window.is_object() || !window.contains(key) || !window[key].is_number_integer()) return 0;
  const auto value = window[key].get<int64_t>();
  return value > 0 && value <= max_side ? int(value) : 0;
}

std::string put_aside(const fs::path& file, const std::string& why) {
  fs::path aside;
  std::error_code error;
  for (int i = 1; aside.empty() || fs::exists(aside, error); ++i) {
    aside = file.string() + ".bad-" + std::to_string(i);
  }
  fs::rename(file, aside, error);
  return fmt::format("{}: {}; the workspace starts with its defaults{}", file.string(), why,
                     error ? "" : " and the file was kept as " + aside.filename().string());
}

}  // namespace

std::optional<fs::path> workspace_file() {
  std::optional<fs::path> folder = absolute_path("XDG_CONFIG_HOME");
  if (!folder) {
    folder = absolute_path("HOME");
    if (folder) *folder /= ".config";
  }
  if (folder) *folder /= "bvhscope/workspace.json";
  return folder;
}

Recalled recall(const fs::path& file) {
  Recalled result;
  std::error_code error;
  if (!fs::exists(file, error)) return result;
  std::string text;
  try {
    text = tracer::read_file(file, max_bytes);
  } catch (const tracer::Error& unreadable) {
    result.notice = std::string(unreadable.what()) + "; the workspace starts with its defaults";
    return result;
  }
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("layout") || !json["layout"].is_object()) {
    result.notice = put_aside(file, "not a workspace file");
    return result;
  }
  if (json.contains("window")) {
    result.remembered.width = side(json["window"], "width");
    result.remembered.height = side(json["window"], "height");
  }
  result.remembered.layout = json["layout"].dump();
  return result;
}

void remember(const fs::path& file, const Remembered& remembered) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) {
    throw tracer::Error(file.parent_path().string() + ": " + error.message());
  }
  const Json json = {{"schema", 1},
                     {"window", {{"width", remembered.width}, {"height", remembered.height}}},
                     {"layout", Json::parse(remembered.layout, nullptr, false)}};
  tracer::write_file_atomically(file, json.dump(1) + "\n");
}

}  // namespace app
