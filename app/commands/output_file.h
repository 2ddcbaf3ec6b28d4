// Files that a command writes; "-" is the command's output stream.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string_view>

namespace app {

// Throws tracer::Error if the file can certainly not be written: asked before long work.
void check_output(const std::filesystem::path& file);

// All of it or nothing. Throws tracer::Error.
void write_output(const std::filesystem::path& file, std::string_view bytes, std::ostream& out);

}  // namespace app
