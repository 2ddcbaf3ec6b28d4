// How much memory there is to take.
#include "tracer/memory.h"

#include <fstream>
#include <limits>
#include <string>

namespace tracer {

uint64_t memory_available() {
  std::ifstream file("/proc/meminfo");
  std::string line;
  while (std::getline(file, line)) {
    if (line.starts_with("MemAvailable:")) return std::stoull(line.substr(13)) * 1024;
  }
  return std::numeric_limits<uint64_t>::max();
}

}  // namespace tracer
