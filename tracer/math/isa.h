// Which of the instruction sets that code was compiled for it may use.
#pragma once

#include <cstdint>

// Sets whose vectors have no size before the program runs: they cannot lie in arrays.
#define TRACER_UNSIZED_VECTORS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)

namespace tracer {

// Bits of hwy/detect_targets.h: what the processor has and limit_targets left of it.
int64_t usable_targets();

// From now on, of HWY_DYNAMIC_DISPATCH too.
void limit_targets(int64_t targets);

}  // namespace tracer
