// Widening: which binary nodes become children of wide ones, and filling in their boxes.
// Optimal: the dynamic programme of H. Ylitie, T. Karras, S. Laine, Efficient Incoherent Ray
// Traversal on GPUs Through Compressed Wide BVHs, 2017, with blocks of triangles as leaves.
#include "tracer/bvh/wide_bvh.h"

#include <array>
#include <cassert>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "tracer/bvh/bottom_up.h"
#include "tracer/bvh/occlusion_order.h"
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

constexpr WideningRow widening_rows[] = {
    {"optimal", "Optimal",
     "The wide tree of lowest SAH that can be made of the binary one, its leaves blocks of "
     "triangles, by dynamic programming.",
     "H. Ylitie, T. Karras, S. Laine, Efficient Incoherent Ray Traversal on GPUs Through "
     "Compressed Wide BVHs, 2017"},
    {"greedy", "Greedy",
     "From the root on, the child of largest area is replaced by its children until the node is "
     "full; leaves stay as they are.",
     "I. Wald, C. Benthin, S. Boulos, Getting Rid of Packets, 2008"},
};

constexpr uint32_t max_merged = 2 * block_size;  // references of a subtree that becomes one leaf

bool is_leaf_node(const Bvh& tree, uint32_t node) {
  return tree.nodes[node].count > 0;
}

float cost_of_leaf(float area, uint32_t references) {
  const uint32_t blocks = (references + block_size - 1) / block_size;
  return area * block_cost * float(blocks);
}

// Of a binary node: the least cost of its subtree as a forest of at most i + 1 wide subtrees.
// References above max_merged are not told apart.
template <int W>
struct Costs {
  float forest[W - 1];
  uint32_t references;
  bool as_leaf;  // the one subtree of forest[0] is a leaf
};

template <int W>
using CostTable = UntouchedVector<Costs<W>>;

// The children of a wide node, binary nodes in the order from left to right.
template <int W>
struct Slots {
  std::array<uint32_t, W> node;
  int count = 0;
};

// What is spent on the left of two subtrees that share `roots` wide subtrees, at best.
template <int W>
int best_share(const Costs<W>& left, const Costs<W>& right, int roots) {
  int best = 1;
  float least = infinity;
  for (int share = 1; share < roots; ++share) {
    const float cost = left.forest[share - 1] + right.forest[roots - share - 1];
    if (cost >= least) continue;
    least = cost;
    best = share;
  }
  return best;
}

template <int W>
class Optimal {
 public:
  Optimal(const Bvh& tree, bool merges_leaves) : tree_(tree), costs_(tree.nodes.size()) {
    for_nodes_bottom_up(std::span(tree.nodes), [&](const BvhNode& node) {
      Costs<W>& costs = costs_[&node - tree.nodes.data()];
      const float area = half_area(box_of(node));
      if (is_leaf(node)) {
        costs.references = std::min(node.count, max_merged + 1);
        costs.as_leaf = true;
        std::fill_n(costs.forest, W - 1, cost_of_leaf(area, node.count));
        return;
      }
      const Costs<W>& left = costs_[node.first];
      const Costs<W>& right = costs_[node.first + 1];
      costs.references = std::min(left.references + right.references, max_merged + 1);
      float inner = infinity;
      for (int k = 1; k < W; ++k)
        inner = std::min(inner, left.forest[k - 1] + right.forest[W - k - 1]);
      inner += area;
      const bool mergeable = merges_leaves && costs.references <= max_merged;
      const float merged = mergeable ? cost_of_leaf(area, costs.references) : infinity;
      costs.as_leaf = merged <= inner;
      costs.forest[0] = std::min(merged, inner);
      for (int i = 2; i < W; ++i) {
        float least = costs.forest[i - 2];
        for (int k = 1; k < i; ++k)
          least = std::min(least, left.forest[k - 1] + right.forest[i - k - 1]);
        costs.forest[i - 1] = least;
      }
    });
  }

  bool is_leaf_slot(uint32_t node) const { return costs_[node].as_leaf; }

  Slots<W> children(uint32_t node) const {
    Slots<W> slots;
    spread_below(node, W, slots);
    return slots;
  }

 private:
  void spread(uint32_t node, int roots, Slots<W>& slots) const {
    const Costs<W>& costs = costs_[node];
    while (roots > 1 && costs.forest[roots - 1] == costs.forest[roots - 2])
      --roots;
    if (roots == 1) {
      slots.node[slots.count++] = node;
    } else {
      spread_below(node, roots, slots);
    }
  }
  void spread_below(uint32_t node, int roots, Slots<W>& slots) const {
    const uint32_t left = tree_.nodes[node].first;
    const int share = best_share(costs_[left], costs_[left + 1], roots);
    spread(left, share, slots);
    spread(left + 1, roots - share, slots);
  }

  const Bvh& tree_;
  CostTable<W> costs_;
};

