// The limit on instruction sets: that of kernels, and that of Highway's own dispatch.
#include "tracer/math/isa.h"

#include <gtest/gtest.h>

#include "tracer/bvh/ray_kernels.h"
#include "tracer/math/shading_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/tracer/isa_test.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tracer::test::HWY_NAMESPACE {

int64_t compiled_for() {
  return HWY_TARGET;
}

}  // namespace tracer::test::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tracer::test {
namespace {

HWY_EXPORT(compiled_for);

TEST(Isa, LimitsWhatIsDispatched) {
  for (const IsaRow& isa : isas()) {
    prefer_isa(isa.id);
    const int64_t usable = usable_targets() & (HWY_TARGETS | HWY_STATIC_TARGET);
    // The best of them: the lowest bit.
    EXPECT_EQ(HWY_DYNAMIC_DISPATCH(compiled_for)(), usable & -usable) << isa.id;
  }
  prefer_isa(isas().back().id);
  EXPECT_EQ(HWY_DYNAMIC_DISPATCH(compiled_for)(), HWY_STATIC_TARGET);
  prefer_isa("");
}

}  // namespace
}  // namespace tracer::test
#endif
