// The nodes of wide layouts as the panels read them.
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/analyze/box_set.h"
#include "tracer/analyze/icicle.h"
#include "tracer/analyze/ray_log.h"
#include "tracer/analyze/ray_words.h"
#include "tracer/bvh/trace.h"
#include "tracer/choice.h"

namespace tracer::test {
namespace {

using testing::HasSubstr;

std::vector<std::string> wide_layouts() {
  std::vector<std::string> ids;
  for (const LayoutRow& layout : layouts())
    if (layout.width > 2) ids.emplace_back(layout.id);
  return ids;
}

class WideTable : public testing::TestWithParam<std::string> {
 protected:
  explicit WideTable(std::string builder = "binned") {
    BuildOptions options;
    options.layout = GetParam();
    options.builder = std::move(builder);
    Scene scene = scene_of({soup(3000, 0.2f), sphere(12)});
    for (int i = 0; i < 20; ++i) {
      scene.instances.push_back(scene.instances[i % 2]);
      scene.instances.back().transform[3] = {0.3f * float(i), 0.1f * float(i), 0, 1};
    }
    bvh = std::make_shared<const SceneBvh>(bvh_of(scene, options));
    inspection = std::make_shared<const Inspection>(inspect(bvh, nullptr, {}));
  }
  std::vector<std::pair<const TreeTable*, const Bvh*>> trees() const {
    return {{inspection->blases[0].get(), &bvh->blases[0]->tree},
            {inspection->blases[1].get(), &bvh->blases[1]->tree},
            {inspection->tlas.get(), &bvh->tlas}};
  }
  Ray ray(int i) const {
    Ray ray;
    ray.origin = vec3(-1.5f + 0.07f * float(i), 0.3f, 6.0f);
    ray.direction = vec3(1.2f, -0.2f, -6.0f) - 0.05f * float(i) * vec3(1, 0, 0);
    return ray;
  }

