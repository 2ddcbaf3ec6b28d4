// The kernels for every instruction set: this file is compiled once for each of them.
#include "tracer/bvh/ray_kernels.h"

#include "tracer/choice.h"

// The sets between SSE4.2 and plain code, and beyond AVX-512 as Skylake has it, gain nothing.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/bvh/ray_kernels.cpp"
#include <hwy/foreach_target.h>

#include "tracer/bvh/wide_traverse-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

template <class Nodes>
void intersect_single(const SceneBvh& bvh, std::span<const Ray> rays, std::span<Hit> hits) {
  NoProbe probe;
  for (size_t i = 0; i < rays.size(); ++i)
    hits[i] = traverse_wide<false, Nodes>(bvh, rays[i], probe);
}

template <class Nodes>
void occluded_single(const SceneBvh& bvh, std::span<const Ray> rays, std::span<uint8_t> blocked) {
  NoProbe probe;
  for (size_t i = 0; i < rays.size(); ++i)
    blocked[i] = is_hit(traverse_wide<true, Nodes>(bvh, rays[i], probe));
}

// By layout (4-wide, 8-wide, quantised), then by kernel.
std::span<const RayKernel> wide_kernels() {
  static constexpr RayKernel kernels[] = {
      {intersect_single<Wide4>, occluded_single<Wide4>},
      {intersect_single<Wide8>, occluded_single<Wide8>},
      {intersect_single<Quantised8>, occluded_single<Quantised8>},
  };
  return kernels;
}

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tracer {
namespace {

constexpr KernelRow kernel_rows[] = {
    {"single", "Single rays", "Each ray on its own, its children side by side in a vector.",
     "I. Wald, C. Benthin, S. Boulos, Getting Rid of Packets, 2008"},
};

struct Isa {
  IsaRow row;
  int64_t target;
  std::span<const RayKernel> kernels;
};

// What was compiled for this kind of processor, best first.
std::span<const Isa> compiled() {
  static const Isa all[] = {
#if HWY_TARGETS & HWY_AVX3
    {{"avx512", "AVX-512", "512-bit vectors and masks (x86-64 servers since 2017)"},
     HWY_AVX3,
     N_AVX3::wide_kernels()},
#endif
#if HWY_TARGETS & HWY_AVX2
    {{"avx2", "AVX2", "256-bit vectors (x86-64 since 2013)"}, HWY_AVX2, N_AVX2::wide_kernels()},
#endif
#if HWY_TARGETS & HWY_SSE4
    {{"sse4", "SSE4.2", "128-bit vectors (x86-64 since 2008)"}, HWY_SSE4, N_SSE4::wide_kernels()},
#endif
#if HWY_TARGETS & HWY_NEON
    {{"neon", "NEON", "128-bit vectors (aarch64)"}, HWY_NEON, N_NEON::wide_kernels()},
#endif
#if HWY_TARGETS & HWY_SCALAR
    {{"portable", "Portable", "plain code, for any processor"},
     HWY_SCALAR,
     N_SCALAR::wide_kernels()},
#endif
#if HWY_TARGETS & HWY_EMU128
    {{"portable", "Portable", "plain code, for any processor"},
     HWY_EMU128,
     N_EMU128::wide_kernels()},
#endif
  };
  return all;
}

// Those of them that run here.
struct Available {
  std::vector<IsaRow> rows;
  std::vector<std::span<const RayKernel>> kernels;  // of each row
};

const Available& available() {
  static const Available all = [] {
    Available result;
    for (const Isa& isa : compiled()) {
      if (isa.target != HWY_STATIC_TARGET && (hwy::SupportedTargets() & isa.target) == 0) continue;
      result.rows.push_back(isa.row);
      result.kernels.push_back(isa.kernels);
    }
    return result;
  }();
  return all;
}

void intersect_binary(const SceneBvh& bvh, std::span<const Ray> rays, std::span<Hit> hits) {
  NoProbe probe;
  for (size_t i = 0; i < rays.size(); ++i)
    hits[i] = traverse<false>(bvh, rays[i], probe);
}

void occluded_binary(const SceneBvh& bvh, std::span<const Ray> rays, std::span<uint8_t> blocked) {
  NoProbe probe;
  for (size_t i = 0; i < rays.size(); ++i)
    blocked[i] = is_hit(traverse<true>(bvh, rays[i], probe));
}

}  // namespace

std::span<const KernelRow> ray_kernels() {
  return kernel_rows;
}

std::span<const IsaRow> isas() {
  return available().rows;
}

bool has_kernel(std::string_view layout, std::string_view kernel) {
  return kernel == "single" || find_row(layouts(), layout)->width > 2;
}

RayKernel ray_kernel(std::string_view layout, std::string_view, std::string_view isa) {
  const LayoutRow* row = find_row(layouts(), layout);
  if (row == nullptr || row->width == 2) return {intersect_binary, occluded_binary};
  const Available& all = available();
  size_t set = 0;
  for (size_t i = 0; i < all.rows.size(); ++i)
    if (all.rows[i].id == isa) set = i;
  return all.kernels[set][row->quantised ? 2 : row->width == 8 ? 1 : 0];
}

}  // namespace tracer
#endif
