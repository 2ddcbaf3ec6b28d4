// Wide nodes that are broken in one way are found out by the rule for it.
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tracer/bvh/refit.h"
#include "tracer/choice.h"
#include "wide_patient.h"

namespace tracer::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

template <class Node>
class WideRules : public WidePatient<Node> {};
TYPED_TEST_SUITE(WideRules, AllNodes, NodeNames);

TYPED_TEST(WideRules, ASoundTreeHasNoFindings) {
  EXPECT_THAT(this->patient.broken(), IsEmpty());
  EXPECT_EQ(this->patient.validated().rays_checked, 200u);
  EXPECT_GT(this->wide.depth, 1u);
  EXPECT_GT(this->top.depth, 0u);
}

TYPED_TEST(WideRules, AnotherLayoutThanAskedFor) {
  this->patient.bvh.options.layout = "binary";
  EXPECT_THAT(this->expect_closed("wide_links").message, HasSubstr("binary has no wide nodes"));
}

TYPED_TEST(WideRules, NoWideTree) {
  this->blas.wide = {};
  const Finding finding = this->expect_closed("wide_links");
  EXPECT_EQ(finding.bvh, 0u);
  EXPECT_THAT(finding.message, HasSubstr("the tree has no wide nodes"));
}

TYPED_TEST(WideRules, NoWideTreeOnTop) {
  this->patient.bvh.wide_tlas = {};
  EXPECT_EQ(this->expect_closed("wide_links").bvh, none);
}

TYPED_TEST(WideRules, NoWideNodes) {
  this->wide.nodes.clear();
  EXPECT_EQ(this->expect_closed("wide_links").message, "there are no wide nodes");
}

TYPED_TEST(WideRules, LinksThatMakeACycle) {
  for (auto* nodes : {&this->wide, &this->top}) {
    const Place at = this->first_inner(*nodes);
    auto& child = nodes->nodes[at.node].child[at.slot];
    const WideChild was = std::exchange(child, at.node);
    const Finding finding = this->expect_closed("wide_links");
    EXPECT_EQ(finding.node, nodes->nodes[at.node].binary[at.slot]);
    EXPECT_THAT(finding.message, HasSubstr("must come after"));
    child = was;
  }
}

TYPED_TEST(WideRules, LinksOutOfTheArray) {
  const Place at = this->first_inner(this->wide);
  for (const WideChild child : {WideChild(this->wide.nodes.size()), leaf_bit - 1}) {
    this->wide.nodes[at.node].child[at.slot] = child;
    this->expect_closed("wide_links");
  }
}

TYPED_TEST(WideRules, ANodeWithTwoParents) {
  const Place at = this->first_inner(this->wide);
  const Place leaf = this->first_leaf(this->wide);
  ASSERT_LT(leaf.node, this->wide.nodes[at.node].child[at.slot]);
  this->wide.nodes[leaf.node].child[leaf.slot] = this->wide.nodes[at.node].child[at.slot];
  EXPECT_THAT(this->expect_closed("wide_links").message, HasSubstr("which is a child of"));
}

TYPED_TEST(WideRules, ANodeThatNothingLeadsTo) {
  this->wide.nodes.push_back(this->wide.nodes.back());
  const Finding finding = this->expect_closed("wide_links");
  EXPECT_EQ(finding.message,
            fmt::format("no slot leads to wide node {}", this->wide.nodes.size() - 1));
}

TYPED_TEST(WideRules, Depth) {
  ++this->wide.depth;
  EXPECT_THAT(this->expect_closed("wide_links").message, HasSubstr("the wide tree says"));
  this->wide.depth -= 2;
  this->expect_closed("wide_links");
}

// Only the rule is asked: no canonical tree goes with it.
TYPED_TEST(WideRules, DepthBeyondTheStack) {
  for (const uint32_t depth : {max_tree_depth, max_tree_depth + 1}) {
    WideNodes<TypeParam> chain;
    chain.nodes.resize(depth + 1);
    for (uint32_t i = 0; i <= depth; ++i) {
      for (int slot = 0; slot < TypeParam::width; ++slot)
        this->empty(chain.nodes[i], slot);
      chain.nodes[i].child[0] = i < depth ? i + 1 : leaf_bit;
      chain.nodes[i].binary[0] = i + 1;
    }
    chain.depth = depth;
    const WideTree wide = chain;
    const TreeToCheck check{this->tree, {}, this->patient.bvh.options, nullptr, nullptr, 0, &wide};
    FindingList list("wide_links", Severity::error, check);
    check_wide_links(check, list);
    EXPECT_EQ(list.take().size(), depth - max_tree_depth);
  }
}

TYPED_TEST(WideRules, AnEmptySlotThatIsNotTheLast) {
  const Place at = this->first_leaf(this->wide);
  auto& node = this->wide.nodes[at.node];
  ASSERT_TRUE(at.slot + 1 < this->W && node.child[at.slot + 1] != no_child);
  this->empty(node, at.slot);
  const Finding finding = this->expect_closed("wide_links");
  EXPECT_THAT(finding.message, HasSubstr("comes after an empty one"));
  EXPECT_EQ(finding.node, node.binary[at.slot + 1]);
}

