// What a validation says of where instances are entered.
#include "tracer/analyze/entry_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "patient.h"
#include "rebraided.h"

namespace tracer::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class EntryRules : public testing::TestWithParam<std::string> {
 protected:
  static BuildOptions options() {
    BuildOptions options;
    options.layout = GetParam();
    options.rebraid = true;
    return options;
  }
  // The wide tree says the same again.
  void widen_again() { bvh().wide_tlas = widen(bvh().tlas, {}, options(), bvh().entries); }
  SceneBvh& bvh() { return patient.bvh; }
  // A place whose instance is entered below its root.
  size_t part() {
    size_t place = 0;
    while (bvh().entries[place].node == 0)
      ++place;
    return place;
  }
  std::string message(std::string_view rule) {
    for (const Finding& finding : patient.validated().findings)
      if (finding.rule == rule) return finding.message;
    return "";
  }

  Patient patient{crowd(), options()};
};
INSTANTIATE_TEST_SUITE_P(Layouts, EntryRules,
                         testing::Values("binary", "wide4", "wide8", "quantised8"),
                         [](const auto& layout) { return layout.param; });

TEST_P(EntryRules, FindNothingInASoundTree) {
  const Validation result = patient.validated(2000);
  EXPECT_THAT(result.findings, IsEmpty())
      << result.findings[0].rule << ' ' << result.findings[0].message;
  EXPECT_EQ(result.mismatches, 0u);
}

TEST_P(EntryRules, ANodeThatTheTreeHasNot) {
  const size_t place = part();
  bvh().entries[place].node = 1000000;
  widen_again();
  EXPECT_THAT(patient.broken(), ElementsAre("entry_nodes"));
  EXPECT_THAT(message("entry_nodes"), HasSubstr("entered at node 1000000, which its tree has not"));
}

TEST_P(EntryRules, TooFewNodes) {
  bvh().entries.pop_back();
  EXPECT_THAT(patient.broken(), ElementsAre("entry_nodes"));
  EXPECT_THAT(message("entry_nodes"), HasSubstr("nodes to enter for"));
}

TEST_P(EntryRules, AnotherNodeInTheWideTree) {
  if (GetParam() == "binary") GTEST_SKIP() << "it has no wide tree";
  const size_t place = part();
  bvh().entries[place].child ^= 1;
  widen_again();
  EXPECT_THAT(message("entry_nodes"), HasSubstr("but at wide node"));
  bvh().entries[place] = {};
  EXPECT_THAT(message("entry_nodes"), HasSubstr("of the wide tree leads to node"));
}

TEST_P(EntryRules, APartThatIsMissing) {
  const size_t place = part();
  size_t other = place + 1;
  while (bvh().tlas.references[other] != bvh().tlas.references[place])
    ++other;
  bvh().entries[place] = bvh().entries[other];
  widen_again();
  EXPECT_THAT(patient.broken(), Contains("entry_parts"));
  EXPECT_THAT(message("entry_parts"), HasSubstr("is below no node where it is entered"));
}

TEST_P(EntryRules, APartThatIsThereTwice) {
  bvh().entries[part()] = {};
  widen_again();
  EXPECT_THAT(patient.broken(), Contains("entry_parts"));
  EXPECT_THAT(message("entry_parts"), HasSubstr("are below others"));
}

TEST_P(EntryRules, ALeafThatDoesNotHoldItsPart) {
  for (BvhNode& node : bvh().tlas.nodes) {
    if (!is_leaf(node) || bvh().entries[node.first].node == 0) continue;
    node.hi.x = glm::mix(node.lo.x, node.hi.x, 0.9f);
    break;
  }
  widen_again();
  EXPECT_THAT(patient.broken(), Contains("entry_boxes"));
}

}  // namespace
}  // namespace tracer::test
