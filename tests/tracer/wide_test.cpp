// Wide layouts: the same tree, with boxes and triangles as they are now.
#include <set>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tracer/bvh/refit.h"
#include "wide_layouts.h"

namespace tracer::test {
namespace {

std::span<const TriangleBlock> blocks_of(const WideTree& tree) {
  return std::visit(
      [](const auto& wide) -> std::span<const TriangleBlock> {
        if constexpr (requires { wide.nodes; }) return wide.blocks;
        return {};
      },
      tree);
}

std::multiset<uint32_t> primitives_below(const Bvh& tree, uint32_t node) {
  std::multiset<uint32_t> all;
  for_references_below(tree, node, [&](uint32_t place) { all.insert(tree.references[place]); });
  return all;
}

std::multiset<uint32_t> triangles_in(std::span<const TriangleBlock> blocks, uint32_t first) {
  std::multiset<uint32_t> all;
  for (const TriangleBlock* block = &blocks[first];; ++block) {
    for (int lane = 0; lane < block_size; ++lane) {
      const uint32_t triangle = block->triangle[lane] & ~more_bit;
      if (lane == 0 || triangle != (block->triangle[lane - 1] & ~more_bit)) all.insert(triangle);
    }
    if ((block->triangle[0] & more_bit) == 0) return all;
  }
}

TEST_P(EveryWideLayout, HoldsEachReferenceWhereTheCanonicalTreeHasIt) {
  for (const Scene& scene : wide_scenes()) {
    const SceneBvh bvh = bvh_of(scene, options());
    for (const auto& blas : bvh.blases) {
      std::multiset<uint32_t> all;
      for (const AnySlot& slot : slots_of(blas->wide)) {
        if (!is_leaf(slot.child)) continue;
        const auto found = triangles_in(blocks_of(blas->wide), slot.child & ~leaf_bit);
        const auto wanted = primitives_below(blas->tree, slot.binary);
        // Lanes that repeat a triangle are not told from a leaf that holds it twice.
        EXPECT_EQ(std::set(found.begin(), found.end()), std::set(wanted.begin(), wanted.end()));
        all.insert(wanted.begin(), wanted.end());
      }
      EXPECT_EQ(all, primitives_below(blas->tree, 0));
    }
  }
}

TEST_P(EveryWideLayout, BoxesHoldThoseOfTheCanonicalTree) {
  for (const Scene& scene : wide_scenes()) {
    const SceneBvh bvh = bvh_of(scene, options());
    for (const auto& blas : bvh.blases) {
      for (const AnySlot& slot : slots_of(blas->wide)) {
        const Box exact = box_of(blas->tree.nodes[slot.binary]);
        ASSERT_TRUE(glm::all(glm::lessThanEqual(slot.box.lo, exact.lo)));
        ASSERT_TRUE(glm::all(glm::greaterThanEqual(slot.box.hi, exact.hi)));
        const vec3 room = box_of(blas->tree.nodes[0]).hi - box_of(blas->tree.nodes[0]).lo;
        ASSERT_TRUE(glm::all(glm::lessThanEqual(slot.box.hi - exact.hi, 0.02f * room + 1e-6f)));
      }
    }
  }
}

TEST_P(EveryWideLayout, RefitMovesBoxesAndTriangles) {
  const Mesh before = sphere(16);
  Mesh after = before;
  for (vec3& position : after.positions)
    position = position * vec3(1.5f, 0.5f, 1.0f) + vec3(0.1f, 0.0f, 0.2f * position.x);
  const auto built = build_blas(before, options(), nullptr, {});
  const auto moved = refitted(*built, after);
  const auto found = slots_of(moved->wide);
  for (const AnySlot& slot : found) {
    const Box exact = box_of(moved->tree.nodes[slot.binary]);
    ASSERT_TRUE(glm::all(glm::lessThanEqual(slot.box.lo, exact.lo)));
    ASSERT_TRUE(glm::all(glm::greaterThanEqual(slot.box.hi, exact.hi)));
    if (is_leaf(slot.child)) {
      const TriangleBlock& block = blocks_of(moved->wide)[slot.child & ~leaf_bit];
      const uvec3 corners = after.triangles[block.triangle[0] & ~more_bit];
      EXPECT_EQ(block.corner[1][2][0], after.positions[corners[2]].y);
    }
  }
  EXPECT_FALSE(found.empty());
  EXPECT_EQ(bytes(built->wide), bytes(moved->wide));
}

TEST_P(EveryWideLayout, IsTheSameForAnyNumberOfThreads) {
  const Mesh mesh = soup(20000, 0.05f);
  const auto once = build_blas(mesh, options(), nullptr, {});
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto again = build_blas(mesh, options(), nullptr, {});
  const auto a = slots_of(once->wide);
  const auto b = slots_of(again->wide);
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].binary, b[i].binary);
    ASSERT_EQ(a[i].child, b[i].child);
  }
}

}  // namespace
}  // namespace tracer::test
