#include "tracer/analyze/validate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "patient.h"
#include "tracer/analyze/validate_report.h"

namespace tracer::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

uint32_t first_leaf(const Bvh& tree) {
  uint32_t i = 0;
  while (!is_leaf(tree.nodes[i]))
    ++i;
  return i;
}

TEST(Validate, SoundScenesHaveNoFindings) {
  for (const BuilderRow& builder : builders()) {
    BuildOptions options;
    options.builder = builder.id;
    for (const Scene& scene : {scene_of({soup(200, 0.2f), sphere(12)}), scene_of({grid(10)}),
                               scene_of({soup(1, 1.0f)}), scene_of({soup(300, 3.0f)})}) {
      const Validation result = Patient(scene, options).validated(2000);
      EXPECT_THAT(result.findings, IsEmpty())
          << builder.id << ": " << result.findings[0].rule << ' ' << result.findings[0].message;
      EXPECT_EQ(result.rays_checked, 2000u);
      EXPECT_EQ(result.mismatches, 0u);
      EXPECT_EQ(result.trees_checked, scene.meshes.size() + 1);
    }
  }
}

TEST(Validate, LinksThatMakeACycle) {
  Patient patient;
  patient.blas().tree.nodes[1] = {vec3(0), 0, vec3(1), 0};
  const Validation result = patient.validated();
  EXPECT_THAT(patient.broken(), Contains("links"));
  EXPECT_EQ(result.rays_checked, 0u);
  EXPECT_EQ(result.findings[0].bvh, 0u);
  EXPECT_EQ(result.findings[0].node, 1u);
}

TEST(Validate, LinksOutOfTheArray) {
  for (const uint32_t first : {1000000u, 0xfffffffeu, 0xffffffffu}) {
    Patient patient;
    patient.blas().tree.nodes[0].first = first;
    EXPECT_THAT(patient.broken(), Contains("links"));
  }
}

TEST(Validate, AChildWithTwoParents) {
  Patient patient;
  std::vector<uint32_t> inner;
  Bvh& tree = patient.blas().tree;
  for (uint32_t i = 0; inner.size() < 3; ++i) {
    if (!is_leaf(tree.nodes[i])) inner.push_back(i);
  }
  tree.nodes[inner[1]].first = tree.nodes[inner[2]].first;
  EXPECT_THAT(patient.broken(), Contains("links"));
}

TEST(Validate, NoNodes) {
  Patient patient;
  patient.blas().tree.nodes.clear();
  EXPECT_THAT(patient.broken(), Contains("links"));
  Patient top;
  top.bvh.tlas.nodes.clear();
  EXPECT_THAT(top.broken(), Contains("links"));
}

TEST(Validate, LeafRanges) {
  Patient beyond;
  Bvh& tree = beyond.blas().tree;
  tree.nodes[first_leaf(tree)].first = uint32_t(tree.references.size());
  EXPECT_THAT(beyond.broken(), Contains("leaf_ranges"));

  Patient shared;
  Bvh& other = shared.blas().tree;
  const uint32_t leaf = first_leaf(other);
  other.nodes[leaf].first = other.nodes[leaf].first == 0 ? 1 : 0;
  EXPECT_THAT(shared.broken(), Contains("leaf_ranges"));
}

TEST(Validate, AReferenceToNothing) {
  Patient patient;
  patient.blas().tree.references[3] = 200;
  EXPECT_THAT(patient.broken(), testing::ElementsAre("references"));
  Patient top;
  top.bvh.tlas.references[0] = 2;
  EXPECT_THAT(top.broken(), testing::ElementsAre("references"));
}

TEST(Validate, AMissingTriangle) {
  Patient patient;
  Blas& blas = patient.blas();
  const uint32_t missing = blas.tree.references[0];
  blas.tree.references[0] = blas.tree.references[1];
  blas.triangles[0] = blas.triangles[1];
  EXPECT_THAT(patient.broken(), Contains("complete"));
  const Validation result = patient.validated();
  EXPECT_TRUE(
      std::any_of(result.findings.begin(), result.findings.end(), [&](const Finding& finding) {
        return finding.rule == "complete" && finding.triangle == missing;
      }));
}

