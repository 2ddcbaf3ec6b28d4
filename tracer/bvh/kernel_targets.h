// Which instruction sets the kernels without probes are compiled for; before hwy/foreach_target.h.
// The sets between SSE4.2 and plain code, and beyond AVX-512 as Skylake has it, gain nothing.
#pragma once

#include "tracer/math/isa.h"

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | TRACER_UNSIZED_VECTORS)
