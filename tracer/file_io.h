// Whole files in and out, safely.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tracer {

// The whole file. Throws Error if it is missing, not a regular file (a folder, pipe or device),
// unreadable or longer than max_bytes; memory is taken only after these checks.
std::string read_file(const std::filesystem::path& file, uint64_t max_bytes);

// Writes beside the target, flushes to the disk and renames: the target holds its old content or
// all of the new, never a part. A symbolic link is followed; a device such as /dev/null is written
// directly. Throws Error ("file: reason") and leaves no temporary file behind.
void write_file_atomically(const std::filesystem::path& file, std::string_view bytes);

}  // namespace tracer
