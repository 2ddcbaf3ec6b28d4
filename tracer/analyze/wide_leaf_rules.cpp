// The rules for the leaves of a wide tree.
#include <algorithm>
#include <iterator>
#include <utility>

#include "tracer/analyze/wide_rules.h"
#include "tracer/analyze/wide_walk.h"

namespace tracer {
namespace {

// The blocks of a BLAS or the entries of a TLAS, as numbers of primitives one after the other.
struct LeafItems {
  std::span<const TriangleBlock> blocks;
  std::span<const WideEntry> entries;
  std::string_view name;
  uint32_t lanes;               // numbers an item
  std::vector<uint32_t> owner;  // by item: the node of its leaf

  uint32_t raw(size_t item, uint32_t lane) const {
    return lanes == 1 ? entries[item].instance : blocks[item].triangle[lane];
  }
  bool has_more(size_t item) const { return (raw(item, 0) & more_bit) != 0; }
  uint32_t primitive(size_t first, size_t i) const {
    const auto lane = uint32_t(i % lanes);
    return lane == 0 ? raw(first + i / lanes, 0) & ~more_bit : raw(first + i / lanes, lane);
  }
};

template <class Node>
LeafItems items_of(const TreeToCheck& of, const WideNodes<Node>& wide) {
  LeafItems items{wide.blocks, wide.entries, "blocks", block_size, {}};
  if (of.mesh == nullptr) {
    items.name = "entries";
    items.lanes = 1;
  }
  const size_t size = of.mesh == nullptr ? wide.entries.size() : wide.blocks.size();
  items.owner.resize(size, none);
  return items;
}

// Empty: the items from `first` on are there, of this leaf only, and end with the last.
std::string chain_fault(LeafItems& items, size_t first, size_t count, uint32_t node) {
  if (first + count > items.owner.size()) {
    return fmt::format("{} {} from {} on; there are {}", count, items.name, first,
                       items.owner.size());
  }
  for (size_t item = first; item < first + count; ++item) {
    const uint32_t other = std::exchange(items.owner[item], node);
    if (other != none) return fmt::format("{} {}, which are of node {}", items.name, item, other);
  }
  for (size_t k = 0; k < count; ++k) {
    if (items.has_more(first + k) == (k + 1 < count)) continue;
    return fmt::format("{} {} to {}, but {} {}", items.name, first, first + count - 1, first + k,
                       k + 1 < count ? "says that it is the last" : "says that more follow");
  }
  return "";
}

// Empty: the items hold the primitives, in any order, and repeat the last to the end.
std::string content_fault(const LeafItems& items, size_t first, std::vector<uint32_t> wanted) {
  std::vector<uint32_t> held;
  for (size_t i = 0; i < wanted.size(); ++i)
    held.push_back(items.primitive(first, i));
  const uint32_t last = held.back();
  std::sort(held.begin(), held.end());
  std::sort(wanted.begin(), wanted.end());
  std::vector<uint32_t> strange;
  std::set_difference(held.begin(), held.end(), wanted.begin(), wanted.end(),
                      std::back_inserter(strange));
  if (!strange.empty()) return fmt::format("{} that are not below it: {}", items.name, strange[0]);
  const size_t lanes = (wanted.size() + items.lanes - 1) / items.lanes * items.lanes;
  for (size_t i = wanted.size(); i < lanes; ++i) {
    if (items.primitive(first, i) == last) continue;
    return fmt::format("{} whose last is {}, but then {} follows", items.name, last,
                       items.primitive(first, i));
  }
  return "";
}

// Calls visit(block, lane) for those whose copy is not as in the mesh.
template <class Visit>
void for_each_wrong_lane(const Mesh& mesh, std::span<const TriangleBlock> blocks, size_t first,
                         const Visit& visit) {
  for (size_t b = first;; ++b) {
    const TriangleBlock& block = blocks[b];
    for (int lane = 0; lane < block_size; ++lane) {
      const uvec3 corners = mesh.triangles[block.triangle[lane] & ~more_bit];
      for (int k = 0; k < 3; ++k) {
        const vec3 copy(block.corner[0][k][lane], block.corner[1][k][lane],
                        block.corner[2][k][lane]);
        if (copy == mesh.positions[corners[k]]) continue;
        visit(b, lane);
        break;
      }
    }
    if ((block.triangle[0] & more_bit) == 0) return;
  }
}

}  // namespace

void check_wide_leaves(const TreeToCheck& of, FindingList& found) {
  in_wide(of, [&](const auto& wide) {
    LeafItems items = items_of(of, wide);
    for_each_leaf(wide, [&](size_t first, uint32_t i, int slot) {
      const uint32_t binary = wide.nodes[i].binary[slot];
      std::vector<uint32_t> wanted;
      for_references_below(of.tree, binary,
                           [&](uint32_t place) { wanted.push_back(of.tree.references[place]); });
      const size_t count = (wanted.size() + items.lanes - 1) / items.lanes;
      std::string wrong = chain_fault(items, first, count, binary);
      if (wrong.empty()) wrong = content_fault(items, first, std::move(wanted));
      if (wrong.empty()) return;
      found.add(binary, none, [&] { return fmt::format("{} has {}", slot_name(i, slot), wrong); });
    });
    const auto unowned = std::count(items.owner.begin(), items.owner.end(), none);
    if (unowned == 0) return;
    found.add(none, none, [&] { return fmt::format("{} {} are in no leaf", unowned, items.name); });
  });
}

void check_wide_triangles(const TreeToCheck& of, FindingList& found) {
  if (of.mesh == nullptr) return;
  in_wide(of, [&](const auto& wide) {
    for_each_leaf(wide, [&](size_t first, uint32_t i, int slot) {
      for_each_wrong_lane(*of.mesh, wide.blocks, first, [&](size_t block, int lane) {
        const uint32_t triangle = wide.blocks[block].triangle[lane] & ~more_bit;
        found.add(wide.nodes[i].binary[slot], triangle, [&] {
          return fmt::format("the copy in lane {} of block {} differs from the mesh", lane, block);
        });
      });
    });
  });
}

}  // namespace tracer
