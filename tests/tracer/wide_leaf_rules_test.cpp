// Leaves of wide trees that are broken in one way are found out by the rule for it.
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "wide_patient.h"

namespace tracer::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

template <class Node>
class WideLeafRules : public WidePatient<Node> {};
TYPED_TEST_SUITE(WideLeafRules, AllNodes, NodeNames);

TYPED_TEST(WideLeafRules, ALeafBeyondTheArray) {
  const Place at = this->first_leaf(this->wide);
  auto& child = this->wide.nodes[at.node].child[at.slot];
  for (const size_t first : {this->wide.blocks.size(), size_t(leaf_bit) - 2}) {
    child = WideChild(first) | leaf_bit;
    const Finding finding = this->expect_closed("wide_leaves");
    EXPECT_EQ(finding.node, this->wide.nodes[at.node].binary[at.slot]);
    EXPECT_THAT(finding.message, HasSubstr(fmt::format("blocks from {} on", first)));
  }
}

TYPED_TEST(WideLeafRules, EntriesBeyondTheArray) {
  const Place at = this->first_leaf(this->top);
  this->top.nodes[at.node].child[at.slot] = WideChild(this->top.entries.size()) | leaf_bit;
  const Finding finding = this->expect_closed("wide_leaves");
  EXPECT_EQ(finding.bvh, none);
  EXPECT_EQ(finding.triangle, none);
  EXPECT_THAT(finding.message, HasSubstr("entries from"));
}

TYPED_TEST(WideLeafRules, BlocksThatAreMissingAtTheEnd) {
  this->wide.blocks.pop_back();
  this->expect_closed("wide_leaves");
}

TYPED_TEST(WideLeafRules, ABlockInNoLeaf) {
  this->wide.blocks.push_back(this->wide.blocks.back());
  EXPECT_EQ(this->expect_closed("wide_leaves").message, "1 blocks are in no leaf");
}

TYPED_TEST(WideLeafRules, AnEntryInNoLeaf) {
  this->top.entries.push_back(this->top.entries.back());
  EXPECT_EQ(this->expect_closed("wide_leaves").message, "1 entries are in no leaf");
}

TYPED_TEST(WideLeafRules, AChainThatDoesNotEnd) {
  for (TriangleBlock& block : this->wide.blocks)
    block.triangle[0] |= more_bit;
  EXPECT_THAT(this->expect_closed("wide_leaves").message, HasSubstr("says that more follow"));
}

TYPED_TEST(WideLeafRules, AChainThatEndsTooSoon) {
  const Place at = this->leaf_over(block_size);
  this->wide.blocks[this->first_item(this->wide, at)].triangle[0] &= ~more_bit;
  const Finding finding = this->expect_closed("wide_leaves");
  EXPECT_EQ(finding.node, this->wide.nodes[at.node].binary[at.slot]);
  EXPECT_THAT(finding.message, HasSubstr("says that it is the last"));
}

TYPED_TEST(WideLeafRules, EntriesThatDoNotEndOrEndTooSoon) {
  const uint32_t first = this->first_item(this->top, this->entries_over(1));
  this->top.entries[first].instance ^= more_bit;
  EXPECT_THAT(this->expect_closed("wide_leaves").message, HasSubstr("says that it is the last"));
  this->top.entries[first].instance ^= more_bit;
  this->top.entries.back().instance ^= more_bit;
  EXPECT_THAT(this->expect_closed("wide_leaves").message, HasSubstr("says that more follow"));
}

TYPED_TEST(WideLeafRules, TwoLeavesOfTheSameBlocks) {
  const Place one = this->first_leaf(this->wide);
  const Place other = this->first_leaf(this->wide, one.node + 1);
  this->wide.nodes[other.node].child[other.slot] = this->wide.nodes[one.node].child[one.slot];
  EXPECT_THAT(this->expect_closed("wide_leaves").message, HasSubstr("which are of node"));
}

