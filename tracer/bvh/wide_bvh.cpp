// The layouts to choose from, and what can be done with a tree in one of them. Its nodes are chosen
// in widening.cpp, laid out in wide_emission.cpp, and filled in wide_fill.cpp.
#include "tracer/bvh/wide_bvh.h"

#include "tracer/bvh/occlusion_order.h"
#include "tracer/bvh/wide_emission.h"
#include "tracer/bvh/wide_fill.h"
#include "tracer/bvh/wide_slot.h"
#include "tracer/choice.h"

namespace tracer {
namespace {

constexpr LayoutRow layout_rows[] = {
    {"binary", "Binary, 32-byte nodes",
     "The canonical tree itself: two children a node, their boxes side by side in 64 bytes.",
     "I. Wald, S. Boulos, P. Shirley, Ray Tracing Deformable Scenes Using Dynamic Bounding Volume "
     "Hierarchies, 2007"},
    {"wide4", "4-wide, 128-byte nodes",
     "Up to four children a node, tested together; triangles in blocks of four.",
     "H. Dammertz, J. Hanika, A. Keller, Shallow Bounding Volume Hierarchies for Fast SIMD Ray "
     "Tracing of Incoherent Rays, 2008",
     4},
    {"wide8", "8-wide, 256-byte nodes",
     "Up to eight children a node, tested together; triangles in blocks of four.",
     "I. Wald, C. Benthin, S. Boulos, Getting Rid of Packets, 2008", 8},
    {"quantised8", "8-wide, 128-byte nodes",
     "As 8-wide, the boxes rounded outwards to 8 bits a plane: half the memory, somewhat larger "
     "boxes.",
     "H. Ylitie, T. Karras, S. Laine, Efficient Incoherent Ray Traversal on GPUs Through "
     "Compressed Wide BVHs, 2017",
     8, true},
};

template <class Node>
std::vector<WideSlot> slots_of(const WideNodes<Node>& wide) {
  std::vector<WideSlot> slots;
  std::vector<uint32_t> binary(wide.nodes.size(), 0);  // by wide node
  for (size_t i = 0; i < wide.nodes.size(); ++i) {
    const Node& node = wide.nodes[i];
    for (int slot = 0; slot < Node::width && node.binary[slot] != none; ++slot) {
      if (node.binary[slot] == 0) return {};  // the root is a leaf
      const bool leaf = is_leaf(node.child[slot]);
      if (!leaf) binary[node.child[slot]] = node.binary[slot];
      slots.push_back({binary[i], node.binary[slot], leaf, slot_box(node, slot)});
    }
  }
  return slots;
}

}  // namespace

std::span<const LayoutRow> layouts() {
  return layout_rows;
}

WideTree widen(const Bvh& tree, std::span<const LeafTriangle> triangles,
               const BuildOptions& options, std::span<const EntryPoint> entries) {
  if (find_row(layouts(), options.layout)->width == 2 || tree.nodes.empty()) return {};
  const std::vector<float> priorities = occlusion_priorities(tree, triangles, options);
  WideTree wide = emitted(tree, triangles.empty(), options, priorities);
  fill(wide, tree, triangles, entries);
  return wide;
}

void refit(WideTree& wide, const Bvh& tree, std::span<const LeafTriangle> triangles) {
  fill(wide, tree, triangles, {});
}

std::vector<WideSlot> slots(const WideTree& wide) {
  return std::visit(
      [](const auto& layout) -> std::vector<WideSlot> {
        if constexpr (requires { layout.nodes; }) return slots_of(layout);
        return {};
      },
      wide);
}

uint64_t bytes(const WideTree& wide) {
  return std::visit(
      [](const auto& layout) -> uint64_t {
        if constexpr (requires { layout.nodes; }) {
          return layout.nodes.size() * sizeof(layout.nodes[0]) +
                 layout.blocks.size() * sizeof(TriangleBlock) +
                 layout.entries.size() * sizeof(WideEntry);
        } else {
          return 0;
        }
      },
      wide);
}

}  // namespace tracer
