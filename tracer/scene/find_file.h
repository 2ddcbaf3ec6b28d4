// Finding the files that a scene file names.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace tracer {

struct FoundFile {
  std::optional<std::filesystem::path> path;
  std::string problem;  // if there is none: why
};

// Looks in and below `folder` only; never above it. Accepts backslashes, quotes, "\ " for a blank,
// another case of letters, and absolute paths of the machine where the scene was made (then only
// the file's own name counts).
FoundFile find_file(const std::filesystem::path& folder, std::string_view name);

}  // namespace tracer
