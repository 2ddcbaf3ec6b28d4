// The same hits from every layout and kernel on every instruction set.
#include <map>

#include <gtest/gtest.h>

#include "tracer/bvh/ray_kernels.h"
#include "tracer/bvh/trace.h"
#include "tracer/bvh/traverse.h"
#include "wide_layouts.h"

namespace tracer::test {
namespace {

// A leaf of split references may hold a triangle twice, the second time before others.
std::vector<SceneBvh> bvhs_of(const Scene& scene, BuildOptions options) {
  std::vector<SceneBvh> all = {bvh_of(scene, options)};
  options.presplit = true;
  options.split_budget = 2.0f;
  options.builder = "ploc";
  all.push_back(bvh_of(scene, options));
  return all;
}

TEST_P(EveryWideLayout, EveryKernelHitsWhatTheBinaryTreeDoes) {
  for (const Scene& scene : wide_scenes()) {
    for (const SceneBvh& bvh : bvhs_of(scene, options()))
      expect_the_binary_hits(bvh);
  }
}

// Large triangles in one plane, as walls overlap in a building: which of them is the nearest is a
// matter of rounding, and must not be one of the order of traversal.
Scene walls() {
  std::mt19937 random(11);
  Mesh mesh;
  for (uint32_t i = 0; i < 3 * 400; ++i) {
    mesh.positions.push_back(random_point(random, {vec3(31, 7.3f, -32), vec3(49, 7.3f, -14)}));
    if (i % 3 == 2) mesh.triangles.push_back({i - 2, i - 1, i});
  }
  return scene_of({mesh});
}

TEST(Hits, OfCoincidentTrianglesDoNotDependOnTheTree) {
  const Scene scene = walls();
  BuildOptions options;
  const SceneBvh binned = bvh_of(scene, options);
  options.builder = "lbvh";
  options.layout = "wide8";
  const SceneBvh wide = bvh_of(scene, options);
  options.builder = "sbvh";
  const SceneBvh split = bvh_of(scene, options);
  options.presplit = true;
  const SceneBvh presplit = bvh_of(scene, options);
  std::mt19937 random(12);
  NoProbe probe;
  std::vector<Ray> rays;
  for (int i = 0; i < 4000; ++i) {
    // Sixteen that are alike, so that packets stay together.
    const vec3 way = random_direction(random);
    Ray ray = i % 16 == 0 ? Ray{} : rays.back();
    if (i % 16 == 0) {
      ray.origin = random_point(random, {vec3(35, 7.2f, -28), vec3(45, 7.4f, -18)});
      ray.direction = way;
    }
    ray.direction += 0.01f * way;
    rays.push_back(ray);
  }
  std::map<std::string, std::vector<Hit>> hits;
  for (const SceneBvh* bvh : {&binned, &wide}) {
    for (const KernelRow& kernel : ray_kernels()) {
      const std::string& layout = bvh->options.layout;
      std::vector<Hit>& of = hits[layout + " " + std::string(kernel.id)];
      of.resize(rays.size());
      ray_kernel(layout, kernel.id).intersect(*bvh, rays, of);
    }
  }
  int hit_count = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const Hit expected = brute_force(scene, binned, rays[i]);
    hit_count += is_hit(expected) ? 1 : 0;
    ASSERT_EQ(intersect(binned, rays[i], probe), expected) << "ray " << i;
    for (const auto& [kernel, found] : hits)
      ASSERT_EQ(found[i], expected) << kernel << " ray " << i;
    ASSERT_EQ(trace<false>(split, rays[i], probe), expected) << "ray " << i;
    ASSERT_EQ(trace<false>(presplit, rays[i], probe), expected) << "ray " << i;
  }
  EXPECT_GT(hit_count, 1000);
}

}  // namespace
}  // namespace tracer::test