TEST(Validate, Depth) {
  Patient patient;
  ++patient.blas().tree.depth;
  EXPECT_THAT(patient.broken(), testing::ElementsAre("depth"));
}

TEST(Validate, CopiesOfTriangles) {
  Patient patient;
  patient.blas().triangles[5].y[2] += 0.1f;
  EXPECT_THAT(patient.broken(), testing::ElementsAre("leaf_triangles"));
  Patient shorter;
  shorter.blas().triangles.pop_back();
  EXPECT_THAT(shorter.broken(), testing::ElementsAre("leaf_triangles"));
}

TEST(Validate, FiniteBoxes) {
  for (const float value : {NAN, infinity, 1e30f}) {
    Patient patient;
    Bvh& tree = patient.blas().tree;
    tree.nodes[first_leaf(tree)].lo.y = value;  // the last one is above hi
    EXPECT_THAT(patient.broken(), Contains("finite")) << value;
  }
}

TEST(Validate, ChildrenInsideParents) {
  Patient patient;
  Bvh& tree = patient.blas().tree;
  tree.nodes[first_leaf(tree)].hi.z += 0.5f;
  const Validation result = patient.validated();
  EXPECT_THAT(patient.broken(), Contains("inside_parent"));
  EXPECT_EQ(result.mismatches, 0u);  // a box that is too large hides nothing
}

TEST(Validate, ALeafThatIsTooSmall) {
  Patient patient;
  Bvh& tree = patient.blas().tree;
  for (BvhNode& node : tree.nodes) {
    if (is_leaf(node)) node.hi.x = 0.5f * (node.lo.x + node.hi.x);
  }
  EXPECT_THAT(patient.broken(), Contains("leaf_box"));
  const Validation result = patient.validated(2000);
  EXPECT_THAT(patient.broken(), Contains("hits"));
  EXPECT_GT(result.mismatches, 20u);
  const Finding& told = result.findings[result.findings.size() - 2];
  EXPECT_EQ(told.rule, "hits");
  EXPECT_NE(told.node, none);
  EXPECT_NE(told.triangle, none);
  EXPECT_THAT(result.findings.back().message, HasSubstr("more"));
}

// One triangle with legs of length 2 in two leaves, cut at x = 1; moved apart by `gap`.
Patient split_triangle(float gap) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 0, 2}};
  mesh.triangles = {{0, 1, 2}};
  Patient patient(scene_of({mesh}));
  Blas& blas = patient.blas();
  blas.tree = {{{vec3(0), 1, {2, 0, 2}, 0},
                {vec3(0), 0, {1 - gap, 0, 2}, 1},
                {{1 + gap, 0, 0}, 1, {2, 0, 1}, 1}},
               {0, 0},
               1};
  blas.triangles.insert(blas.triangles.begin(), blas.triangles[0]);
  return patient;
}

TEST(Validate, ASplitTriangle) {
  EXPECT_THAT(split_triangle(0.0f).broken(), IsEmpty());
  EXPECT_THAT(split_triangle(1e-7f).broken(), IsEmpty());
  EXPECT_THAT(split_triangle(0.1f).broken(), Contains("covered"));
}

TEST(Validate, ASplitTriangleThatIsElsewhere) {
  Patient patient = split_triangle(0.0f);
  Bvh& tree = patient.blas().tree;
  tree.nodes[1].hi.x = 2.0f;
  tree.nodes[2].lo = {1.5f, 0.0f, 1.5f};  // beyond the long side
  tree.nodes[2].hi = {2.0f, 0.0f, 2.0f};
  EXPECT_THAT(patient.broken(), testing::ElementsAre("idle_reference"));
  EXPECT_FALSE(has_errors(patient.validated()));
}

TEST(Validate, WarningsAreNoErrors) {
  Patient patient;
  patient.bvh.options.max_leaf_size = 1;
  EXPECT_THAT(patient.broken(), testing::ElementsAre("leaf_size"));
  EXPECT_FALSE(has_errors(patient.validated()));

  // A node that nobody needs moves the pair. That is an error by itself: the rule alone is asked.
  const BvhNode leaf{vec3(0), 0, vec3(1), 1};
  const Bvh tree = {{{vec3(0), 2, vec3(1), 0}, leaf, leaf, leaf}, {0}, 1};
  const BuildOptions options;
  const TreeToCheck check{tree, {}, options};
  for (const TreeRule& rule : tree_rules()) {
    if (rule.id != "siblings") continue;
    FindingList list(rule.id, rule.severity, check);
    rule.check(check, list);
    EXPECT_EQ(list.take().size(), 1u);
  }
}

