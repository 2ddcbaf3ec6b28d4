// The kernels of the binary layout for every instruction set; single rays go the same way on
// all of them: ray_kernels.cpp.
#include "tracer/bvh/kernel_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/bvh/kernels_binary.cpp"
#include <hwy/foreach_target.h>

#include "tracer/bvh/layout_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

std::span<const RayKernel> binary_kernels() {
  static constexpr RayKernel kernels[] = {{}, binary_packets<Tests::watertight>, {},
                                          {}, binary_packets<Tests::fast>,       {}};
  return kernels;
}

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
