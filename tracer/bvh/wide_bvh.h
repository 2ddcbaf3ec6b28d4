// Wide layouts: the canonical tree with several children a node, tested together by one vector
// instruction each, and with its triangles in blocks. Always derived from the canonical tree; each
// slot remembers the binary node it came from.
// I. Wald, C. Benthin, S. Boulos, Getting Rid of Packets, 2008; H. Dammertz, J. Hanika, A. Keller,
// Shallow Bounding Volume Hierarchies for Fast SIMD Ray Tracing of Incoherent Rays, 2008.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <variant>

#include "tracer/bvh/build.h"
#include "tracer/untouched.h"

namespace tracer {

// A triangle as the traversal reads it: by axis, so that one 16-byte load gets one coordinate of
// all three corners.
//  byte  0      12     24     36
//        | x abc | y abc | z abc |
struct LeafTriangle {
  float x[3], y[3], z[3];
};
static_assert(sizeof(LeafTriangle) == 36);

// What a slot of a wide node leads to: nothing, another wide node, or a leaf: its first block of
// triangles (BLAS) or its first entry (TLAS).
using WideChild = uint32_t;
inline constexpr WideChild leaf_bit = 1u << 31;
inline constexpr WideChild no_child = ~0u;
inline bool is_leaf(WideChild child) {
  return (child & leaf_bit) != 0;
}

// Of blocks and entries of one leaf all but the last have this bit in their first number.
inline constexpr uint32_t more_bit = 1u << 31;

// The planes of axis a are planes[2 a] (low) and planes[2 a + 1] (high). An empty slot has a box
// that nothing hits; the empty ones come last.
template <int W>
struct alignas(64) WideNode {
  static constexpr int width = W;
  float planes[6][W];
  WideChild child[W];
  uint32_t binary[W];  // node of the canonical tree; none: empty
};
static_assert(sizeof(WideNode<4>) == 128 && sizeof(WideNode<8>) == 256);

// Planes in steps of a power of two from an origin, rounded outwards (H. Ylitie, T. Karras,
// S. Laine, Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs, 2017).
// Empty slots come last.
//  byte  0        12          15      16           64      96
//        | origin | exponents | slots | planes 6x8 | child | binary |
struct alignas(64) QuantisedNode {
  static constexpr int width = 8;
  float origin[3];
  uint8_t exponent[3];  // of an axis: the step is 2^(exponent - 127)
  uint8_t slots;        // bit i: slot i is not empty
  uint8_t planes[6][8];
  WideChild child[8];
  uint32_t binary[8];
};
static_assert(sizeof(QuantisedNode) == 128);

// Four triangles, coordinates by axis and corner. Lanes that no triangle is left for repeat the
// last one.
inline constexpr int block_size = 4;
struct alignas(16) TriangleBlock {
  float corner[3][3][block_size];  // axis, corner, lane
  uint32_t triangle[block_size];   // index in the mesh; the first one also holds more_bit
};
static_assert(sizeof(TriangleBlock) == 160);

// Where the rays that reach an instance in the TLAS enter its BLAS: at the root, or at a node below
// it that the layout keeps (rebraid.h).
struct EntryPoint {
  uint32_t node = 0;    // of the canonical tree
  WideChild child = 0;  // the same node in a wide layout
  uint32_t depth = 0;   // edges from the root, in the layout

  bool operator==(const EntryPoint&) const = default;
};

// An instance in a leaf of the TLAS.
struct WideEntry {
  uint32_t instance;  // may hold more_bit
  EntryPoint at;
};

// A vector whose first element is at the begin of a cache line.
template <class Node>
struct LineAllocator : UntouchedAllocator<Node> {
  template <class Other>
  struct rebind {
    using other = LineAllocator<Other>;
  };
  static constexpr std::align_val_t line{64};
  Node* allocate(size_t count) {
    return static_cast<Node*>(::operator new(count * sizeof(Node), line));
  }
  void deallocate(Node* nodes, size_t) { ::operator delete(nodes, line); }
};

// Node 0 is the root and stands for node 0 of the canonical tree; over a single leaf it has one
// child. Children come after their parents.
template <class Node>
struct WideNodes {
  std::vector<Node, LineAllocator<Node>> nodes;
  UntouchedVector<TriangleBlock> blocks;  // of a BLAS
  UntouchedVector<WideEntry> entries;     // of a TLAS
  uint32_t depth = 0;                     // edges from the root to the deepest node
};
using Wide4 = WideNodes<WideNode<4>>;
using Wide8 = WideNodes<WideNode<8>>;
using Quantised8 = WideNodes<QuantisedNode>;

// The tree in the layout of its build options; nothing for the binary one.
using WideTree = std::variant<std::monostate, Wide4, Wide8, Quantised8>;

// Cost of testing a block of triangles, in units of testing the children of a wide node.
inline constexpr float block_cost = 0.6f;

// Triangles are in the order of tree.references; none: the tree is a TLAS, whose entries are in
// that order, or none if all are roots. The layout and widening must be known ones (check).
// Deterministic for any number of threads.
WideTree widen(const Bvh& tree, std::span<const LeafTriangle> triangles,
               const BuildOptions& options, std::span<const EntryPoint> entries = {});

// New boxes and triangles after a refit of the canonical tree.
void refit(WideTree& wide, const Bvh& tree, std::span<const LeafTriangle> triangles);

uint64_t bytes(const WideTree& wide);

// A child of a wide node, as the traversal sees it.
struct WideSlot {
  uint32_t parent;  // binary nodes that the two came from
  uint32_t node;
  bool leaf;
  Box box;  // a quantised one is larger than that of the binary node
};

// Of the nodes in order, the slots of each from left to right. None of the binary layout, and of a
// tree that is a single leaf.
std::vector<WideSlot> slots(const WideTree& wide);

}  // namespace tracer
