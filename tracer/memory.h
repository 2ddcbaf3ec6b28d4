// How much memory there is to take.
#pragma once

#include <cstdint>

namespace tracer {

// Bytes that can be used without swapping (MemAvailable of /proc/meminfo); the largest number if
// the system does not say.
uint64_t memory_available();

}  // namespace tracer