TYPED_TEST(WideRules, AnEmptySlotThatRaysMayHit) {
  auto& node = this->single.nodes[0];
  this->copy_box(node, 1, node, 0);
  EXPECT_THAT(this->expect_closed("wide_links").message, HasSubstr("but rays may hit it"));
}

TYPED_TEST(WideRules, AnEmptySlotThatStandsForSomething) {
  this->single.nodes[0].binary[2] = 0;
  const Finding finding = this->expect_closed("wide_links");
  EXPECT_EQ(finding.bvh, 1u);
  EXPECT_EQ(finding.node, 0u);
  EXPECT_THAT(finding.message, HasSubstr("is empty, but stands for it"));
}

TYPED_TEST(WideRules, ASlotForNoNode) {
  const Place at = this->first_leaf(this->wide, 1);
  for (const uint32_t binary : {uint32_t(this->tree.nodes.size()), none}) {
    this->wide.nodes[at.node].binary[at.slot] = binary;
    const Finding finding = this->expect_closed("wide_subtrees");
    EXPECT_NE(finding.node, none);
    EXPECT_THAT(finding.message, HasSubstr(fmt::format("stands for node {} of", binary)));
  }
}

TYPED_TEST(WideRules, AWideNodeForNoNode) {
  const Place at = this->first_inner(this->wide);
  this->wide.nodes[at.node].binary[at.slot] = 1000000;
  this->expect_closed("wide_subtrees");
}

TYPED_TEST(WideRules, ASlotForTheNodeItself) {
  this->wide.nodes[0].binary[0] = 0;
  const Finding finding = this->expect_closed("wide_subtrees");
  EXPECT_EQ(finding.node, 0u);
  EXPECT_THAT(finding.message, HasSubstr("it is not below node 0"));
}

TYPED_TEST(WideRules, ASlotForANodeElsewhere) {
  const Place inner = this->first_inner(this->wide);
  auto& root = this->wide.nodes[inner.node];
  auto& below = this->wide.nodes[root.child[inner.slot]];
  const uint32_t elsewhere = root.binary[inner.slot == 0 ? 1 : 0];
  below.binary[0] = elsewhere;
  const Finding finding = this->expect_closed("wide_subtrees");
  EXPECT_EQ(finding.node, elsewhere);
  EXPECT_THAT(finding.message, HasSubstr("it is not below node"));
}

TYPED_TEST(WideRules, TwoSlotsForOneNode) {
  auto& root = this->wide.nodes[0];
  const uint32_t right = std::exchange(root.binary[1], root.binary[0]);
  EXPECT_THAT(this->expect_closed("wide_subtrees").message, HasSubstr("and so does slot 0"));
  root.binary[1] = right;
  auto& top = this->top.nodes[0];
  top.binary[0] = top.binary[1];
  EXPECT_EQ(this->patient.validated().findings[0].bvh, none);
}

TYPED_TEST(WideRules, ASlotBelowAnother) {
  auto& root = this->wide.nodes[0];
  const BvhNode& node = this->tree.nodes[root.binary[0]];
  ASSERT_FALSE(is_leaf(node));
  root.binary[1] = node.first;
  const Finding finding = this->expect_closed("wide_subtrees");
  EXPECT_EQ(finding.node, node.first);
  EXPECT_THAT(finding.message, HasSubstr("and another slot for node"));
}

TYPED_TEST(WideRules, ASlotThatIsMissing) {
  for (auto* nodes : {&this->wide, &this->top}) {
    const Place at = this->find(*nodes, [&](const TypeParam& node, int slot) {
      const bool is_last = slot + 1 == this->W || node.child[slot + 1] == no_child;
      return is_last && slot > 0 && this->is_filled_leaf(node, slot);
    });
    const TypeParam was = nodes->nodes[at.node];
    this->empty(nodes->nodes[at.node], at.slot);
    const Finding finding = this->expect_closed("wide_subtrees");
    EXPECT_EQ(finding.bvh, nodes == &this->top ? none : 0u);
    EXPECT_THAT(finding.message, HasSubstr("is below no slot"));
    nodes->nodes[at.node] = was;
  }
}

TYPED_TEST(WideRules, AWideNodeOfNothing) {
  auto& last = this->wide.nodes.back();
  for (int slot = 0; slot < this->W; ++slot)
    this->empty(last, slot);
  this->expect_closed("wide_subtrees");
}

TYPED_TEST(WideRules, ARootOverASingleLeaf) {
  ASSERT_EQ(this->single.nodes[0].binary[0], 0u);
  EXPECT_THAT(this->patient.broken(), IsEmpty());
  this->empty(this->single.nodes[0], 0);
  const Finding finding = this->expect_closed("wide_subtrees");
  EXPECT_EQ(finding.bvh, 1u);
  EXPECT_EQ(finding.node, 0u);
}

