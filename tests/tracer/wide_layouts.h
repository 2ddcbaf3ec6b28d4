// Scenes, rays and the fixture for tests of wide layouts.
#pragma once

#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "make_scene.h"

namespace tracer::test {

// What all layouts have in common.
struct AnySlot {
  uint32_t node = 0, binary = none;
  WideChild child = no_child;
  Box box;
};

std::vector<AnySlot> slots_of(const WideTree& tree);

// One to many triangles, several meshes, equal triangles, instances.
std::vector<Scene> wide_scenes();

// By layout that has wide nodes, and widening.
class EveryWideLayout : public testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  BuildOptions options() const {
    BuildOptions options;
    options.layout = std::get<0>(GetParam());
    options.widening = std::get<1>(GetParam());
    return options;
  }
};

// Of several kinds: coherent, random, along the axes, not valid.
std::vector<Ray> rays_through(const Box& box, int count);

// From every kernel of the layout on every instruction set.
void expect_the_binary_hits(const SceneBvh& bvh);

}  // namespace tracer::test
