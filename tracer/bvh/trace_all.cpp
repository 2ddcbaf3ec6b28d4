// Many rays with probes: packets where they pay, else one ray after the other.
#include "tracer/bvh/ray_kernels.h"
#include "tracer/bvh/trace.h"
#include "tracer/math/isa.h"

// Two sets beside plain code suffice.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL | TRACER_UNSIZED_VECTORS)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/bvh/trace_all.cpp"
#include <hwy/foreach_target.h>

#include "tracer/bvh/binary_packet-inl.h"
#include "tracer/bvh/wide_packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

// By layout.
template <bool any_hit, class Probe>
struct PacketOf {
  BinaryPacket<any_hit, Probe> operator()(std::monostate) const;
  template <class Nodes>
  WatchedPacket<any_hit, Nodes, Probe> operator()(const Nodes&) const;
};

template <bool any_hit, class Probe>
void trace_in_packets(const SceneBvh& bvh, std::span<const Ray> rays, std::span<Probe> probes,
                      std::span<Hit> hits) {
  const auto answer = [&](size_t first, size_t count, const auto& packet) {
    packet.write_hits(hits.subspan(first, count));
  };
  std::visit(
      [&](const auto& tlas) {
        using OnePacket = std::invoke_result_t<PacketOf<any_hit, Probe>, decltype(tlas)>;
        trace_packets<OnePacket>(bvh, rays, probes, answer);
      },
      bvh.wide_tlas);
}

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tracer {

template <bool any_hit, class Probe>
void trace_all(const SceneBvh& bvh, std::span<const Ray> rays, std::span<Probe> probes,
               std::span<Hit> hits) {
  if (suitable_kernel(rays) != "packet") {
    for (size_t i = 0; i < rays.size(); ++i)
      hits[i] = trace<any_hit>(bvh, rays[i], probes[i]);
    return;
  }
  [[maybe_unused]] const int64_t usable = usable_targets();
#if HWY_TARGETS & HWY_AVX3
  if ((usable & HWY_AVX3) != 0) return N_AVX3::trace_in_packets<any_hit>(bvh, rays, probes, hits);
#endif
#if HWY_TARGETS & HWY_AVX2
  if ((usable & HWY_AVX2) != 0) return N_AVX2::trace_in_packets<any_hit>(bvh, rays, probes, hits);
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