TEST(Validate, SahThatLinesDoNotMeet) {
  Patient patient;
  Bvh& tree = patient.blas().tree;
  for (const uint32_t child : {1u, 2u}) {
    tree.nodes[child].lo -= 5.0f;
    tree.nodes[child].hi += 5.0f;
  }
  EXPECT_THAT(patient.broken(), Contains("sah"));
}

TEST(Validate, Instances) {
  Patient patient;
  patient.bvh.instances[1].mesh = 7;
  EXPECT_THAT(patient.broken(), testing::ElementsAre("instances"));
  Patient inverse;
  inverse.bvh.instances[0].to_object[1][1] = 2.0f;
  EXPECT_THAT(inverse.broken(), Contains("instances"));
}

TEST(Validate, AnInstanceThatMovedAway) {
  Patient patient;
  patient.bvh.instances[0].to_world[3].x = 3.0f;
  patient.bvh.instances[0].to_object[3].x = -3.0f;
  const Validation result = patient.validated(2000);
  EXPECT_THAT(patient.broken(), testing::IsSupersetOf({"leaf_box", "hits"}));
  EXPECT_EQ(result.findings[0].bvh, none);
  EXPECT_THAT(result.findings[0].message, HasSubstr("instance 0"));
}

TEST(Validate, ManyFindingsAreCounted) {
  Patient patient;
  for (LeafTriangle& copy : patient.blas().triangles)
    copy.x[0] += 1.0f;
  const Validation result = patient.validated();
  EXPECT_EQ(result.findings.size(), max_findings + 1);
  EXPECT_EQ(result.findings.back().message, "and 180 more");
}

TEST(Validate, SameForAnyNumberOfThreads) {
  Patient patient;
  for (BvhNode& node : patient.blas().tree.nodes)
    node.hi.x = std::max(node.lo.x, node.hi.x - 0.05f);
  std::vector<std::string> first;
  for (const size_t threads : {1, 2, 5}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    std::vector<std::string> messages;
    for (const Finding& finding : patient.validated(1000).findings)
      messages.push_back(finding.message);
    if (threads == 1) first = messages;
    EXPECT_EQ(messages, first);
  }
}

TEST(Validate, AStopEndsItAndProgressRises) {
  std::stop_source stop;
  float last = -1.0f;
  const Job job{stop.get_token(), [&](float fraction, std::string_view) {
                  EXPECT_GE(fraction, last);
                  last = fraction;
                  if (fraction > 0.5f) stop.request_stop();
                }};
  const Patient patient;
  const Validation result = validate(patient.scene, patient.bvh, 100000, job);
  EXPECT_GT(result.rays_checked, 0u);
  EXPECT_LT(result.rays_checked, 100000u);
}

TEST(Validate, JsonAndText) {
  Patient patient;
  ++patient.blas(1).tree.depth;
  Snapshot snapshot;
  snapshot.scene = std::make_shared<Scene>(patient.scene);
  snapshot.bvh = std::make_shared<SceneBvh>(patient.bvh);
  const Json json = validation_json(snapshot, patient.validated());
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["builder"], "binned");
  EXPECT_EQ(json["rays_checked"], 0);
  ASSERT_EQ(json["findings"].size(), 1u);
  const Json& finding = json["findings"][0];
  EXPECT_EQ(finding["rule"], "depth");
  EXPECT_EQ(finding["severity"], "error");
  EXPECT_EQ(finding["level"], "blas");
  EXPECT_EQ(finding["bvh"], 1);
  EXPECT_TRUE(finding["triangle"].is_null());
  const std::string text = validation_text(snapshot, patient.validated());
  EXPECT_THAT(text, HasSubstr("error: depth: mesh 1, node "));
  EXPECT_THAT(text, HasSubstr("no rays compared; errors 1, warnings 0\n"));
}

}  // namespace
}  // namespace tracer::test