template <int W>
class Greedy {
 public:
  explicit Greedy(const Bvh& tree, bool /*merges_leaves*/) : tree_(tree) {}

  bool is_leaf_slot(uint32_t node) const { return is_leaf_node(tree_, node); }

  Slots<W> children(uint32_t node) const {
    Slots<W> slots;
    slots.node[0] = tree_.nodes[node].first;
    slots.node[1] = tree_.nodes[node].first + 1;
    for (slots.count = 2; slots.count < W; ++slots.count) {
      int largest = -1;
      float most = -1.0f;
      for (int i = 0; i < slots.count; ++i) {
        const float area = half_area(box_of(tree_.nodes[slots.node[i]]));
        if (is_leaf_slot(slots.node[i]) || !(area > most)) continue;
        most = area;
        largest = i;
      }
      if (largest < 0) break;
      const uint32_t opened = tree_.nodes[slots.node[largest]].first;
      slots.node[slots.count] = opened + 1;
      slots.node[largest] = opened;
    }
    return slots;
  }

 private:
  const Bvh& tree_;
};

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

void fill_entries(WideEntry* entry, const Bvh& tree, uint32_t binary) {
  WideEntry* last = nullptr;
  for_references_below(tree, binary, [&](uint32_t place) {
    last = entry++;
    *last = {tree.references[place] | more_bit};
  });
  last->instance &= ~more_bit;
}

template <class Node>
void fill(WideNodes<Node>& wide, const Bvh& tree, std::span<const LeafTriangle> triangles) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, wide.nodes.size(), 256), [&](const auto& range) {
    for (size_t i = range.begin(); i < range.end(); ++i) {
      Node& node = wide.nodes[i];
      set_boxes(node, tree);
      for (int slot = 0; slot < Node::width; ++slot) {
        const WideChild child = node.child[slot];
        if (child == no_child || !is_leaf(child)) continue;
        const uint32_t first = child & ~leaf_bit;
        if (triangles.empty()) {
          fill_entries(wide.entries.data() + first, tree, node.binary[slot]);
        } else {
          fill_blocks(wide.blocks.data() + first, tree, node.binary[slot], triangles);
        }
      }
    }
  });
}

// A node of a wide tree that is being made: a binary node, and which slot leads to it.
struct Open {
  uint32_t binary = 0;
  uint32_t parent = none;  // of the root: none
  int slot = 0;
  uint32_t depth = 0;
};

// A node without its boxes.
template <int W>
struct Links {
  WideChild child[W];
  uint32_t binary[W];
};

// Part of a wide tree, numbered by itself: one node near the root, or all that is below one.
template <int W>
struct Part {
  Open root;  // parent: the part that is this one node
  bool whole = true;
  UntouchedVector<Links<W>> nodes;
  uint32_t leaves = 0;  // their blocks or entries
  uint32_t depth = 0;
};

// Decides which nodes there are, depth first, children of large area before small ones so that
// what is often visited together lies together.
template <int W, class Widening>
class Emission {
 public:
  Emission(const Bvh& tree, bool is_tlas, std::span<const float> priorities)
      : tree_(tree), is_tlas_(is_tlas), priorities_(priorities), widening_(tree, !is_tlas) {}

  // In the order of their nodes.
  std::vector<Part<W>> parts() const {
    constexpr size_t min_parallel = 1u << 14;  // nodes; below it one part is as fast
    constexpr int levels = W == 4 ? 4 : 3;     // some hundreds of subtrees
    const bool parallel =
        tree_.nodes.size() >= min_parallel && tbb::this_task_arena::max_concurrency() > 1;
    std::vector<Part<W>> parts;
    divide({}, parallel ? levels : 0, parts);
    tbb::parallel_for(size_t{0}, parts.size(), [&](size_t i) {
      if (parts[i].whole) add_subtree(parts[i]);
    });
    return parts;
  }

 private:
  void divide(const Open& root, int levels, std::vector<Part<W>>& parts) const {
    const auto index = uint32_t(parts.size());
    parts.push_back({root, levels == 0, {}, 0, root.depth});
    if (levels == 0) return;
    std::vector<Open> open;
    add_node(root.binary, root.depth, index, parts[index], open);
    for (; !open.empty(); open.pop_back())
      divide(open.back(), levels - 1, parts);
  }

  void add_subtree(Part<W>& part) const {
    std::vector<Open> open = {{part.root.binary, none, 0, part.root.depth}};
    while (!open.empty()) {
      const Open now = open.back();
      open.pop_back();
      const auto index = uint32_t(part.nodes.size());
      if (now.parent != none) part.nodes[now.parent].child[now.slot] = index;
      part.depth = std::max(part.depth, now.depth);
      add_node(now.binary, now.depth, index, part, open);
    }
  }

