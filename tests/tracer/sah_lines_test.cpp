#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/analyze/random_lines.h"
#include "tracer/analyze/sah_test.h"

namespace tracer::test {
namespace {

Bvh tree_of(const Mesh& mesh, const BuildOptions& options) {
  return bvh_of(scene_of({mesh}), options).blases[0]->tree;
}

TEST(RandomLine, BeginsOnTheBoxAndGoesThroughIt) {
  const Box box{{-1, 2, 3}, {4, 5, 3.5f}};
  Rng rng = make_rng(1);
  for (int i = 0; i < 1000; ++i) {
    const Ray line = random_line(box, i / 1000.0, rng);
    ASSERT_TRUE(contains(box, Box{line.origin, line.origin}));
    ASSERT_NEAR(glm::length(line.direction), 1.0f, 1e-5f);
    int faces = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const bool at_lo = line.origin[axis] == box.lo[axis] && line.direction[axis] >= 0.0f;
      const bool at_hi = line.origin[axis] == box.hi[axis] && line.direction[axis] <= 0.0f;
      faces += at_lo || at_hi ? 1 : 0;
    }
    ASSERT_GE(faces, 1);
  }
}

TEST(RandomLine, NoneOfABoxWithoutArea) {
  Rng rng = make_rng(1);
  EXPECT_EQ(random_line({vec3(1), vec3(1)}, 0.5, rng).direction, vec3(0.0f));
  EXPECT_EQ(random_line({vec3(1), {2, 1, 1}}, 0.5, rng).direction, vec3(0.0f));
  EXPECT_EQ(random_line({}, 0.5, rng).direction, vec3(0.0f));
}

TEST(SahTest, LinesCostWhatSahSaysForEveryBuilder) {
  for (const BuilderRow& builder : builders()) {
    for (const Mesh& mesh : {soup(3000, 0.1f), sphere(40), grid(30), soup(50, 3.0f)}) {
      BuildOptions options;
      options.builder = builder.id;
      const Bvh tree = tree_of(mesh, options);
      const SahTest test = sah_test(tree, 1.2f, 1.0f, sah_test_limits, {});
      EXPECT_GT(test.lines, 0u);
      EXPECT_LE(test.standard_error, 0.01 * test.sah);
      EXPECT_NEAR(test.measured, test.sah, 4.0 * test.standard_error + 0.002 * test.sah)
          << builder.id;
      EXPECT_TRUE(holds(test));
    }
  }
}

// There floats are a sixteenth apart: lines that begin at them are not as random as they should be.
TEST(SahTest, HoldsFarFromTheOrigin) {
  for (Mesh mesh : {sphere(40), soup(3000, 0.5f)}) {
    for (vec3& position : mesh.positions)
      position = position + 1e6f;
    BuildOptions options;
    const SahTest test = sah_test(tree_of(mesh, options), 1.2f, 1.0f, sah_test_limits, {});
    EXPECT_GT(test.lines, 0u);
    EXPECT_TRUE(holds(test)) << test.measured << " instead of " << test.sah;
  }
}

TEST(SahTest, SeesAWrongTree) {
  Bvh tree = tree_of(soup(1000, 0.1f), {});
  // A child that is larger than its parent is not met as often as its area says.
  tree.nodes[tree.nodes[1].first].lo -= 3.0f;
  tree.nodes[tree.nodes[1].first].hi += 3.0f;
  EXPECT_FALSE(holds(sah_test(tree, 1.2f, 1.0f, sah_test_limits, {})));
}

TEST(SahTest, NothingToMeasure) {
  EXPECT_TRUE(holds(sah_test({}, 1.0f, 1.0f, sah_test_limits, {})));
  const Bvh point{{{vec3(1), 0, vec3(1), 4}}, {0, 1, 2, 3}, 0};
  EXPECT_EQ(sah_test(point, 1.0f, 1.0f, sah_test_limits, {}).lines, 0u);
  EXPECT_TRUE(holds(sah_test(point, 1.0f, 1.0f, sah_test_limits, {})));
}

}  // namespace
}  // namespace tracer::test
