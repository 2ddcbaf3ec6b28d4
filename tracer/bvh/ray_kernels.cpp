// The kernels of all layouts and instruction sets, put together; they are compiled in
// kernels_*.cpp.
#include "tracer/bvh/ray_kernels.h"

#include <array>
#include <atomic>
#include <cassert>

#include "tracer/bvh/kernel_targets.h"
#include "tracer/bvh/traverse.h"
#include "tracer/choice.h"
#include "tracer/math/isa.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/bvh/ray_kernels.cpp"
#include <hwy/foreach_target.h>

#include "tracer/bvh/kernel_tables-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

// By layout.
std::array<std::span<const RayKernel>, 4> kernels_of_layouts() {
  return {binary_kernels(), wide4_kernels(), wide8_kernels(), quantised8_kernels()};
}

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tracer {
namespace {

constexpr KernelRow kernel_rows[] = {
    {"single", "Single rays", "Each ray on its own, its children side by side in a vector.",
     "I. Wald, C. Benthin, S. Boulos, Getting Rid of Packets, 2008"},
    {"packet", "Packets",
     "As many neighbours as a vector has lanes, 16 at most, go down the tree together, in wide "
     "layouts by what bounds them all; behind rays that met nothing, 64 are asked at once.",
     "A. Reshetov et al., Multi-Level Ray Tracing Algorithm, 2005; S. Boulos et al., Packet-based "
     "Whitted and Distribution Ray Tracing, 2007; C. Benthin et "
     "al., Combining Single and Packet-Ray Tracing for Arbitrary Ray Distributions "
     "on the Intel MIC Architecture, 2012"},
    {"stream", "Streams",
     "Many rays go down the tree together, sorted by octant: a node is opened once for all that "
     "reach it, and each child gets a list of those that enter it. They need have nothing in "
     "common.",
     "C. Gribble, K. Ramani, Coherent Ray Tracing via Stream Filtering, 2008; R. Barringer, T. "
     "Akenine-Moeller, Dynamic Ray Stream Traversal, 2014"},
};

using KernelsOfLayouts = std::array<std::span<const RayKernel>, 4>;

struct Isa {
  IsaRow row;
  int64_t target;
  KernelsOfLayouts kernels;
};

// What was compiled for this kind of processor, best first.
std::span<const Isa> compiled() {
  static const Isa all[] = {
#if HWY_TARGETS & HWY_AVX3
    {{"avx512", "AVX-512", "512-bit vectors and masks (x86-64 servers since 2017)"},
     HWY_AVX3,
     N_AVX3::kernels_of_layouts()},
#endif
#if HWY_TARGETS & HWY_AVX2
    {{"avx2", "AVX2", "256-bit vectors (x86-64 since 2013)"},
     HWY_AVX2,
     N_AVX2::kernels_of_layouts()},
#endif
#if HWY_TARGETS & HWY_SSE4
    {{"sse4", "SSE4.2", "128-bit vectors (x86-64 since 2008)"},
     HWY_SSE4,
     N_SSE4::kernels_of_layouts()},
#endif
#if HWY_TARGETS & HWY_NEON
    {{"neon", "NEON", "128-bit vectors (aarch64)"}, HWY_NEON, N_NEON::kernels_of_layouts()},
#endif
#if HWY_TARGETS & HWY_SCALAR
    {{"portable", "Portable", "plain code, for any processor"},
     HWY_SCALAR,
     N_SCALAR::kernels_of_layouts()},
#endif
#if HWY_TARGETS & HWY_EMU128
    {{"portable", "Portable", "plain code, for any processor"},
     HWY_EMU128,
     N_EMU128::kernels_of_layouts()},
#endif
  };
  return all;
}

// Those of them that run here.
struct Available {
  std::vector<IsaRow> rows;
  std::vector<KernelsOfLayouts> kernels;  // of each row
  std::vector<int64_t> usable;            // targets, up to each
};

const Available& available() {
  static const Available all = [] {
    Available result;
    for (const Isa& isa : compiled()) {
      if (isa.target != HWY_STATIC_TARGET && (hwy::SupportedTargets() & isa.target) == 0) continue;
      result.rows.push_back(isa.row);
      result.kernels.push_back(isa.kernels);
      result.usable.push_back(hwy::SupportedTargets() & -isa.target);  // better ones: lower bits
    }
    return result;
  }();
  return all;
}

template <Tests tests>
void intersect_binary(const SceneBvh& bvh, std::span<const Ray> rays, std::span<Hit> hits) {
  NoProbe probe;
  for (size_t i = 0; i < rays.size(); ++i)
    hits[i] = traverse<false, tests>(bvh, rays[i], probe);
}

template <Tests tests>
void occluded_binary(const SceneBvh& bvh, std::span<const Ray> rays, std::span<uint8_t> blocked) {
  NoProbe probe;
  for (size_t i = 0; i < rays.size(); ++i)
    blocked[i] = is_hit(traverse<true, tests>(bvh, rays[i], probe));
}

template <Tests tests>
constexpr RayKernel binary_single = {intersect_binary<tests>, occluded_binary<tests>};

std::atomic<size_t> preferred{0};  // of the available rows

size_t row_of(std::string_view layout) {
  const LayoutRow* row = find_row(layouts(), layout);
  return row == nullptr ? 0 : size_t(row - layouts().data());
}

}  // namespace

std::span<const KernelRow> ray_kernels() {
  return kernel_rows;
}

std::span<const IsaRow> isas() {
  return available().rows;
}

void prefer_isa(std::string_view id) {
  const IsaRow* row = find_row(isas(), id);
  preferred = row == nullptr ? 0 : size_t(row - isas().data());
  limit_targets(available().usable[preferred]);
}

const IsaRow& preferred_isa() {
  return isas()[preferred];
}

std::string_view suitable_kernel(std::span<const Ray> rays) {
  constexpr size_t enough = 64;
  constexpr float alike = 0.99f;  // the cosine between neighbours: 8 degrees
  if (rays.size() < 2) return "single";
  const size_t samples = std::min(enough, rays.size() - 1);
  size_t coherent = 0;
  for (size_t i = 0; i < samples; ++i) {
    const size_t at = i * (rays.size() - 1) / samples;
    const vec3& a = rays[at].direction;
    const vec3& b = rays[at + 1].direction;
    coherent += glm::dot(a, b) > alike * glm::length(a) * glm::length(b) ? 1 : 0;
  }
  return 4 * coherent > 3 * samples ? "packet" : "single";
}

bool has_kernel(std::string_view layout, std::string_view kernel) {
  return ray_kernel(layout, kernel).intersect != ray_kernel(layout).intersect ||
         kernel == ray_kernels()[0].id;
}

RayKernel ray_kernel(std::string_view layout, std::string_view kernel, std::string_view isa,
                     Tests tests) {
  const Available& all = available();
  size_t set = preferred;
  for (size_t i = 0; i < all.rows.size(); ++i)
    if (all.rows[i].id == isa) set = i;
  const KernelRow* chosen = find_row(ray_kernels(), kernel);
  const size_t column = chosen == nullptr ? 0 : size_t(chosen - ray_kernels().data());
  assert(all.kernels[set].size() == layouts().size());
  const std::span<const RayKernel> of_layout = all.kernels[set][row_of(layout)];
  const bool fast = tests == Tests::fast;
  assert(of_layout.size() == 2 * ray_kernels().size());
  const RayKernel* of_tests = &of_layout[fast ? ray_kernels().size() : 0];
  if (of_tests[column].intersect != nullptr) return of_tests[column];
  if (of_tests[0].intersect != nullptr) return of_tests[0];
  return fast ? binary_single<Tests::fast> : binary_single<Tests::watertight>;
}

}  // namespace tracer
#endif
