// The optimisers, one a file. The tree is in depth-first order before and after.
#pragma once

#include "tracer/bvh/build.h"

namespace tracer {

void rotate(Bvh&, const BuildOptions&, BuildLog*, const std::stop_token&);
void reinsert(Bvh&, const BuildOptions&, BuildLog*, const std::stop_token&);

}  // namespace tracer
