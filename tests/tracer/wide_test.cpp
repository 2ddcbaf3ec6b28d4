// Wide layouts: the same tree, and the same hits from every kernel on every instruction set.
#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <set>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "make_scene.h"
#include "tracer/bvh/occlusion_order.h"
#include "tracer/bvh/ray_kernels.h"
#include "tracer/bvh/refit.h"
#include "tracer/bvh/trace.h"
#include "tracer/bvh/traverse.h"
#include "tracer/scene/scene.h"

namespace tracer::test {
namespace {

// What all layouts have in common.
struct AnySlot {
  uint32_t node = 0, binary = none;
  WideChild child = no_child;
  Box box;
};

template <int W>
Box box_in(const WideNode<W>& node, int slot) {
  const auto plane = [&](int i) { return node.planes[i][slot]; };
  return {{plane(0), plane(2), plane(4)}, {plane(1), plane(3), plane(5)}};
}

Box box_in(const QuantisedNode& node, int slot) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const float step = std::bit_cast<float>(uint32_t(node.exponent[axis]) << 23);
    box.lo[axis] = node.origin[axis] + float(node.planes[2 * axis][slot]) * step;
    box.hi[axis] = node.origin[axis] + float(node.planes[2 * axis + 1][slot]) * step;
  }
  return box;
}

template <class Node>
std::vector<AnySlot> slots_of(const WideNodes<Node>& wide) {
  std::vector<AnySlot> slots;
  for (uint32_t i = 0; i < wide.nodes.size(); ++i) {
    const Node& node = wide.nodes[i];
    for (int slot = 0; slot < Node::width && node.child[slot] != no_child; ++slot)
      slots.push_back({i, node.binary[slot], node.child[slot], box_in(node, slot)});
  }
  return slots;
}

std::vector<AnySlot> slots_of(const WideTree& tree) {
  return std::visit(
      [](const auto& wide) -> std::vector<AnySlot> {
        if constexpr (requires { wide.nodes; }) return slots_of(wide);
        return {};
      },
      tree);
}

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

std::vector<Scene> wide_scenes() {
  std::vector<Scene> scenes;
  scenes.push_back(scene_of({sphere(24)}));
  scenes.push_back(scene_of({soup(2000, 0.1f), sphere(6, 0.4f), grid(6)}));
  scenes.push_back(scene_of({soup(1, 0.5f)}));
  Mesh copies = soup(1, 0.5f);
  copies.triangles.resize(300, copies.triangles[0]);
  scenes.push_back(scene_of({copies}));
  scenes.push_back(load_scene(parse_scene_source("teapots"), {}));
  return scenes;
}

// In every layout that has one, by both widenings.
class EveryWideLayout : public testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  BuildOptions options() const {
    BuildOptions options;
    options.layout = std::get<0>(GetParam());
    options.widening = std::get<1>(GetParam());
    return options;
  }
};

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

// Of several kinds: coherent, random, along the axes, not valid.
std::vector<Ray> rays_through(const Box& box, int count) {
  std::mt19937 random(5);
  std::vector<Ray> rays;
  const vec3 eye = center(box) + 1.5f * glm::length(extent(box)) * random_direction(random);
  for (int i = 0; i < count; ++i) {
    Ray ray;
    const vec3 corner = box.lo + extent(box) * vec3(0.3f, float(i % 64) / 64, float(i / 64) / 16);
    switch (i / 64 % 4) {
      case 0:
        ray = {eye, 0.0f, corner - eye, infinity};
        break;
      case 1:
        ray.origin = random_point(random, box);
        ray.direction = random_direction(random);
        break;
      case 2:
        ray.origin = random_point(random, box) - vec3(0, 0, 2) * extent(box);
        ray.direction = vec3(0, 0, i % 3 == 0 ? 1.0f : 2.0f);
        ray.t_max = i % 5 == 0 ? 1.0f : infinity;
        break;
      default:
        ray = {corner, 0.0f, eye - corner, 1.0f};  // to a light
        if (i % 13 == 0) ray.direction = vec3(0.0f);
        if (i % 17 == 0) ray.origin.x = NAN;
    }
    rays.push_back(ray);
  }
  return rays;
}

// A leaf of split references may hold a triangle twice, the second time before others.
std::vector<SceneBvh> bvhs_of(const Scene& scene, BuildOptions options) {
  std::vector<SceneBvh> all = {bvh_of(scene, options)};
  options.presplit = true;
  options.split_budget = 2.0f;
  options.builder = "ploc";
  all.push_back(bvh_of(scene, options));
  return all;
}

