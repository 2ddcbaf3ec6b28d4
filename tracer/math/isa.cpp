// The instruction sets that may be used.
#include "tracer/math/isa.h"

#include <atomic>

#include <hwy/targets.h>

namespace tracer {
namespace {

std::atomic<int64_t> limit{-1};

// Asked once: virtual machines take long to answer.
int64_t supported_targets() {
  static const int64_t supported = hwy::SupportedTargets();
  return supported;
}

}  // namespace

int64_t usable_targets() {
  return supported_targets() & limit;
}

void limit_targets(int64_t targets) {
  limit = targets;
  hwy::GetChosenTarget().Update(usable_targets());
}

}  // namespace tracer
