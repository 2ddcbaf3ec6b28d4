// Random lines against SAH.
#include "tracer/analyze/sah_test.h"

#include "tracer/analyze/quality.h"
#include "tracer/analyze/random_lines.h"
#include "tracer/bvh/traverse.h"
#include "tracer/math/normalize.h"

namespace tracer {
namespace {

constexpr uint64_t seed = 20131;

struct InnerProbe : NoProbe {
  uint64_t nodes = 0;
  void inner(uint32_t) { ++nodes; }
};

// Lines begin where floats are. Far from the origin these lie too far apart for small boxes: there
// the tree is tested as if it were at the origin.
bool is_far(const Box& root) {
  constexpr float many_extents = 16.0f;
  return max_component(glm::max(glm::abs(root.lo), glm::abs(root.hi))) >
         many_extents * max_component(root.hi - root.lo);
}

Bvh moved(const Bvh& tree, const vec3& by) {
  Bvh result = tree;
  for (BvhNode& node : result.nodes) {
    node.lo += by;
    node.hi += by;
  }
  return result;
}

}  // namespace

bool holds(const SahTest& test) {
  return test.lines == 0 ||
         std::abs(test.measured - test.sah) <= 6.0 * test.standard_error + 0.002 * test.sah;
}

SahTest sah_test(const Bvh& tree, float traversal_cost, float intersection_cost,
                 const SampleLimits& limits, const std::stop_token& stop) {
  SahTest test;
  if (tree.nodes.empty()) return test;
  const Box root = box_of(tree.nodes[0]);
  if (is_far(root)) {
    return sah_test(moved(tree, -root.lo), traversal_cost, intersection_cost, limits, stop);
  }
  test.sah = statistics(tree, traversal_cost, intersection_cost).sah;
  test.measured = test.sah;
  const vec3 e = root.hi - root.lo;
  if (int(e.x > 0.0f) + int(e.y > 0.0f) + int(e.z > 0.0f) < 2) return test;

  const Estimate estimate = estimate_mean(limits, seed, stop, [&](double face, Rng& rng) {
    InnerProbe probe;
    uint64_t references = 0;
    const Ray line = random_line(root, face, rng);
    walk(tree, box_ray(line.origin, line.direction), 0.0f, infinity, probe,
         [&](const BvhNode& leaf) {
           references += leaf.count;
           return false;
         });
    return double(probe.nodes) * traversal_cost + double(references) * intersection_cost;
  });
  test.measured = estimate.mean;
  test.standard_error = estimate.standard_error;
  test.lines = estimate.samples;
  return test;
}

}  // namespace tracer
