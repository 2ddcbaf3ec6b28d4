// Tracing many rays without recording anything: kernels for every layout, with watertight or fast
// tests, compiled for several instruction sets and chosen when the program runs.
#pragma once

#include <span>
#include <string_view>

#include "tracer/bvh/box_test.h"
#include "tracer/bvh/scene_bvh.h"
#include "tracer/math/ray.h"

namespace tracer {

// How rays share the work.
struct KernelRow {
  std::string_view id, label, help, paper;
};
std::span<const KernelRow> ray_kernels();

// Instruction sets that the kernels are compiled for; single rays in the binary layout go the same
// way on all of them.
struct IsaRow {
  std::string_view id, label, help;
};
// Those that this processor has, the best one first.
std::span<const IsaRow> isas();
// The one that is taken from now on where none is asked for, here and in trace.h; "": the best one.
// One for the whole program, as the processor is; not while rays are traced.
void prefer_isa(std::string_view id);
const IsaRow& preferred_isa();

// Neither allocates anything for a ray; streams make room for their stacks once a call. Rays that
// are not valid (traverse.h) hit nothing. The spans are of one length.
struct RayKernel {
  // The nearest hits. Watertight: the same for every layout, kernel and instruction set; fast: but
  // for few rays.
  void (*intersect)(const SceneBvh& bvh, std::span<const Ray> rays, std::span<Hit> hits);
  // 1 where anything is hit, else 0.
  void (*occluded)(const SceneBvh& bvh, std::span<const Ray> rays, std::span<uint8_t> blocked);
};

// For BVHs of this layout. Unknown ids give the first row's, and so does a kernel that the layout
// has not; without an instruction set that the processor has it is the preferred one.
RayKernel ray_kernel(std::string_view layout, std::string_view kernel = {},
                     std::string_view isa = {}, Tests tests = Tests::watertight);

// The kernel that suits these rays: packets where neighbours go nearly the same way. Looks at some
// of them.
std::string_view suitable_kernel(std::span<const Ray> rays);

// Whether the layout has this kernel.
bool has_kernel(std::string_view layout, std::string_view kernel);

}  // namespace tracer
