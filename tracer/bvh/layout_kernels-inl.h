// The kernels of one layout: single rays, packets and streams, watertight and fast.
// Compiled once for each instruction set, one layout a file, so that several processors share the
// work: kernels_*.cpp.
#if defined(TRACER_BVH_LAYOUT_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRACER_BVH_LAYOUT_KERNELS_INL_H_
#undef TRACER_BVH_LAYOUT_KERNELS_INL_H_
#else
#define TRACER_BVH_LAYOUT_KERNELS_INL_H_
#endif

#include "tracer/bvh/binary_packet-inl.h"
#include "tracer/bvh/kernel_tables-inl.h"
#include "tracer/bvh/wide_group-inl.h"
#include "tracer/bvh/wide_stream-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

template <class Nodes, Tests tests>
void intersect_single(const SceneBvh& bvh, std::span<const Ray> rays, std::span<Hit> hits) {
  NoProbe probe;
  for (size_t i = 0; i < rays.size(); ++i)
    hits[i] = traverse_wide<false, Nodes, tests>(bvh, rays[i], probe);
}

template <class Nodes, Tests tests>
void occluded_single(const SceneBvh& bvh, std::span<const Ray> rays, std::span<uint8_t> blocked) {
  NoProbe probe;
  for (size_t i = 0; i < rays.size(); ++i)
    blocked[i] = is_hit(traverse_wide<true, Nodes, tests>(bvh, rays[i], probe));
}

template <class SomeRays>
void intersect_packets(const SceneBvh& bvh, std::span<const Ray> rays, std::span<Hit> hits) {
  trace_packets<SomeRays>(bvh, rays, std::span<NoProbe>(),
                          [&](size_t first, size_t count, const SomeRays& packet) {
                            packet.write_hits(hits.subspan(first, count));
                          });
}

template <class SomeRays>
void occluded_packets(const SceneBvh& bvh, std::span<const Ray> rays, std::span<uint8_t> blocked) {
  trace_packets<SomeRays>(bvh, rays, std::span<NoProbe>(),
                          [&](size_t first, size_t count, const SomeRays& packet) {
                            packet.write_blocked(blocked.subspan(first, count));
                          });
}

template <class Nodes, Tests tests>
void intersect_stream(const SceneBvh& bvh, std::span<const Ray> rays, std::span<Hit> hits) {
  const Nodes* tlas = std::get_if<Nodes>(&bvh.wide_tlas);
  if (tlas == nullptr) return intersect_single<Nodes, tests>(bvh, rays, hits);
  StreamTraversal<false, Nodes, tests>(bvh, *tlas, rays).run([&](uint32_t ray, const Hit& hit) {
    hits[ray] = hit;
  });
}

template <class Nodes, Tests tests>
void occluded_stream(const SceneBvh& bvh, std::span<const Ray> rays, std::span<uint8_t> blocked) {
  const Nodes* tlas = std::get_if<Nodes>(&bvh.wide_tlas);
  if (tlas == nullptr) return occluded_single<Nodes, tests>(bvh, rays, blocked);
  StreamTraversal<true, Nodes, tests>(bvh, *tlas, rays).run([&](uint32_t ray, const Hit& hit) {
    blocked[ray] = is_hit(hit);
  });
}

template <Tests tests>
constexpr RayKernel binary_packets = {intersect_packets<BinaryPacket<false, NoProbe, tests>>,
                                      occluded_packets<BinaryPacket<true, NoProbe, tests>>};

template <class Nodes>
std::span<const RayKernel> wide_kernels() {
  constexpr Tests watertight = Tests::watertight, fast = Tests::fast;
  static constexpr RayKernel kernels[] = {
      {intersect_single<Nodes, watertight>, occluded_single<Nodes, watertight>},
      {intersect_packets<WideGroup<false, Nodes, watertight>>,
       occluded_packets<WideGroup<true, Nodes, watertight>>},
      {intersect_stream<Nodes, watertight>, occluded_stream<Nodes, watertight>},
      {intersect_single<Nodes, fast>, occluded_single<Nodes, fast>},
      {intersect_packets<WideGroup<false, Nodes, fast>>,
       occluded_packets<WideGroup<true, Nodes, fast>>},
      {intersect_stream<Nodes, fast>, occluded_stream<Nodes, fast>},
  };
  return kernels;
}

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
