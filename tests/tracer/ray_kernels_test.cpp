// The table of kernels: which one a name, a layout and the rays get.
#include "tracer/bvh/ray_kernels.h"

#include <gtest/gtest.h>

#include "make_scene.h"

namespace tracer::test {
namespace {

TEST(Kernels, TakeThePreferredInstructionSet) {
  for (const IsaRow& isa : isas()) {
    prefer_isa(isa.id);
    EXPECT_EQ(ray_kernel("wide8").intersect, ray_kernel("wide8", "single", isa.id).intersect);
  }
  prefer_isa("");
  EXPECT_EQ(ray_kernel("wide8").intersect, ray_kernel("wide8", "single", isas()[0].id).intersect);
}

TEST(Kernels, AreThereForEveryRowAndUnknownOnesAreTheFirst) {
  EXPECT_FALSE(isas().empty());
  for (const LayoutRow& layout : layouts()) {
    for (const KernelRow& kernel : ray_kernels())
      EXPECT_NE(ray_kernel(layout.id, kernel.id).intersect, nullptr);
    EXPECT_EQ(ray_kernel(layout.id, "unknown", "unknown").intersect,
              ray_kernel(layout.id, "single", isas()[0].id).intersect);
  }
  EXPECT_TRUE(has_kernel("binary", "packet"));
  EXPECT_FALSE(has_kernel("binary", "stream"));
  EXPECT_TRUE(has_kernel("wide8", "stream"));
}

TEST(Kernels, SuitCoherenceOfTheRays) {
  std::vector<Ray> rays(256);
  EXPECT_EQ(suitable_kernel(rays), "packet");
  std::mt19937 random(3);
  for (Ray& ray : rays)
    ray.direction = random_direction(random);
  EXPECT_EQ(suitable_kernel(rays), "single");
  EXPECT_EQ(suitable_kernel({}), "single");
}

}  // namespace
}  // namespace tracer::test
