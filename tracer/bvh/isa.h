// Which of the instruction sets that code was compiled for it may use.
#pragma once

#include <cstdint>

namespace tracer {

// Bits of hwy/detect_targets.h: what the processor has, up to the preferred set of ray_kernels.h.
int64_t usable_targets();

}  // namespace tracer
