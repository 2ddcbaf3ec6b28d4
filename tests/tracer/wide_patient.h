// A scene in a wide layout that can be damaged, for tests of the rules for wide trees.
#pragma once

#include <gtest/gtest.h>

#include "patient.h"
#include "tracer/analyze/wide_rules.h"

namespace tracer::test {

// Mesh 0 and the top level, of 42 instances, have wide trees of several levels; mesh 1 is a single
// leaf.
inline Scene sick_scene() {
  Scene scene = scene_of({soup(501, 0.1f), soup(1, 0.5f), soup(3, 0.3f)});
  for (uint32_t i = 3; i < 42; ++i) {
    Instance instance = scene.instances[2];
    instance.transform[3] = vec4(i % 7, i / 7, i % 3, 1.0f);
    scene.instances.push_back(instance);
  }
  return scene;
}

template <class Node>
inline constexpr const char* layout_of = Node::width == 4 ? "wide4" : "wide8";
template <>
inline constexpr const char* layout_of<QuantisedNode> = "quantised8";

template <class Node>
BuildOptions options_of() {
  BuildOptions options;
  options.layout = layout_of<Node>;
  return options;
}

struct Place {
  uint32_t node;
  int slot;
};

template <class Node>
class WidePatient : public testing::Test {
 protected:
  using Nodes = WideNodes<Node>;
  static constexpr int W = Node::width;

  Patient patient{sick_scene(), options_of<Node>()};
  Blas& blas = patient.blas(0);
  Bvh& tree = blas.tree;
  Nodes& wide = std::get<Nodes>(blas.wide);
  Nodes& single = std::get<Nodes>(patient.blas(1).wide);
  Nodes& top = std::get<Nodes>(patient.bvh.wide_tlas);

  // The first slot for which wanted(wide node, slot) holds, from wide node `from` on.
  template <class Wanted>
  static Place find(const Nodes& in, const Wanted& wanted, uint32_t from = 0) {
    for (uint32_t i = from; i < in.nodes.size(); ++i) {
      for (int slot = 0; slot < W; ++slot)
        if (wanted(in.nodes[i], slot)) return {i, slot};
    }
    ADD_FAILURE() << "the test's scene has no such slot";
    return {0, 0};
  }
  static Place first_inner(const Nodes& in, uint32_t from = 0) {
    return find(
        in, [](const Node& node, int slot) { return !is_leaf(node.child[slot]); }, from);
  }
  static Place first_leaf(const Nodes& in, uint32_t from = 0) {
    return find(
        in, [](const Node& node, int slot) { return is_filled_leaf(node, slot); }, from);
  }
  static bool is_filled_leaf(const Node& node, int slot) {
    return node.child[slot] != no_child && is_leaf(node.child[slot]);
  }
  static uint32_t first_item(const Nodes& in, Place place) {
    return in.nodes[place.node].child[place.slot] & ~leaf_bit;
  }
  // A leaf of the BLAS with more than so many references, or of exactly so many.
  Place leaf_over(uint32_t references) {
    return find(wide, [&](const Node& node, int slot) {
      return is_filled_leaf(node, slot) && references_below(tree, node.binary[slot]) > references;
    });
  }
  Place leaf_of(uint32_t references) {
    return find(wide, [&](const Node& node, int slot) {
      return is_filled_leaf(node, slot) && references_below(tree, node.binary[slot]) == references;
    });
  }
  Place entries_over(uint32_t references) {
    return find(top, [&](const Node& node, int slot) {
      return is_filled_leaf(node, slot) &&
             references_below(patient.bvh.tlas, node.binary[slot]) > references;
    });
  }

  static void empty(Node& node, int slot) {
    node.child[slot] = no_child;
    node.binary[slot] = none;
    if constexpr (requires { node.slots; }) {
      node.slots &= uint8_t(~(1u << slot));
    } else {
      for (int plane = 0; plane < 6; ++plane)
        node.planes[plane][slot] = plane % 2 == 0 ? infinity : -infinity;
    }
  }
  // `to` gets what is in `from`, but for the wide nodes or items that it leads to.
  static void copy_box(Node& to, int slot, const Node& from, int other) {
    for (int plane = 0; plane < 6; ++plane)
      to.planes[plane][slot] = from.planes[plane][other];
    if constexpr (requires { to.slots; }) to.slots |= uint8_t(1u << slot);
  }

  // The rule finds something, at a node that there is, and no ray enters the tree.
  Finding expect_closed(std::string_view rule) { return expect_found(rule, 0); }
  Finding expect_found(std::string_view rule, uint64_t rays = 200) {
    const Validation result = patient.validated();
    EXPECT_EQ(result.rays_checked, rays);
    EXPECT_TRUE(has_errors(result));
    for (const Finding& finding : result.findings) {
      if (finding.rule == hits_rule) continue;
      EXPECT_EQ(finding.rule, rule) << finding.message;
      const Bvh& of =
          finding.bvh == none ? patient.bvh.tlas : patient.bvh.blases[finding.bvh]->tree;
      EXPECT_TRUE(finding.node == none || finding.node < of.nodes.size());
    }
    if (result.findings.empty()) return {};
    return result.findings[0];
  }
};

using AllNodes = testing::Types<WideNode<4>, WideNode<8>, QuantisedNode>;
class NodeNames {
 public:
  template <class Node>
  static std::string GetName(int) {
    return layout_of<Node>;
  }
};

}  // namespace tracer::test
