// Binned SAH builder (I. Wald, On fast Construction of SAH-based Bounding Volume Hierarchies,
// 2007).
#pragma once

#include "tracer/bvh/build.h"

namespace tracer {

Bvh build_binned(const BuildInput& input, const BuildOptions& options, BuildLog* log,
                 std::stop_token stop);

}  // namespace tracer
