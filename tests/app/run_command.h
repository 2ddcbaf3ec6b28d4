// Runs commands as main does.
#pragma once

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "app/commands/command.h"
#include "app/commands/command_line.h"
#include "tracer/file_io.h"

namespace app {

struct Result {
  int status;
  std::string out, error;
};

inline Result run(const std::vector<std::string>& arguments) {
  std::ostringstream out;
  std::ostringstream error;
  const int status = run_command(arguments, out, error);
  return {status, out.str(), error.str()};
}

// A picture of a few pixels of a scene that is made in no time.
inline std::vector<std::string> small_render(const std::string& file) {
  return {"render", "needles",   "--set", "triangles=50", "--size", "40x30", "--spp",
          "1",      "--threads", "2",     "-o",           file};
}

inline std::vector<std::string> operator+(std::vector<std::string> a,
                                          const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

inline std::string bytes_of(const std::filesystem::path& file) {
  return tracer::read_file(file, 1 << 24);
}

}  // namespace app
