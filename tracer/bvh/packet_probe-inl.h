// What probes record of a packet: an event of probe.h happens to some of its rays at once.
// Compiled once for each instruction set.
#if defined(TRACER_BVH_PACKET_PROBE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRACER_BVH_PACKET_PROBE_INL_H_
#undef TRACER_BVH_PACKET_PROBE_INL_H_
#else
#define TRACER_BVH_PACKET_PROBE_INL_H_
#endif

#include "tracer/bvh/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

template <class Probe>
class PacketProbe;

template <>
class PacketProbe<NoProbe> {
 public:
  explicit PacketProbe(std::span<NoProbe>) {}
  void enter_instance(uint32_t, uint32_t, const EntryPoint&, uint32_t) {}
  void leave_instance(uint32_t) {}
  void enter(uint32_t, bool, uint32_t) {}
  void triangle(uint32_t) {}
  NoProbe& of(int) { return none_; }

 private:
  NoProbe none_;
};

// Counts for all lanes at once.
template <>
class PacketProbe<CountProbe> {
 public:
  explicit PacketProbe(std::span<CountProbe> probes) : probes_(probes) {
    const hn::RebindToUnsigned<PacketLanes> d;
    for (uint32_t* const counts : {nodes_, leaves_, triangles_})
      hn::Store(hn::Zero(d), d, counts);
  }
  ~PacketProbe() {
    for (size_t lane = 0; lane < probes_.size(); ++lane) {
      Counters& counters = probes_[lane].counters;
      counters.nodes += nodes_[lane];
      counters.leaves += leaves_[lane];
      counters.triangles += triangles_[lane];
    }
  }
  PacketProbe(const PacketProbe&) = delete;
  PacketProbe& operator=(const PacketProbe&) = delete;

  void enter_instance(uint32_t id, uint32_t mesh, const EntryPoint& at, uint32_t lanes) {
    for (; lanes != 0; lanes &= lanes - 1)
      of(std::countr_zero(lanes)).enter_instance(id, mesh, at);
  }
  void leave_instance(uint32_t) {}
  HWY_INLINE void enter(uint32_t, bool leaf, uint32_t lanes) {
    count(leaf ? leaves_ : nodes_, lanes);
  }
  HWY_INLINE void triangle(uint32_t lanes) { count(triangles_, lanes); }
  CountProbe& of(int lane) { return probes_[size_t(lane)]; }

 private:
  static HWY_INLINE void count(uint32_t* counts, uint32_t lanes) {
    const hn::RebindToUnsigned<PacketLanes> d;
    const auto ones = hn::IfThenElseZero(hn::RebindMask(d, lane_mask(lanes)), hn::Set(d, 1u));
    hn::Store(hn::Add(hn::Load(d, counts), ones), d, counts);
  }

  alignas(64) uint32_t nodes_[packet_size], leaves_[packet_size], triangles_[packet_size];
  std::span<CountProbe> probes_;
};

// All probes of a packet count for the same visits.
template <>
class PacketProbe<VisitProbe> {
 public:
  explicit PacketProbe(std::span<VisitProbe> probes) : probe_(probes[0]) {}
  void enter_instance(uint32_t id, uint32_t mesh, const EntryPoint& at, uint32_t) {
    probe_.enter_instance(id, mesh, at);
  }
  void leave_instance(uint32_t) { probe_.leave_instance(); }
  HWY_INLINE void enter(uint32_t node, bool, uint32_t lanes) {
    (*probe_.tree)[node] += uint32_t(std::popcount(lanes));
  }
  void triangle(uint32_t) {}
  VisitProbe& of(int) { return probe_; }

 private:
  VisitProbe& probe_;
};

template <>
class PacketProbe<WatchProbe> {
 public:
  explicit PacketProbe(std::span<WatchProbe> probes) : probes_(probes) {}
  void enter_instance(uint32_t id, uint32_t mesh, const EntryPoint& at, uint32_t lanes) {
    for (; lanes != 0; lanes &= lanes - 1)
      of(std::countr_zero(lanes)).enter_instance(id, mesh, at);
  }
  void leave_instance(uint32_t lanes) {
    for (; lanes != 0; lanes &= lanes - 1)
      of(std::countr_zero(lanes)).leave_instance();
  }
  HWY_INLINE void enter(uint32_t node, bool, uint32_t lanes) {
    if (node != probes_[0].watched.node) return;
    for (; lanes != 0; lanes &= lanes - 1)
      of(std::countr_zero(lanes)).inner(node);
  }
  void triangle(uint32_t) {}
  WatchProbe& of(int lane) { return probes_[size_t(lane)]; }

 private:
  std::span<WatchProbe> probes_;
};

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
