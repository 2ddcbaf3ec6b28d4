// Many rays with probes: packets where they pay, else one ray after the other.
#include "tracer/bvh/ray_kernels.h"
#include "tracer/bvh/trace.h"

// Two sets beside plain code suffice.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/bvh/trace_all.cpp"
#include <hwy/foreach_target.h>

#include "tracer/bvh/binary_packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

template <bool any_hit, class Probe>
void trace_in_packets(const SceneBvh& bvh, std::span<const Ray> rays, std::span<Probe> probes,
                      std::span<Hit> hits) {
  trace_packets<any_hit>(bvh, rays, probes, [&](size_t ray, const Hit& hit) { hits[ray] = hit; });
}

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tracer {

template <bool any_hit, class Probe>
void trace_all(const SceneBvh& bvh, std::span<const Ray> rays, std::span<Probe> probes,
               std::span<Hit> hits) {
  const bool is_binary = std::holds_alternative<std::monostate>(bvh.wide_tlas);
  if (!is_binary || suitable_kernel(rays) != "packet") {
    for (size_t i = 0; i < rays.size(); ++i)
      hits[i] = trace<any_hit>(bvh, rays[i], probes[i]);
    return;
  }
  static const int64_t supported = hwy::SupportedTargets();
#if HWY_TARGETS & HWY_AVX3
  if ((supported & HWY_AVX3) != 0)
    return N_AVX3::trace_in_packets<any_hit>(bvh, rays, probes, hits);
#endif
#if HWY_TARGETS & HWY_AVX2
  if ((supported & HWY_AVX2) != 0)
    return N_AVX2::trace_in_packets<any_hit>(bvh, rays, probes, hits);
#endif
  HWY_STATIC_DISPATCH(trace_in_packets<any_hit>)(bvh, rays, probes, hits);
}

template void trace_all<false>(const SceneBvh&, std::span<const Ray>, std::span<CountProbe>,
                               std::span<Hit>);
template void trace_all<true>(const SceneBvh&, std::span<const Ray>, std::span<CountProbe>,
                              std::span<Hit>);
template void trace_all<false>(const SceneBvh&, std::span<const Ray>, std::span<VisitProbe>,
                               std::span<Hit>);
template void trace_all<true>(const SceneBvh&, std::span<const Ray>, std::span<VisitProbe>,
                              std::span<Hit>);
template void trace_all<false>(const SceneBvh&, std::span<const Ray>, std::span<WatchProbe>,
                               std::span<Hit>);
template void trace_all<true>(const SceneBvh&, std::span<const Ray>, std::span<WatchProbe>,
                              std::span<Hit>);

}  // namespace tracer
#endif