TYPED_TEST(WideLeafRules, LeavesThatChangedPlaces) {
  const Place one = this->leaf_of(3);
  const Place other = this->find(this->wide, [&](const TypeParam& node, int slot) {
    return this->is_filled_leaf(node, slot) && node.binary[slot] != 0 &&
           references_below(this->tree, node.binary[slot]) <= block_size &&
           node.binary[slot] != this->wide.nodes[one.node].binary[one.slot];
  });
  std::swap(this->wide.nodes[one.node].child[one.slot],
            this->wide.nodes[other.node].child[other.slot]);
  EXPECT_THAT(this->expect_closed("wide_leaves").message, HasSubstr("that are not below it"));
}

TYPED_TEST(WideLeafRules, AnotherTriangleInALeaf) {
  const Place at = this->leaf_of(block_size);
  const uint32_t first = this->first_item(this->wide, at);
  for (int lane = 0; lane < block_size; ++lane) {
    uint32_t& triangle = this->wide.blocks[first].triangle[lane];
    // Of the mesh, beyond it, a neighbour twice, with a bit that only the first lane may have.
    for (const uint32_t wrong :
         {triangle == 7 ? 8 : 7u, 501u, this->wide.blocks[first].triangle[(lane + 1) % block_size],
          lane == 0 ? triangle + 1 : triangle | more_bit}) {
      const uint32_t was = std::exchange(triangle, wrong);
      const Finding finding = this->expect_closed("wide_leaves");
      EXPECT_EQ(finding.node, this->wide.nodes[at.node].binary[at.slot]);
      triangle = was;
    }
  }
}

TYPED_TEST(WideLeafRules, ALeafMayHoldItsTrianglesInAnyOrder) {
  TriangleBlock& block = this->wide.blocks[this->first_item(this->wide, this->leaf_of(block_size))];
  std::swap(block.triangle[1], block.triangle[2]);
  for (auto& axis : block.corner) {
    for (auto& corner : axis)
      std::swap(corner[1], corner[2]);
  }
  EXPECT_THAT(this->patient.broken(), IsEmpty());
}

TYPED_TEST(WideLeafRules, LanesThatDoNotRepeatTheLast) {
  TriangleBlock& block = this->wide.blocks[this->first_item(this->wide, this->leaf_of(3))];
  block.triangle[3] = block.triangle[0] & ~more_bit;
  EXPECT_THAT(this->expect_closed("wide_leaves").message, HasSubstr("but then"));
}

TYPED_TEST(WideLeafRules, AnotherInstanceInALeaf) {
  const Place at = this->first_leaf(this->top);
  WideEntry& entry = this->top.entries[this->first_item(this->top, at)];
  const uint32_t more = entry.instance & more_bit;
  for (const uint32_t wrong : {(entry.instance & ~more_bit) == 9 ? 8u : 9u, 42u}) {
    entry.instance = wrong | more;
    const Finding finding = this->expect_closed("wide_leaves");
    EXPECT_EQ(finding.node, this->top.nodes[at.node].binary[at.slot]);
    EXPECT_EQ(finding.triangle, none);
  }
}

TYPED_TEST(WideLeafRules, CopiesOfTriangles) {
  const Place at = this->leaf_of(3);
  TriangleBlock& block = this->wide.blocks[this->first_item(this->wide, at)];
  for (int i = 0; i < 9 * block_size; ++i) {
    const int lane = i % block_size;
    float& coordinate = block.corner[i / block_size / 3][i / block_size % 3][lane];
    const float was = std::exchange(coordinate, std::nextafter(coordinate, 2.0f));
    const Finding finding = this->expect_found("wide_triangles");
    EXPECT_EQ(finding.node, this->wide.nodes[at.node].binary[at.slot]);
    EXPECT_EQ(finding.triangle, block.triangle[lane] & ~more_bit);
    EXPECT_THAT(finding.message, HasSubstr(fmt::format("lane {} of block", lane)));
    coordinate = was;
  }
}

TYPED_TEST(WideLeafRules, CopiesInTheLastBlockOfAChain) {
  const uint32_t first = this->first_item(this->wide, this->leaf_over(block_size));
  this->wide.blocks[first + 1].corner[0][0][0] += 1.0f;
  this->expect_found("wide_triangles");
}

}  // namespace
}  // namespace tracer::test