void expect_the_binary_hits(const SceneBvh& bvh) {
  const std::vector<Ray> rays = rays_through(bounds(bvh), 4099);
  std::vector<Hit> expected;
  size_t hit_count = 0;
  NoProbe probe;
  for (const Ray& ray : rays) {
    expected.push_back(intersect(bvh, ray, probe));
    hit_count += is_hit(expected.back()) ? 1 : 0;
  }
  EXPECT_GT(hit_count, size_t{20});
  for (const IsaRow& isa : isas()) {
    for (const KernelRow& kernel : ray_kernels()) {
      const RayKernel run = ray_kernel(bvh.options.layout, kernel.id, isa.id);
      std::vector<Hit> hits(rays.size());
      std::vector<uint8_t> blocked(rays.size());
      run.intersect(bvh, rays, hits);
      run.occluded(bvh, rays, blocked);
      for (size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(hits[i], expected[i]) << isa.id << " " << kernel.id << " ray " << i;
        ASSERT_EQ(blocked[i], is_hit(expected[i])) << isa.id << " " << kernel.id << " ray " << i;
      }
    }
  }
}

TEST_P(EveryWideLayout, EveryKernelHitsWhatTheBinaryTreeDoes) {
  for (const Scene& scene : wide_scenes()) {
    for (const SceneBvh& bvh : bvhs_of(scene, options()))
      expect_the_binary_hits(bvh);
  }
}

std::vector<std::tuple<std::string, std::string>> wide_choices() {
  std::vector<std::tuple<std::string, std::string>> choices;
  for (const LayoutRow& layout : layouts()) {
    for (const WideningRow& widening : widenings()) {
      if (layout.width > 2) choices.emplace_back(layout.id, widening.id);
    }
  }
  return choices;
}

INSTANTIATE_TEST_SUITE_P(Wide, EveryWideLayout, testing::ValuesIn(wide_choices()),
                         [](const auto& info) {
                           return std::get<0>(info.param) + "_" + std::get<1>(info.param);
                         });

// Large triangles in one plane, as walls overlap in a building: which of them is the nearest is a
// matter of rounding, and must not be one of the order of traversal.
Scene walls() {
  std::mt19937 random(11);
  Mesh mesh;
  for (uint32_t i = 0; i < 3 * 400; ++i) {
    mesh.positions.push_back(random_point(random, {vec3(31, 7.3f, -32), vec3(49, 7.3f, -14)}));
    if (i % 3 == 2) mesh.triangles.push_back({i - 2, i - 1, i});
  }
  return scene_of({mesh});
}

TEST(Hits, OfCoincidentTrianglesDoNotDependOnTheTree) {
  const Scene scene = walls();
  BuildOptions options;
  const SceneBvh binned = bvh_of(scene, options);
  options.builder = "lbvh";
  options.layout = "wide8";
  const SceneBvh wide = bvh_of(scene, options);
  options.builder = "sbvh";
  const SceneBvh split = bvh_of(scene, options);
  options.presplit = true;
  const SceneBvh presplit = bvh_of(scene, options);
  std::mt19937 random(12);
  NoProbe probe;
  std::vector<Ray> rays;
  for (int i = 0; i < 4000; ++i) {
    // Sixteen that are alike, so that packets stay together.
    const vec3 way = random_direction(random);
    Ray ray = i % 16 == 0 ? Ray{} : rays.back();
    if (i % 16 == 0) {
      ray.origin = random_point(random, {vec3(35, 7.2f, -28), vec3(45, 7.4f, -18)});
      ray.direction = way;
    }
    ray.direction += 0.01f * way;
    rays.push_back(ray);
  }
  std::map<std::string, std::vector<Hit>> hits;
  for (const SceneBvh* bvh : {&binned, &wide}) {
    for (const KernelRow& kernel : ray_kernels()) {
      const std::string& layout = bvh->options.layout;
      std::vector<Hit>& of = hits[layout + " " + std::string(kernel.id)];
      of.resize(rays.size());
      ray_kernel(layout, kernel.id).intersect(*bvh, rays, of);
    }
  }
  int hit_count = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const Hit expected = brute_force(scene, binned, rays[i]);
    hit_count += is_hit(expected) ? 1 : 0;
    ASSERT_EQ(intersect(binned, rays[i], probe), expected) << "ray " << i;
    for (const auto& [kernel, found] : hits)
      ASSERT_EQ(found[i], expected) << kernel << " ray " << i;
    ASSERT_EQ(trace<false>(split, rays[i], probe), expected) << "ray " << i;
    ASSERT_EQ(trace<false>(presplit, rays[i], probe), expected) << "ray " << i;
  }
  EXPECT_GT(hit_count, 1000);
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

