// The builders, one a file. All take what build() in build.h has checked.
#pragma once

#include "tracer/bvh/build.h"

namespace tracer {

Bvh build_midpoint(const BuildInput&, const BuildOptions&, BuildLog*, std::stop_token);
Bvh build_median(const BuildInput&, const BuildOptions&, BuildLog*, std::stop_token);
Bvh build_binned(const BuildInput&, const BuildOptions&, BuildLog*, std::stop_token);
Bvh build_sweep(const BuildInput&, const BuildOptions&, BuildLog*, std::stop_token);
Bvh build_sbvh(const BuildInput&, const BuildOptions&, BuildLog*, std::stop_token);
Bvh build_lbvh(const BuildInput&, const BuildOptions&, BuildLog*, std::stop_token);
Bvh build_agglomerative(const BuildInput&, const BuildOptions&, BuildLog*, std::stop_token);
Bvh build_ploc(const BuildInput&, const BuildOptions&, BuildLog*, std::stop_token);

}  // namespace tracer
