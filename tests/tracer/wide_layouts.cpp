// What tests of wide layouts share.
#include "wide_layouts.h"

#include <bit>
#include <cmath>

#include "tracer/bvh/ray_kernels.h"
#include "tracer/bvh/traverse.h"
#include "tracer/scene/scene.h"

namespace tracer::test {
namespace {

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

std::vector<std::tuple<std::string, std::string>> wide_choices() {
  std::vector<std::tuple<std::string, std::string>> choices;
  for (const LayoutRow& layout : layouts()) {
    for (const WideningRow& widening : widenings()) {
      if (layout.width > 2) choices.emplace_back(layout.id, widening.id);
    }
  }
  return choices;
}

// Of all files.
INSTANTIATE_TEST_SUITE_P(Wide, EveryWideLayout, testing::ValuesIn(wide_choices()),
                         [](const auto& info) {
                           return std::get<0>(info.param) + "_" + std::get<1>(info.param);
                         });

}  // namespace

std::vector<AnySlot> slots_of(const WideTree& tree) {
  return std::visit(
      [](const auto& wide) -> std::vector<AnySlot> {
        if constexpr (requires { wide.nodes; }) return slots_of(wide);
        return {};
      },
      tree);
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

}  // namespace tracer::test
