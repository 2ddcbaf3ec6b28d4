// Finding the files that a scene file names.
#include "tracer/scene/find_file.h"

#include <algorithm>
#include <vector>

namespace tracer {
namespace {

namespace fs = std::filesystem;

constexpr size_t longest_name = 4096;  // bytes

std::string with_slashes(std::string_view name) {
  if (name.size() >= 2 && name.front() == '"' && name.back() == '"') {
    name = name.substr(1, name.size() - 2);
  }
  std::string result;
  for (size_t i = 0; i < name.size(); ++i) {
    const bool escaped_blank = name[i] == '\\' && i + 1 < name.size() && name[i + 1] == ' ';
    if (escaped_blank) continue;
    result += name[i] == '\\' ? '/' : name[i];
  }
  return result;
}

bool is_absolute(const std::string& name) {
  return name.front() == '/' || (name.size() > 1 && name[1] == ':');
}

bool equal_but_case(const std::string& a, const std::string& b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

// The entry of a folder with this name, in any case of letters if there is no exact one.
std::optional<fs::path> entry(const fs::path& folder, const std::string& name) {
  std::error_code error;
  if (fs::exists(folder / name, error)) return folder / name;
  std::vector<std::string> matches;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::string found = it->path().filename().string();
    if (equal_but_case(found, name)) matches.push_back(std::move(found));
  }
  if (matches.empty()) return {};
  return folder / *std::min_element(matches.begin(), matches.end());
}

std::optional<fs::path> below(const fs::path& folder, const fs::path& relative) {
  fs::path result = folder;
  for (const fs::path& part : relative) {
    const std::optional<fs::path> next = entry(result, part.string());
    if (!next) return {};
    result = *next;
  }
  return result;
}

}  // namespace

FoundFile find_file(const fs::path& folder, std::string_view name) {
  if (name.empty() || name.size() > longest_name || name.find('\0') != name.npos) {
    return {{}, "the file name is empty or too long"};
  }
  const std::string plain = with_slashes(name);
  if (plain.empty()) return {{}, "the file name is empty"};
  const fs::path start = folder.empty() ? fs::path(".") : folder;
  const fs::path relative = fs::path(plain).lexically_normal();
  const std::string own_name = fs::path(plain).filename().string();
  if (own_name.empty() || own_name == "." || own_name == "..") return {{}, "it is a folder"};
  if (!is_absolute(plain)) {
    if (*relative.begin() == "..") {
      return {{}, "it lies outside of the scene's folder; copy it beside the scene"};
    }
    if (auto found = below(start, relative)) return {found, {}};
  }
  if (auto found = entry(start, own_name)) return {found, {}};
  return {{}, "the file does not exist"};
}

}  // namespace tracer
