// LBVH: the tree is the one that the Morton codes say.
#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/bvh/build.h"
#include "tracer/bvh/morton.h"

namespace tracer::test {
namespace {

BuildOptions lbvh(bool collapse) {
  BuildOptions options;
  options.builder = "lbvh";
  options.collapse = collapse;
  return options;
}

void expect_split_by_codes(const Bvh& bvh, std::span<const MortonCode> codes, uint32_t node,
                           uint32_t begin) {
  const BvhNode& at = bvh.nodes[node];
  if (is_leaf(at)) {
    ASSERT_EQ(at.count, 1u);
    ASSERT_EQ(bvh.references[at.first], codes[begin].primitive);
    return;
  }
  const uint32_t middle = begin + references_below(bvh, at.first);
  const uint32_t end = middle + references_below(bvh, at.first + 1);
  ASSERT_EQ(middle, first_change(codes, begin, end)) << "node " << node;
  expect_split_by_codes(bvh, codes, at.first, begin);
  expect_split_by_codes(bvh, codes, at.first + 1, middle);
}

// With 20,000 triangles the tree is made in parts.
TEST(Lbvh, SplitsWhereTheHighestBitChanges) {
  for (const int count : {2, 3, 100, 20000}) {
    SCOPED_TRACE(count);
    const std::vector<Box> boxes = boxes_of(soup(count, 0.05f));
    const Bvh bvh = build({boxes}, lbvh(false), nullptr, {});
    ASSERT_EQ(references_below(bvh, 0), uint32_t(count));
    expect_split_by_codes(bvh, morton_order(boxes), 0, 0);
  }
}

TEST(Lbvh, EqualCodesMakeAShallowTree) {
  const std::vector<Box> boxes(10000, Box{vec3(1.0f), vec3(2.0f)});
  const Bvh bvh = build({boxes}, lbvh(false), nullptr, {});
  EXPECT_EQ(references_below(bvh, 0), 10000u);
  EXPECT_LE(bvh.depth, 15u);
}

// Distances that halve: each code differs from the next in a lower bit, and each node splits one
// off.
TEST(Lbvh, StaysWithinTheDepthLimit) {
  std::vector<Box> boxes;
  for (int i = 0; i < 21; ++i) {
    const vec3 at(std::ldexp(1.0f, -i), std::ldexp(1.0f, -i), std::ldexp(1.0f, -i));
    boxes.push_back({at, at});
  }
  BuildOptions options = lbvh(false);
  EXPECT_GT(build({boxes}, options, nullptr, {}).depth, 10u);
  options.max_depth = 7;
  const Bvh bvh = build({boxes}, options, nullptr, {});
  EXPECT_LE(bvh.depth, 7u);
  EXPECT_EQ(references_below(bvh, 0), 21u);
}

// Each node that could be a leaf at a lower cost is one.
TEST(Lbvh, CollapsesWhereALeafCostsLess) {
  const std::vector<Box> boxes = boxes_of(sphere(40));
  const BuildOptions options = lbvh(true);
  const Bvh bvh = build({boxes}, options, nullptr, {});
  const Bvh whole = build({boxes}, lbvh(false), nullptr, {});
  EXPECT_LT(bvh.nodes.size(), whole.nodes.size());
  for (uint32_t i = 0; i < bvh.nodes.size(); ++i) {
    const BvhNode& node = bvh.nodes[i];
    if (is_leaf(node)) {
      EXPECT_LE(node.count, options.max_leaf_size);
      continue;
    }
    const BvhNode &left = bvh.nodes[node.first], &right = bvh.nodes[node.first + 1];
    const uint32_t count = left.count + right.count;
    if (!is_leaf(left) || !is_leaf(right) || count > options.max_leaf_size) continue;
    const double area = half_area(box_of(node));
    const double children = left.count * double(half_area(box_of(left))) +
                            right.count * double(half_area(box_of(right)));
    EXPECT_GE(count * area * 1.000001, options.traversal_cost * area + children) << "node " << i;
  }
}

}  // namespace
}  // namespace tracer::test
