// The boxes of slots, found by their binary nodes.
#include "tracer/bvh/wide_slot.h"

#include <map>

#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/analyze/box_set.h"

namespace tracer::test {
namespace {

std::shared_ptr<const SceneBvh> some_bvh(std::string layout) {
  BuildOptions options;
  options.layout = std::move(layout);
  std::vector<Mesh> meshes = {soup(700, 0.1f)};
  for (int i = 0; i < 40; ++i)
    meshes.push_back(sphere(3, 0.1f, vec3(i % 4, i % 5, i % 7)));
  return std::make_shared<const SceneBvh>(bvh_of(scene_of(meshes), options));
}

void expect_the_boxes_of_slots(const Bvh& tree, const WideTree& wide) {
  std::map<uint32_t, Box> boxes;
  for (const WideSlot& slot : slots(wide))
    boxes[slot.node] = slot.box;
  size_t larger = 0;
  for (uint32_t node = 0; node < tree.nodes.size(); ++node) {
    const Box own = box_of(tree.nodes[node]);
    const Box box = layout_box(tree, wide, node);
    const auto slot = boxes.find(node);
    EXPECT_EQ(box, slot == boxes.end() ? own : slot->second) << node;
    EXPECT_TRUE(contains(box, own)) << node;
    larger += box == own ? 0 : 1;
  }
  EXPECT_GT(boxes.size(), 30u);
  EXPECT_EQ(larger > boxes.size() / 2, std::holds_alternative<Quantised8>(wide));
}

TEST(LayoutBox, IsThatOfTheSlotOrTheNodesOwn) {
  for (const char* layout : {"wide4", "wide8", "quantised8"}) {
    SCOPED_TRACE(layout);
    const auto bvh = some_bvh(layout);
    expect_the_boxes_of_slots(bvh->blases[0]->tree, bvh->blases[0]->wide);
    expect_the_boxes_of_slots(bvh->tlas, bvh->wide_tlas);
  }
}

TEST(LayoutBox, OfTheBinaryLayoutAndOfASingleLeafIsTheNodesOwn) {
  const auto binary = some_bvh("binary");
  const Bvh& tree = binary->blases[0]->tree;
  EXPECT_EQ(layout_box(tree, binary->blases[0]->wide, 5), box_of(tree.nodes[5]));
  BuildOptions options;
  options.layout = "quantised8";
  const SceneBvh single = bvh_of(scene_of({soup(1, 0.5f)}), options);
  EXPECT_EQ(layout_box(single.tlas, single.wide_tlas, 0), box_of(single.tlas.nodes[0]));
}

TEST(LayoutBox, IsDrawnByTheBoxesOverlay) {
  const auto bvh = some_bvh("quantised8");
  for (const char* tree : {"blas", "tlas"}) {
    BoxOptions options;
    options.show = true;
    options.what = "leaves";
    options.tree = tree;
    const NodeBoxes boxes = node_boxes(bvh, options, {});
    EXPECT_GT(boxes.boxes.size(), 10u);
    for (const NodeBox& box : boxes.boxes) {
      const bool tlas = box.place.mesh == none;
      EXPECT_EQ(box.box, layout_box(tlas ? bvh->tlas : bvh->blases[box.place.mesh]->tree,
                                    tlas ? bvh->wide_tlas : bvh->blases[box.place.mesh]->wide,
                                    box.place.node));
    }
  }
}

}  // namespace
}  // namespace tracer::test
