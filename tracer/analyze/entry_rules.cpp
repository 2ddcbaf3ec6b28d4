// The rules for where instances are entered.
#include "tracer/analyze/entry_rules.h"

#include <algorithm>
#include <map>

#include "tracer/analyze/wide_walk.h"
#include "tracer/bvh/rebraid.h"

namespace tracer {
namespace {

bool has_entries(const TreeToCheck& of) {
  return of.scene != nullptr && !of.scene->entries.empty();
}

const Blas& blas_of(const SceneBvh& bvh, uint32_t instance) {
  return *bvh.blases[bvh.instances[instance].mesh];
}

// By node of the canonical tree what stands for it in the wide layout; no_child: nothing. All 0 in
// the binary one.
std::vector<WideChild> kept_nodes(const Blas& blas) {
  std::vector<WideChild> kept(blas.tree.nodes.size(), 0);
  std::visit(
      [&](const auto& wide) {
        if constexpr (requires { wide.nodes; }) {
          std::fill(kept.begin() + 1, kept.end(), no_child);
          for_each_slot(wide, [&](uint32_t i, int slot) {
            const uint32_t node = wide.nodes[i].binary[slot];
            if (node != 0) kept[node] = wide.nodes[i].child[slot];
          });
        }
      },
      blas.wide);
  return kept;
}

// An entry of the wide TLAS says the same as the TLAS itself.
void check_wide_entries(const TreeToCheck& of, FindingList& found) {
  in_wide(of, [&](const auto& wide) {
    for_each_leaf(wide, [&](size_t first, uint32_t i, int slot) {
      const uint32_t leaf = wide.nodes[i].binary[slot];
      size_t entry = first;
      for_references_below(of.tree, leaf, [&](uint32_t place) {
        const WideEntry& has = wide.entries[entry++];
        const uint32_t instance = has.instance & ~more_bit;
        if (instance == of.tree.references[place] && has.at == of.scene->entries[place]) return;
        found.add(leaf, instance, [&] {
          return fmt::format(
              "entry {} of the wide tree leads to node {} of instance {}; the tree to "
              "node {} of instance {}",
              entry - 1, has.at.node, instance, of.scene->entries[place].node,
              of.tree.references[place]);
        });
      });
    });
  });
}

}  // namespace

void check_entry_nodes(const TreeToCheck& of, FindingList& found) {
  if (!has_entries(of)) return;
  const SceneBvh& bvh = *of.scene;
  if (bvh.entries.size() != of.tree.references.size()) {
    found.add(none, none, [&] {
      return fmt::format("{} nodes to enter for {} references", bvh.entries.size(),
                         of.tree.references.size());
    });
    return;
  }
  std::vector<std::vector<WideChild>> kept(bvh.blases.size());
  for_each_reference(of.tree, [&](uint32_t leaf, uint32_t place) {
    const uint32_t instance = of.tree.references[place];
    const EntryPoint& entry = bvh.entries[place];
    std::vector<WideChild>& nodes = kept[bvh.instances[instance].mesh];
    if (nodes.empty()) nodes = kept_nodes(blas_of(bvh, instance));
    const bool there = entry.node < nodes.size() && nodes[entry.node] != no_child;
    if (there && nodes[entry.node] == entry.child) return;
    found.add(leaf, instance, [&] {
      return there ? fmt::format("instance {} is entered at node {}, but at wide node {}", instance,
                                 entry.node, entry.child)
                   : fmt::format("instance {} is entered at node {}, which its tree has not",
                                 instance, entry.node);
    });
  });
  check_wide_entries(of, found);
}

void check_entry_parts(const TreeToCheck& of, FindingList& found) {
  if (!has_entries(of)) return;
  const SceneBvh& bvh = *of.scene;
  std::map<uint32_t, std::vector<uint32_t>> entered;  // the nodes of each instance
  for (size_t place = 0; place < bvh.entries.size(); ++place)
    entered[of.tree.references[place]].push_back(bvh.entries[place].node);
  for (auto& [instance, nodes] : entered) {
    const Bvh& tree = blas_of(bvh, instance).tree;
    std::sort(nodes.begin(), nodes.end());
    // From the root down, parts once; below a node that is entered nothing else may be.
    size_t met = 0;
    uint32_t missing = none;
    std::vector<uint32_t> stack = {0};
    while (!stack.empty()) {
      const uint32_t node = stack.back();
      stack.pop_back();
      const auto [begin, end] = std::equal_range(nodes.begin(), nodes.end(), node);
      if (begin != end) {
        ++met;
      } else if (is_leaf(tree.nodes[node])) {
        missing = node;
      } else {
        stack.push_back(tree.nodes[node].first);
        stack.push_back(tree.nodes[node].first + 1);
      }
    }
    if (missing == none && met == nodes.size()) continue;
    found.add(none, instance, [&, id = instance, parts = nodes.size()] {
      return missing != none
                 ? fmt::format("leaf {} of instance {} is below no node where it is entered",
                               missing, id)
                 : fmt::format("instance {} is entered at {} nodes, of which {} are below others",
                               id, parts, parts - met);
    });
  }
}

void check_entry_boxes(const TreeToCheck& of, FindingList& found) {
  if (!has_entries(of)) return;
  const SceneBvh& bvh = *of.scene;
  std::vector<uint32_t> nodes;
  for (const EntryPoint& entry : bvh.entries)
    nodes.push_back(entry.node);
  const std::vector<Box> boxes = part_boxes(bvh, of.tree.references, nodes);
  for_each_reference(of.tree, [&](uint32_t leaf, uint32_t place) {
    if (contains(box_of(of.tree.nodes[leaf]), boxes[place])) return;
    found.add(leaf, of.tree.references[place], [&] {
      return fmt::format("node {} of instance {} reaches out of the leaf", nodes[place],
                         of.tree.references[place]);
    });
  });
}

}  // namespace tracer