  std::shared_ptr<const SceneBvh> bvh;
  std::shared_ptr<const Inspection> inspection;
};

TEST_P(WideTable, IsATreeOverAllReferences) {
  const size_t width = find_row(layouts(), GetParam())->width;
  for (const auto& [table, tree] : trees()) {
    ASSERT_EQ(table->nodes.size(), tree->nodes.size());
    std::vector<uint32_t> seen, stack = {0};
    size_t most = 0, count = 0, inner = 0;
    uint32_t depth = 0;
    while (!stack.empty()) {
      const uint32_t node = stack.back();
      const TableNode& row = table->nodes[node];
      stack.pop_back();
      ++count;
      depth = std::max<uint32_t>(depth, row.depth);
      ASSERT_TRUE(row.in_layout);
      const auto children = children_of(*table, node);
      most = std::max(most, children.size());
      if (is_leaf(row)) {
        ASSERT_EQ(row.references, references_below(*tree, node));
        const auto first = table->references.begin() + row.first;
        seen.insert(seen.end(), first, first + row.references);
        continue;
      }
      ++inner;
      uint32_t references = 0;
      for (const uint32_t child : children) {
        ASSERT_EQ(table->nodes[child].parent, node);
        ASSERT_EQ(table->nodes[child].depth, row.depth + 1);
        ASSERT_TRUE(contains(table->nodes[child].box, box_of(tree->nodes[child])));
        references += table->nodes[child].references;
        stack.push_back(child);
      }
      ASSERT_EQ(row.references, references);
    }
    EXPECT_LE(most, width);
    EXPECT_GE(most, width - 1);
    EXPECT_GT(double(count - 1) / double(inner), 0.6 * double(width)) << "nodes are rather full";
    EXPECT_EQ(depth, table->depth);
    std::vector<uint32_t> all = tree->references;
    std::sort(all.begin(), all.end());
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(seen, all);
    EXPECT_EQ(count, node_count(*table));
    EXPECT_EQ(count, size_t(std::count_if(table->nodes.begin(), table->nodes.end(),
                                          [](const TableNode& row) { return row.in_layout; })));
  }
}

TEST_P(WideTable, TakesInTheNodesThatTheLayoutLacks) {
  for (const auto& [table, tree] : trees()) {
    size_t lacking = 0;
    for (uint32_t node = 0; node < table->nodes.size(); ++node) {
      const TableNode& row = table->nodes[node];
      if (row.in_layout) {
        EXPECT_EQ(holder(*table, node), node);
        continue;
      }
      ++lacking;
      EXPECT_FALSE(is_leaf(row));
      EXPECT_TRUE(children_of(*table, node).empty());
      EXPECT_EQ(own_sah(*table, node), 0.0);
      const TableNode& by = table->nodes[holder(*table, node)];
      EXPECT_TRUE(by.in_layout);
      EXPECT_TRUE(contains(by.box, row.box));
      EXPECT_EQ(row.depth, by.depth);
    }
    EXPECT_GT(lacking, table->nodes.size() / 4);
  }
}

TEST_P(WideTable, HasTheNodesThatRaysVisit) {
  Visits visits = no_visits(*bvh);
  for (int i = 0; i < 40; ++i) {
    VisitProbe probe(visits);
    trace<false>(*bvh, ray(i), probe);
  }
  const std::vector<uint32_t>* counts[] = {&visits.blases[0], &visits.blases[1], &visits.tlas};
  for (size_t tree = 0; tree < 3; ++tree) {
    const TreeTable& table = *trees()[tree].first;
    size_t entered = 0;
    for (uint32_t node = 0; node < table.nodes.size(); ++node) {
      if ((*counts[tree])[node] == 0) continue;
      ++entered;
      ASSERT_TRUE(table.nodes[node].in_layout) << node;
      if (node != 0) {
        ASSERT_GE((*counts[tree])[table.nodes[node].parent], (*counts[tree])[node]);
      }
    }
    EXPECT_GT(entered, 3u);
  }
}

TEST_P(WideTable, HasTheChildrenAndDepthsOfLoggedSteps) {
  size_t steps = 0, wide = 0;
  std::string words;
  for (int i = 0; i < 40; ++i) {
    const LoggedRay logged = log_ray(*bvh, {ray(i), RayClass::primary, 0, none, 0, {}});
    for (size_t at = 0; at < logged.steps.size(); ++at) {
      const Step& step = logged.steps[at];
      if (step.kind != StepKind::node && step.kind != StepKind::leaf) continue;
      const TreeTable& table = step.instance == none
                                   ? *inspection->tlas
                                   : *inspection->blases[bvh->instances[step.instance].mesh];
      ASSERT_EQ(step.depth, table.nodes[step.id].depth);
      ASSERT_EQ(step.kind == StepKind::leaf, is_leaf(table.nodes[step.id]));
      ++steps;
      words += explain(*bvh, logged, at) + "\n";
      const std::vector<TestedChild> tested = tested_children(logged, at);
      if (step.kind == StepKind::leaf || step.result != StepResult::entered) {
        ASSERT_TRUE(tested.empty());
        continue;
      }
      std::vector<uint32_t> nodes;
      int firsts = 0;
      for (const TestedChild& child : tested) {
        nodes.push_back(child.node);
        firsts += child.order == ChildOrder::first;
        ASSERT_NE(child.step, none) << "a primary ray looks at all that wait";
      }
      ASSERT_LE(firsts, 1);
      const auto children = children_of(table, step.id);
      ASSERT_EQ(nodes, std::vector<uint32_t>(children.begin(), children.end()));
      wide += nodes.size() > 2;
    }
  }
  EXPECT_GT(steps, 500u);
  EXPECT_GT(wide, 100u);
  EXPECT_THAT(words, HasSubstr(" are missed"));
  EXPECT_THAT(words, HasSubstr(" comes first, at t "));
  EXPECT_THAT(words, HasSubstr("It has "));
}

TEST_P(WideTable, OfASingleLeafHasTheLeafAlone) {
  BuildOptions options;
  options.layout = GetParam();
  const SceneBvh one = bvh_of(scene_of({sphere(12)}), options);
  EXPECT_TRUE(is_leaf(tree_table(one.tlas, true, 1.0f, 1.0f, one.wide_tlas).nodes[0]));
  Ray inwards;
  inwards.origin = vec3(0.1f, 0.2f, 5.0f);
  inwards.direction = vec3(0, 0, -1);
  const LoggedRay logged = log_ray(one, {inwards, RayClass::primary, 0, none, 0, {}});
  ASSERT_FALSE(logged.steps.empty());
  EXPECT_EQ(logged.steps[0].kind, StepKind::leaf);
  EXPECT_EQ(logged.steps[0].id, 0u);
  EXPECT_EQ(logged.steps[1].kind, StepKind::instance);
  Visits visits = no_visits(one);
  VisitProbe probe(visits);
  EXPECT_TRUE(is_hit(trace<false>(one, inwards, probe)));
  EXPECT_EQ(visits.tlas[0], 1u);
  EXPECT_EQ(visits.blases[0][0], 1u);
  EXPECT_THAT(explain(one, logged, 2), HasSubstr("does not test the root's box"));
}

TEST_P(WideTable, LeadsBoxesToTheNodesThatItHas) {
  const TreeTable& table = *inspection->blases[0];
  uint32_t lacking = 0;
  while (table.nodes[lacking].in_layout)
    ++lacking;
  BoxOptions options;
  options.show = true;
  options.what = "node";
  BoxSources sources;
  sources.inspection = inspection;
  sources.selected = NodePlace{0, lacking};
  const NodeBoxes boxes = node_boxes(bvh, options, sources);
  ASSERT_FALSE(boxes.boxes.empty());
  EXPECT_EQ(boxes.boxes[0].place, (NodePlace{0, holder(table, lacking)}));
  EXPECT_EQ(boxes.boxes[0].box, table.nodes[holder(table, lacking)].box);
  EXPECT_TRUE(is_of(boxes, bvh, options, sources)) << "as it was asked";
  options.what = "leaves";
  sources.isolated = sources.selected;
  EXPECT_GT(node_boxes(bvh, options, sources).found, 0u);
}

TEST_P(WideTable, IsWhatBoxesAndIcicleShow) {
  const TreeTable& table = *inspection->blases[0];
  BoxOptions options;
  options.show = true;
  options.what = "levels";
  options.tree = "blas";
  options.first_level = options.last_level = 1;
  BoxSources sources;
  sources.inspection = inspection;
  sources.instance = 0;
  const NodeBoxes level = node_boxes(bvh, options, sources);
  const size_t children = children_of(table, 0).size();
  const size_t of_sphere = children_of(*inspection->blases[1], 0).size();
  EXPECT_EQ(level.found, 11 * (children + of_sphere));
  options.what = "children";
  sources.selected = NodePlace{0, 0};
  EXPECT_EQ(node_boxes(bvh, options, sources).boxes.size(), 1 + children);

  IcicleOptions shown;
  shown.mesh = 0;
  const Icicle picture = make_icicle(inspection, {&table, {}, {}, {}}, shown, {});
  ASSERT_EQ(picture.levels.size(), table.depth + 1);
  EXPECT_EQ(picture.levels[1].nodes.size(), children);
  for (uint32_t node = 0; node < table.nodes.size(); ++node) {
    const auto place = icicle_place(picture, node);
    ASSERT_TRUE(place);
    ASSERT_EQ(picture.levels[table.nodes[node].depth].nodes[*place], holder(table, node));
  }
}

INSTANTIATE_TEST_SUITE_P(Layouts, WideTable, testing::ValuesIn(wide_layouts()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace tracer::test
