// Which instruction sets shading is compiled for; before hwy/foreach_target.h. Vectors of eight
// floats at most: longer ones gain nothing where every lane looks up its own texel.
#pragma once

#include "tracer/math/isa.h"

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3 | HWY_AVX3_DL | TRACER_UNSIZED_VECTORS)
