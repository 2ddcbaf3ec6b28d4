// The kernels of the 4-wide layout for every instruction set.
#include "tracer/bvh/kernel_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/bvh/kernels_wide4.cpp"
#include <hwy/foreach_target.h>

#include "tracer/bvh/layout_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

std::span<const RayKernel> wide4_kernels() {
  return wide_kernels<Wide4>();
}

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
