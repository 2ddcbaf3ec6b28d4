// Widenings: what they cost, in SAH and bytes, and that they are the same for any number of
// threads.
#include <cstring>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "tracer/scene/scene.h"
#include "wide_layouts.h"

namespace tracer::test {
namespace {

// The wide SAH that the optimal widening minimises.
double cost_of(const WideTree& wide, const Bvh& tree) {
  const double root = half_area(box_of(tree.nodes[0]));
  double cost = 1.0;
  for (const AnySlot& slot : slots_of(wide)) {
    const double share = half_area(box_of(tree.nodes[slot.binary])) / root;
    const size_t references = references_below(tree, slot.binary);
    cost += is_leaf(slot.child) ? share * block_cost * double((references + 3) / 4) : share;
  }
  return cost;
}

TEST(Widening, TheOptimalOneIsNeverDearerThanTheGreedyOne) {
  for (const BuilderRow& builder : builders()) {
    BuildOptions options;
    options.builder = builder.id;
    const auto blas = build_blas(sphere(20, 1.0f, vec3(0.0f), 0.3f), options, nullptr, {});
    for (const std::string layout : {"wide4", "wide8"}) {
      options.layout = layout;
      options.widening = "greedy";
      const double greedy = cost_of(widen(blas->tree, blas->triangles, options), blas->tree);
      options.widening = "optimal";
      const double optimal = cost_of(widen(blas->tree, blas->triangles, options), blas->tree);
      EXPECT_LT(optimal, greedy) << builder.id << " " << layout;
    }
  }
}

TEST(Widening, EightWideNodesWithTheirTrianglesTakeLessThan80BytesATriangle) {
  BuildOptions options;
  options.layout = "wide8";
  const Scene scene = load_scene(parse_scene_source("teapots"), {});
  const auto blas = build_blas(scene.meshes[0], options, nullptr, {});
  EXPECT_LT(double(bytes(blas->wide)) / double(scene.meshes[0].triangles.size()), 80.0);
  options.layout = "quantised8";
  const WideTree quantised = widen(blas->tree, blas->triangles, options);
  EXPECT_LT(bytes(quantised), bytes(blas->wide));
}

// Bit for bit: nodes, blocks and entries.
template <class Item, class Allocator>
bool is_same(const std::vector<Item, Allocator>& a, const std::vector<Item, Allocator>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Item)) == 0;
}

// Large enough to be made in parts; many copies of one triangle, so that areas are the same.
TEST(Widening, IsTheSameForOneAndSeveralThreads) {
  Mesh copies = soup(3000, 0.2f);
  const std::vector<uvec3> once = copies.triangles;
  for (int i = 0; i < 3; ++i)
    copies.triangles.insert(copies.triangles.end(), once.begin(), once.end());
  copies.materials.resize(copies.triangles.size());
  for (const Mesh& mesh : {soup(60000, 0.01f), copies}) {
    BuildOptions options;
    options.max_leaf_size = 1;
    const auto blas = build_blas(mesh, options, nullptr, {});
    ASSERT_GT(blas->tree.nodes.size(), size_t{1} << 14);
    for (const LayoutRow& layout : layouts()) {
      for (const char* order : {"tree", "area"}) {
        for (const WideningRow& widening : widenings()) {
          SCOPED_TRACE(std::string(layout.id) + " " + order + " " + std::string(widening.id));
          options.layout = layout.id;
          options.widening = widening.id;
          options.occlusion_order = order;
          const auto of_threads = [&](int threads) {
            return tbb::task_arena(threads).execute(
                [&] { return widen(blas->tree, blas->triangles, options); });
          };
          const WideTree one = of_threads(1), several = of_threads(4);
          ASSERT_EQ(one.index(), several.index());
          std::visit(
              [&](const auto& a) {
                if constexpr (requires { a.nodes; }) {
                  const auto& b = std::get<std::decay_t<decltype(a)>>(several);
                  EXPECT_TRUE(is_same(a.nodes, b.nodes));
                  EXPECT_TRUE(is_same(a.blocks, b.blocks));
                  EXPECT_EQ(a.depth, b.depth);
                }
              },
              one);
        }
      }
    }
  }
}

}  // namespace
}  // namespace tracer::test
