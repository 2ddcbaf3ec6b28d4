// Checking and writing output files.
#include "app/commands/output_file.h"

#include <cerrno>
#include <cstring>
#include <ostream>

#include <unistd.h>

#include "tracer/error.h"
#include "tracer/file_io.h"

namespace app {

void check_output(const std::filesystem::path& file) {
  if (file == "-") return;
  if (file.empty()) throw tracer::Error("no name is given for the output file");
  std::error_code ignored;
  if (!file.has_filename() || std::filesystem::is_directory(file, ignored)) {
    throw tracer::Error(file.string() + ": is a folder; give the name of a file");
  }
  const std::filesystem::path folder =
      file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw tracer::Error(file.string() + ": the folder does not exist; create it first");
  }
  const bool exists = std::filesystem::exists(file, ignored);
  if (access((exists ? file : folder).c_str(), W_OK) != 0) {
    throw tracer::Error(file.string() + ": cannot be written: " + std::strerror(errno));
  }
}

void write_output(const std::filesystem::path& file, std::string_view bytes, std::ostream& out) {
  if (file != "-") return tracer::write_file_atomically(file, bytes);
  out.write(bytes.data(), std::streamsize(bytes.size()));
  if (!out.flush()) throw tracer::Error("standard output: cannot be written");
}

}  // namespace app
