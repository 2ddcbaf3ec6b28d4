// The traversals with probes. Compiled for two instruction sets only, since probes cost more than
// boxes do.
#include "tracer/bvh/trace.h"

#include "tracer/math/isa.h"

#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3 | HWY_AVX3_DL | TRACER_UNSIZED_VECTORS)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/bvh/trace.cpp"
#include <hwy/foreach_target.h>

#include "tracer/bvh/wide_traverse-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

template <bool any_hit, class Probe>
Hit trace_wide(const SceneBvh& bvh, const Ray& ray, Probe& probe) {
  if (std::holds_alternative<Wide4>(bvh.wide_tlas)) {
    return traverse_wide<any_hit, Wide4>(bvh, ray, probe);
  }
  if (std::holds_alternative<Wide8>(bvh.wide_tlas)) {
    return traverse_wide<any_hit, Wide8>(bvh, ray, probe);
  }
  return traverse_wide<any_hit, Quantised8>(bvh, ray, probe);
}

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tracer {

template <bool any_hit, class Probe>
Hit trace(const SceneBvh& bvh, const Ray& ray, Probe& probe) {
  if (std::holds_alternative<std::monostate>(bvh.wide_tlas)) {
    return traverse<any_hit>(bvh, ray, probe);
  }
#if HWY_TARGETS & HWY_AVX2
  if ((usable_targets() & HWY_AVX2) != 0) return N_AVX2::trace_wide<any_hit>(bvh, ray, probe);
#endif
  return HWY_STATIC_DISPATCH(trace_wide<any_hit>)(bvh, ray, probe);
}

template Hit trace<false>(const SceneBvh&, const Ray&, NoProbe&);
template Hit trace<true>(const SceneBvh&, const Ray&, NoProbe&);
template Hit trace<false>(const SceneBvh&, const Ray&, CountProbe&);
template Hit trace<true>(const SceneBvh&, const Ray&, CountProbe&);
template Hit trace<false>(const SceneBvh&, const Ray&, VisitProbe&);
template Hit trace<true>(const SceneBvh&, const Ray&, VisitProbe&);
template Hit trace<false>(const SceneBvh&, const Ray&, WatchProbe&);
template Hit trace<true>(const SceneBvh&, const Ray&, WatchProbe&);
template Hit trace<false>(const SceneBvh&, const Ray&, LogProbe&);
template Hit trace<true>(const SceneBvh&, const Ray&, LogProbe&);

}  // namespace tracer
#endif
