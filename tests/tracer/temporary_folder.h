// A folder for the files of one test; it and they are removed at the end of the scope.
#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include <stdlib.h>

struct TemporaryFolder {
  std::filesystem::path path;

  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "bvhscope-test-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    path = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }

  // Writes a file of this folder (name may have sub-folders) and gives its path.
  std::filesystem::path file(std::string_view name, std::string_view bytes = {}) const {
    std::filesystem::path result = path / name;
    std::filesystem::create_directories(result.parent_path());
    std::ofstream stream(result, std::ios::binary);
    stream.write(bytes.data(), std::streamsize(bytes.size()));
    return result;
  }
};

// The message of the exception that the call throws; empty if it throws none.
template <class Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}