// The planes of a slot, moved inwards on one side.
template <int W>
void shrink(WideNode<W>& node, int slot, int plane) {
  float& at = node.planes[plane][slot];
  at = std::nextafter(at, plane % 2 == 0 ? infinity : -infinity);
}
void shrink(QuantisedNode& node, int slot, int plane) {
  node.planes[plane][slot] =
      uint8_t(plane % 2 == 0 ? node.planes[plane][slot] + 1 : node.planes[plane][slot] - 1);
}

TYPED_TEST(WideRules, ABoxThatIsTooSmallOnAnySide) {
  for (auto* nodes : {&this->wide, &this->top}) {
    for (int plane = 0; plane < 6; ++plane) {
      auto& node = nodes->nodes[0];
      const TypeParam was = node;
      shrink(node, 1, plane);
      const Finding finding = this->expect_found("wide_boxes");
      EXPECT_EQ(finding.node, node.binary[1]);
      EXPECT_EQ(finding.bvh, nodes == &this->top ? none : 0u);
      EXPECT_THAT(finding.message,
                  HasSubstr(fmt::format("slot 1 of wide node 0 has {} {} at",
                                        plane % 2 == 0 ? "lo" : "hi", "xyz"[plane / 2])));
      node = was;
    }
  }
}

TYPED_TEST(WideRules, ABoxThatIsTooLarge) {
  const Place at = this->first_inner(this->wide);
  auto& node = this->wide.nodes[at.node];
  if constexpr (requires { node.slots; }) {
    node.planes[1][at.slot] = 255;
    node.planes[2][at.slot] = 0;
    EXPECT_THAT(this->patient.broken(), IsEmpty());  // it may be
  } else {
    node.planes[1][at.slot] += 0.5f;
    EXPECT_EQ(this->expect_found("wide_boxes").node, node.binary[at.slot]);
    EXPECT_THAT(this->patient.broken(), ElementsAre("wide_boxes"));  // and hides nothing
  }
}

TYPED_TEST(WideRules, ABoxThatIsNoNumber) {
  auto& node = this->wide.nodes[0];
  if constexpr (requires { node.slots; }) {
    node.origin[2] = NAN;
  } else {
    node.planes[4][0] = NAN;
  }
  EXPECT_THAT(this->patient.broken(), Contains("wide_boxes"));
}

TEST(WideRulesQuantised, AnOriginOrStepThatIsWrong) {
  for (int axis = 0; axis < 3; ++axis) {
    Patient origin(sick_scene(), options_of<QuantisedNode>());
    std::get<Quantised8>(origin.blas().wide).nodes[0].origin[axis] += 0.1f;
    EXPECT_THAT(origin.broken(), Contains("wide_boxes"));
    Patient step(sick_scene(), options_of<QuantisedNode>());
    --std::get<Quantised8>(step.blas().wide).nodes[0].exponent[axis];
    EXPECT_THAT(step.broken(), Contains("wide_boxes"));
  }
}

TEST(WideRulesQuantised, ASlotThatIsMarkedAsEmpty) {
  Patient patient(sick_scene(), options_of<QuantisedNode>());
  auto& node = std::get<Quantised8>(patient.blas().wide).nodes[0];
  node.slots &= uint8_t(~2u);
  const Validation result = patient.validated();
  ASSERT_FALSE(result.findings.empty());
  EXPECT_EQ(result.findings[0].rule, "wide_boxes");
  EXPECT_EQ(result.findings[0].node, node.binary[1]);
  EXPECT_THAT(result.findings[0].message, HasSubstr("is marked as empty"));
}

// The trees before the refit, as if it had forgotten them.
TYPED_TEST(WideRules, ARefitThatLeftOutTheWideTree) {
  Scene& scene = this->patient.scene;
  for (vec3& position : scene.meshes[0].positions)
    position = position * vec3(1.5f, 0.5f, 1.0f);
  const WideTree before = this->blas.wide;
  std::vector<std::shared_ptr<const Blas>> blases = this->patient.bvh.blases;
  const auto moved = std::make_shared<Blas>(*refitted(this->blas, scene.meshes[0]));
  blases[0] = moved;
  this->patient.bvh = place_instances(scene, blases, this->patient.bvh.options, 0.0f);
  EXPECT_THAT(this->patient.broken(), IsEmpty());
  moved->wide = before;
  EXPECT_THAT(this->patient.broken(),
              testing::IsSupersetOf({"wide_boxes", "wide_triangles", "hits"}));
}

TYPED_TEST(WideRules, TheCanonicalTreeIsCheckedAllTheSame) {
  this->wide.nodes.clear();
  this->tree.nodes[this->tree.nodes.size() - 1].hi.z += 0.5f;
  EXPECT_THAT(this->patient.broken(), testing::IsSupersetOf({"inside_parent", "wide_links"}));
}

TEST(WideRulesRows, AreAmongTheRulesOfTrees) {
  for (const TreeRule& rule : wide_rules) {
    const TreeRule* row = find_row(tree_rules(), rule.id);
    ASSERT_NE(row, nullptr) << rule.id;
    EXPECT_EQ(row->check, rule.check);
  }
}

}  // namespace
}  // namespace tracer::test
