// Wide trees as they are made keep the rules.
#include <gmock/gmock.h>

#include "wide_patient.h"

namespace tracer::test {
namespace {

using testing::IsEmpty;

std::vector<Finding> findings_in(const TreeToCheck& tree) {
  std::vector<Finding> all;
  for (const TreeRule& rule : wide_rules) {
    FindingList list(rule.id, rule.severity, tree);
    rule.check(tree, list);
    for (Finding& finding : list.take())
      all.push_back(std::move(finding));
    if (!all.empty()) break;
  }
  return all;
}

// The rules alone: they have no use for the boxes of the primitives.
void expect_sound(const Scene& scene, const BuildOptions& options) {
  const SceneBvh bvh = bvh_of(scene, options);
  std::vector<Finding> findings =
      findings_in({bvh.tlas, {}, options, nullptr, nullptr, none, &bvh.wide_tlas});
  for (uint32_t i = 0; i < bvh.blases.size(); ++i) {
    const Blas& blas = *bvh.blases[i];
    for (Finding& finding :
         findings_in({blas.tree, {}, options, &scene.meshes[i], &blas, i, &blas.wide}))
      findings.push_back(std::move(finding));
  }
  for (const Finding& finding : findings) {
    ADD_FAILURE() << options.builder << ' ' << options.layout << ' ' << options.widening << ": "
                  << finding.rule << ' ' << finding.message;
  }
}

template <class Check>
void for_each_layout(const Check& check) {
  for (const LayoutRow& layout : layouts()) {
    for (const WideningRow& widening : widenings()) {
      BuildOptions options;
      options.layout = layout.id;
      options.widening = widening.id;
      check(options);
    }
  }
}

TEST(WideRulesSound, EveryBuilderLayoutAndWidening) {
  Mesh copies = soup(1, 0.5f);
  copies.triangles.resize(300, copies.triangles[0]);
  Mesh far = grid(10);
  for (vec3& position : far.positions)
    position += vec3(1e6f, -3e5f, 0.1f);
  Mesh long_and_thin = soup(500, 0.1f);
  for (vec3& position : long_and_thin.positions)
    position *= vec3(1e-30f, 1.0f, 1e15f);
  const Scene scenes[] = {sick_scene(), scene_of({soup(2000, 0.1f), sphere(12), far}),
                          scene_of({copies, long_and_thin}),
                          scene_of({soup(300, 3.0f), sphere(6, 1e-20f)}),
                          load_scene(parse_scene_source("needles"), {})};
  for (const Scene& scene : scenes) {
    for (const BuilderRow& builder : builders()) {
      for_each_layout([&](BuildOptions options) {
        options.builder = builder.id;
        expect_sound(scene, options);
      });
    }
  }
}

TEST(WideRulesSound, SplitAndOptimisedTrees) {
  for_each_layout([](BuildOptions options) {
    options.presplit = true;
    options.split_budget = 2.0f;
    options.optimizer = "reinsertion";
    expect_sound(scene_of({soup(300, 3.0f), sphere(8)}), options);
  });
}

TEST(WideRulesSound, ValidationWithRays) {
  for_each_layout([](const BuildOptions& options) {
    const Validation result = Patient(sick_scene(), options).validated(2000);
    EXPECT_THAT(result.findings, IsEmpty()) << options.layout << options.widening;
    EXPECT_EQ(result.rays_checked, 2000u);
  });
}

TEST(WideRulesSound, AnEmptyScene) {
  for (const LayoutRow& layout : layouts()) {
    BuildOptions options;
    options.layout = layout.id;
    EXPECT_THAT(Patient(Scene(), options).broken(), IsEmpty());
  }
}

}  // namespace
}  // namespace tracer::test
