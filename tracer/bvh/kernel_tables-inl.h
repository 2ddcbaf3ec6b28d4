// Where the kernels of each layout are found: one function a layout in kernels_*.cpp. By the tests
// (watertight, fast), then by kernel; empty: the layout has no such kernel. Declared once for each
// instruction set.
#if defined(TRACER_BVH_KERNEL_TABLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRACER_BVH_KERNEL_TABLES_INL_H_
#undef TRACER_BVH_KERNEL_TABLES_INL_H_
#else
#define TRACER_BVH_KERNEL_TABLES_INL_H_
#endif

#include <span>

#include <hwy/highway.h>

#include "tracer/bvh/ray_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

std::span<const RayKernel> binary_kernels();
std::span<const RayKernel> wide4_kernels();
std::span<const RayKernel> wide8_kernels();
std::span<const RayKernel> quantised8_kernels();

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