// A closed ball beside loose triangles: the slots of every node are in the order of priority.
TEST(OcclusionOrder, RanksByAreaOrByTheChanceToBlockForTheCost) {
  Mesh mesh = soup(2000, 0.05f);
  const auto shell = uint32_t(mesh.positions.size());
  const Mesh ball = sphere(16, 0.5f);
  for (const vec3& position : ball.positions)
    mesh.positions.push_back(position + vec3(4.0f, 0.0f, 0.0f));
  for (const uvec3& triangle : ball.triangles)
    mesh.triangles.push_back(triangle + shell);
  mesh.materials.resize(mesh.triangles.size());
  const Scene scene = scene_of({mesh});
  for (const OcclusionOrderRow& order : occlusion_orders()) {
    SCOPED_TRACE(order.id);
    BuildOptions options;
    options.layout = "wide8";
    options.occlusion_order = order.id;
    const SceneBvh bvh = bvh_of(scene, options);
    expect_the_binary_hits(bvh);
    const Blas& blas = *bvh.blases[0];
    const std::vector<float> priorities = occlusion_priorities(blas.tree, blas.triangles, options);
    if (order.id == "tree") {
      EXPECT_TRUE(priorities.empty());
      continue;
    }
    ASSERT_EQ(priorities.size(), blas.tree.nodes.size());
    const auto wide_slots = slots(blas.wide);
    ASSERT_GT(wide_slots.size(), size_t{100});
    for (size_t i = 1; i < wide_slots.size(); ++i) {
      if (wide_slots[i].parent != wide_slots[i - 1].parent) continue;
      EXPECT_GE(priorities[wide_slots[i].node], priorities[wide_slots[i - 1].node]) << i;
    }
  }
}

// Of a ray that nothing blocks all children that it meets are visited.
TEST(OcclusionOrder, VisitsTheLastSlotFirst) {
  BuildOptions options;
  options.layout = "wide8";
  const SceneBvh bvh = bvh_of(scene_of({soup(300, 0.05f)}), options);
  std::vector<uint32_t> under_root;
  for (const WideSlot& slot : slots(bvh.blases[0]->wide))
    if (slot.parent == 0) under_root.push_back(slot.node);
  size_t pairs = 0;
  for (const Ray& ray : rays_through(bounds(bvh), 500)) {
    LogProbe log;
    if (is_hit(trace<true>(bvh, ray, log))) continue;
    size_t last = under_root.size();
    for (const Step& step : log.steps) {
      if (step.instance == none || step.depth != 1 || step.result != StepResult::entered) continue;
      if (step.kind != StepKind::node && step.kind != StepKind::leaf) continue;
      const auto found = std::find(under_root.begin(), under_root.end(), step.id);
      ASSERT_NE(found, under_root.end());
      const auto slot = size_t(found - under_root.begin());
      pairs += last < under_root.size() ? 1 : 0;
      EXPECT_LT(slot, last);
      last = slot;
    }
  }
  EXPECT_GT(pairs, size_t{50});
}

// By hand: a random line through a unit cube meets a square from edge to edge of area sqrt(2)
// sqrt(2) / 3 times on average.
TEST(OcclusionOrder, ChanceToBlockIsThatOfRandomLines) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 1}, {1, 1, 1}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.materials.resize(2);
  BuildOptions options;
  options.max_leaf_size = 2;
  options.occlusion_order = "cost";
  options.builder = "lbvh";
  const auto blas = build_blas(mesh, options, nullptr, {});
  const auto area = float(std::sqrt(2.0));  // of both triangles
  const std::vector<float> priorities = occlusion_priorities(blas->tree, blas->triangles, options);
  ASSERT_EQ(blas->tree.nodes[0].count, 2u);
  EXPECT_NEAR(priorities[0], (1.0f - std::exp(-area / 3.0f)) / 2.0f, 1e-6f);
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

TEST(Kernels, TakeThePreferredInstructionSet) {
  for (const IsaRow& isa : isas()) {
    prefer_isa(isa.id);
    EXPECT_EQ(ray_kernel("wide8").intersect, ray_kernel("wide8", "single", isa.id).intersect);
  }
  prefer_isa("");
  EXPECT_EQ(ray_kernel("wide8").intersect, ray_kernel("wide8", "single", isas()[0].id).intersect);
}

TEST(Kernels, AreThereForEveryRowAndUnknownOnesAreTheFirst) {
  EXPECT_FALSE(isas().empty());
  for (const LayoutRow& layout : layouts()) {
    for (const KernelRow& kernel : ray_kernels())
      EXPECT_NE(ray_kernel(layout.id, kernel.id).intersect, nullptr);
    EXPECT_EQ(ray_kernel(layout.id, "unknown", "unknown").intersect,
              ray_kernel(layout.id, "single", isas()[0].id).intersect);
  }
  EXPECT_TRUE(has_kernel("binary", "packet"));
  EXPECT_FALSE(has_kernel("binary", "stream"));
  EXPECT_TRUE(has_kernel("wide8", "stream"));
}

TEST(Kernels, SuitCoherenceOfTheRays) {
  std::vector<Ray> rays(256);
  EXPECT_EQ(suitable_kernel(rays), "packet");
  std::mt19937 random(3);
  for (Ray& ray : rays)
    ray.direction = random_direction(random);
  EXPECT_EQ(suitable_kernel(rays), "single");
  EXPECT_EQ(suitable_kernel({}), "single");
}

}  // namespace
}  // namespace tracer::test