  // The inner ones of its children wait in `open`, the first to come last, and lead to `index`.
  void add_node(uint32_t from, uint32_t depth, uint32_t index, Part<W>& part,
                std::vector<Open>& open) const {
    Links<W>& node = part.nodes.emplace_back();
    std::fill_n(node.child, W, no_child);
    std::fill_n(node.binary, W, none);
    const Slots<W> slots = slots_of_node(from);
    const size_t first_open = open.size();
    for (int slot = 0; slot < slots.count; ++slot) {
      const uint32_t binary = slots.node[slot];
      node.binary[slot] = binary;
      if (widening_.is_leaf_slot(binary)) {
        const uint32_t references = references_below(tree_, binary);
        node.child[slot] = part.leaves | leaf_bit;
        part.leaves += is_tlas_ ? references : (references + block_size - 1) / block_size;
      } else {
        open.push_back({binary, index, slot, depth + 1});
      }
    }
    const auto area = [&](const Open& of) { return half_area(box_of(tree_.nodes[of.binary])); };
    std::stable_sort(open.begin() + ptrdiff_t(first_open), open.end(),
                     [&](const Open& a, const Open& b) { return area(a) < area(b); });
  }

  Slots<W> slots_of_node(uint32_t binary) const {
    if (is_leaf_node(tree_, binary)) return {{binary}, 1};  // only the root
    Slots<W> slots = widening_.children(binary);
    if (!priorities_.empty()) {  // the last slot is visited first
      std::stable_sort(slots.node.begin(), slots.node.begin() + slots.count,
                       [&](uint32_t a, uint32_t b) { return priorities_[a] < priorities_[b]; });
    }
    return slots;
  }

  const Bvh& tree_;
  bool is_tlas_;
  std::span<const float> priorities_;
  Widening widening_;
};

// Counts the parts' nodes and leaves through.
template <class Node>
void join(std::span<const Part<Node::width>> parts, bool is_tlas, WideNodes<Node>& wide) {
  struct Base {
    uint32_t node = 0, leaf = 0;
  };
  std::vector<Base> bases;
  Base total;
  for (const auto& part : parts) {
    bases.push_back(total);
    total.node += uint32_t(part.nodes.size());
    total.leaf += part.leaves;
    wide.depth = std::max(wide.depth, part.depth);
  }
  wide.nodes.resize(total.node);
  if (is_tlas) {
    wide.entries.resize(total.leaf);
  } else {
    wide.blocks.resize(total.leaf);
  }
  tbb::parallel_for(size_t{0}, parts.size(), [&](size_t i) {
    const Base base = bases[i];
    Node* node = wide.nodes.data() + base.node;
    for (const auto& links : parts[i].nodes) {
      std::copy_n(links.binary, Node::width, node->binary);
      std::transform(links.child, links.child + Node::width, node->child, [&](WideChild child) {
        if (child == no_child) return child;
        return child + (is_leaf(child) ? base.leaf : base.node);
      });
      ++node;
    }
  });
  for (size_t i = 0; i < parts.size(); ++i) {
    const Open& root = parts[i].root;
    if (root.parent != none) wide.nodes[bases[root.parent].node].child[root.slot] = bases[i].node;
  }
}

template <class Node, template <int> class Widening>
WideNodes<Node> widen_to(const Bvh& tree, std::span<const LeafTriangle> triangles,
                         std::span<const float> priorities) {
  constexpr int W = Node::width;
  const bool is_tlas = triangles.empty();
  WideNodes<Node> wide;
  const std::vector<Part<W>> parts = Emission<W, Widening<W>>(tree, is_tlas, priorities).parts();
  join<Node>(parts, is_tlas, wide);
  fill(wide, tree, triangles);
  return wide;
}

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

template <class Node>
WideNodes<Node> widen_as(const Bvh& tree, std::span<const LeafTriangle> triangles,
                         const BuildOptions& options) {
  const std::vector<float> priorities = occlusion_priorities(tree, triangles, options);
  return options.widening == "greedy" ? widen_to<Node, Greedy>(tree, triangles, priorities)
                                      : widen_to<Node, Optimal>(tree, triangles, priorities);
}

}  // namespace

std::span<const LayoutRow> layouts() {
  return layout_rows;
}

std::span<const WideningRow> widenings() {
  return widening_rows;
}

WideTree widen(const Bvh& tree, std::span<const LeafTriangle> triangles,
               const BuildOptions& options) {
  const LayoutRow& layout = *find_row(layouts(), options.layout);
  if (layout.width == 2 || tree.nodes.empty()) return {};
  if (layout.quantised) return widen_as<QuantisedNode>(tree, triangles, options);
  if (layout.width == 4) return widen_as<WideNode<4>>(tree, triangles, options);
  return widen_as<WideNode<8>>(tree, triangles, options);
}

void refit(WideTree& wide, const Bvh& tree, std::span<const LeafTriangle> triangles) {
  std::visit(
      [&](auto& layout) {
        if constexpr (requires { layout.nodes; }) fill(layout, tree, triangles);
      },
      wide);
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
