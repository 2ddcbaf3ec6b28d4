// Filling in boxes, exact or quantised, blocks of triangles and entries.
#include "tracer/bvh/wide_fill.h"

#include <array>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "tracer/bvh/wide_slot.h"

namespace tracer {
namespace {

template <int W>
void set_boxes(WideNode<W>& node, const Bvh& tree) {
  for (int slot = 0; slot < W; ++slot) {
    const Box box = node.binary[slot] == none ? Box{} : box_of(tree.nodes[node.binary[slot]]);
    for (int axis = 0; axis < 3; ++axis) {
      node.planes[2 * axis][slot] = box.lo[axis];
      node.planes[2 * axis + 1][slot] = box.hi[axis];
    }
  }
}

// The smallest power of two of which 255 steps reach from the low plane beyond the high one.
uint8_t step_exponent(float lo, float hi) {
  const float step = (hi - lo) / 255.0f;
  int exponent = 1;
  if (step > 0.0f) {
    exponent = std::clamp(std::ilogb(step) + 127, 1, 254);
    const auto reaches = [&] { return lo + 255.0f * step_size(uint32_t(exponent)) >= hi; };
    while (exponent < 254 && !reaches())
      ++exponent;
  }
  return uint8_t(exponent);
}

void set_boxes(QuantisedNode& node, const Bvh& tree) {
  Box all;
  for (const uint32_t binary : node.binary)
    if (binary != none) all = united(all, box_of(tree.nodes[binary]));
  for (int axis = 0; axis < 3; ++axis) {
    const float origin = all.lo[axis];
    node.origin[axis] = origin;
    node.exponent[axis] = step_exponent(origin, all.hi[axis]);
    const float step = step_size(node.exponent[axis]);
    for (int slot = 0; slot < 8; ++slot) {
      uint8_t& low = node.planes[2 * axis][slot];
      uint8_t& high = node.planes[2 * axis + 1][slot];
      low = 255;
      high = 0;
      if (node.binary[slot] == none) continue;
      const Box box = box_of(tree.nodes[node.binary[slot]]);
      const auto steps = [&](float plane) {
        return std::clamp((plane - origin) / step, 0.0f, 255.0f);
      };
      low = uint8_t(std::floor(steps(box.lo[axis])));
      high = uint8_t(std::ceil(steps(box.hi[axis])));
      // As the traversal computes them, the planes may be rounded to the wrong side.
      while (low > 0 && origin + float(low) * step > box.lo[axis])
        --low;
      while (high < 255 && origin + float(high) * step < box.hi[axis])
        ++high;
    }
  }
  node.slots = 0;
  for (int slot = 0; slot < 8; ++slot)
    if (node.binary[slot] != none) node.slots |= uint8_t(1u << slot);
}

void fill_blocks(TriangleBlock* block, const Bvh& tree, uint32_t binary,
                 std::span<const LeafTriangle> triangles) {
  std::array<uint32_t, block_size> places;
  int count = 0;
  uint32_t left = references_below(tree, binary);
  for_references_below(tree, binary, [&](uint32_t place) {
    places[count++] = place;
    --left;
    if (count < block_size && left > 0) return;
    for (int lane = 0; lane < block_size; ++lane) {
      const uint32_t from = places[std::min(lane, count - 1)];
      const LeafTriangle& triangle = triangles[from];
      for (int corner = 0; corner < 3; ++corner) {
        block->corner[0][corner][lane] = triangle.x[corner];
        block->corner[1][corner][lane] = triangle.y[corner];
        block->corner[2][corner][lane] = triangle.z[corner];
      }
      block->triangle[lane] = tree.references[from];
    }
    if (left > 0) block->triangle[0] |= more_bit;
    ++block;
    count = 0;
  });
}

void fill_entries(WideEntry* entry, const Bvh& tree, uint32_t binary,
                  std::span<const EntryPoint> entries) {
  WideEntry* last = nullptr;
  for_references_below(tree, binary, [&](uint32_t place) {
    last = entry++;
    *last = {tree.references[place] | more_bit, entries.empty() ? EntryPoint() : entries[place]};
  });
  last->instance &= ~more_bit;
}

template <class Node>
void fill_nodes(WideNodes<Node>& wide, const Bvh& tree, std::span<const LeafTriangle> triangles,
                std::span<const EntryPoint> entries) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, wide.nodes.size(), 256), [&](const auto& range) {
    for (size_t i = range.begin(); i < range.end(); ++i) {
      Node& node = wide.nodes[i];
      set_boxes(node, tree);
      for (int slot = 0; slot < Node::width; ++slot) {
        const WideChild child = node.child[slot];
        if (child == no_child || !is_leaf(child)) continue;
        const uint32_t first = child & ~leaf_bit;
        if (triangles.empty()) {
          fill_entries(wide.entries.data() + first, tree, node.binary[slot], entries);
        } else {
          fill_blocks(wide.blocks.data() + first, tree, node.binary[slot], triangles);
        }
      }
    }
  });
}

}  // namespace

void fill(WideTree& wide, const Bvh& tree, std::span<const LeafTriangle> triangles,
          std::span<const EntryPoint> entries) {
  std::visit(
      [&](auto& layout) {
        if constexpr (requires { layout.nodes; }) fill_nodes(layout, tree, triangles, entries);
      },
      wide);
}

}  // namespace tracer
