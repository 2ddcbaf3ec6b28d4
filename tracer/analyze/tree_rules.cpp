// The rules for one tree.
#include "tracer/analyze/tree_rules.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "tracer/analyze/entry_rules.h"
#include "tracer/analyze/sah_test.h"
#include "tracer/analyze/split_rules.h"
#include "tracer/analyze/wide_rules.h"

namespace tracer {
namespace {

constexpr std::string_view axes = "xyz";

std::string_view primitive_name(const TreeToCheck& of) {
  return of.mesh != nullptr ? "triangle" : "instance";
}

void check_links(const TreeToCheck& of, FindingList& found) {
  const auto& nodes = of.tree.nodes;
  if (nodes.empty() != of.boxes.empty()) {
    found.add(none, none, [&] {
      return fmt::format("{} nodes over {} primitives", nodes.size(), of.boxes.size());
    });
  }
  std::vector<uint32_t> parent(nodes.size(), none);
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    if (is_leaf(nodes[i])) continue;
    const size_t left = nodes[i].first;
    if (left <= i || left + 1 >= nodes.size()) {
      found.add(i, none, [&] {
        return fmt::format("its children are {} and {}; they must come after it, within {} nodes",
                           left, left + 1, nodes.size());
      });
      continue;
    }
    for (const size_t child : {left, left + 1}) {
      if (parent[child] != none) {
        found.add(i, none, [&] {
          return fmt::format("its child {} is a child of node {}, too", child, parent[child]);
        });
      }
      parent[child] = i;
    }
  }
  for (uint32_t i = 1; i < nodes.size(); ++i) {
    if (parent[i] == none) found.add(i, none, [] { return "no node has it as a child"; });
  }
}

void check_leaf_ranges(const TreeToCheck& of, FindingList& found) {
  const size_t size = of.tree.references.size();
  std::vector<uint32_t> owner(size, none);
  for (uint32_t i = 0; i < of.tree.nodes.size(); ++i) {
    const BvhNode& node = of.tree.nodes[i];
    if (!is_leaf(node)) continue;
    if (size_t(node.first) + node.count > size) {
      found.add(i, none, [&] {
        return fmt::format("the leaf owns references {} to {} of {}", node.first,
                           size_t(node.first) + node.count - 1, size);
      });
      continue;
    }
    for (uint32_t slot = node.first; slot < node.first + node.count; ++slot) {
      if (owner[slot] != none) {
        found.add(i, none, [&] {
          return fmt::format("the leaf owns reference {}, and so does node {}", slot, owner[slot]);
        });
      }
      owner[slot] = i;
    }
  }
  const auto unowned = std::count(owner.begin(), owner.end(), none);
  if (unowned > 0) {
    found.add(none, none, [&] { return fmt::format("{} references are in no leaf", unowned); });
  }
}

void check_references(const TreeToCheck& of, FindingList& found) {
  for_each_reference(of.tree, [&](uint32_t node, uint32_t slot) {
    const uint32_t primitive = of.tree.references[slot];
    if (primitive < of.boxes.size()) return;
    found.add(node, none, [&] {
      return fmt::format("the leaf references {} {} of {}", primitive_name(of), primitive,
                         of.boxes.size());
    });
  });
}

// Edges from the root, by node.
std::vector<uint32_t> depths(const Bvh& tree) {
  std::vector<uint32_t> depth(tree.nodes.size());
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const BvhNode& node = tree.nodes[i];
    if (!is_leaf(node)) depth[node.first] = depth[node.first + 1] = depth[i] + 1;
  }
  return depth;
}

void check_depth(const TreeToCheck& of, FindingList& found) {
  if (of.tree.nodes.empty()) return;
  const std::vector<uint32_t> depth = depths(of.tree);
  const auto deepest = std::max_element(depth.begin(), depth.end());
  const auto node = uint32_t(deepest - depth.begin());
  if (*deepest != of.tree.depth) {
    found.add(node, none, [&] {
      return fmt::format("the deepest leaf is {} edges below the root; the tree says {}", *deepest,
                         of.tree.depth);
    });
  }
  if (*deepest > max_tree_depth) {
    found.add(node, none, [&] {
      return fmt::format("{} edges below the root; the traversal's stack ends at {}", *deepest,
                         max_tree_depth);
    });
  }
}

void check_leaf_triangles(const TreeToCheck& of, FindingList& found) {
  if (of.blas == nullptr) return;
  const UntouchedVector<LeafTriangle>& copies = of.blas->triangles;
  if (copies.size() != of.tree.references.size() + 1) {
    found.add(none, none, [&] {
      return fmt::format("{} leaf triangles for {} references; one of padding follows the last",
                         copies.size(), of.tree.references.size());
    });
    return;
  }
  for_each_reference(of.tree, [&](uint32_t node, uint32_t slot) {
    const uint32_t triangle = of.tree.references[slot];
    const LeafTriangle& copy = copies[slot];
    for (int k = 0; k < 3; ++k) {
      const vec3& corner = of.mesh->positions[of.mesh->triangles[triangle][k]];
      if (vec3(copy.x[k], copy.y[k], copy.z[k]) == corner) continue;
      found.add(node, triangle, [&] {
        return fmt::format("the copy of corner {} that the traversal reads differs from the mesh",
                           k);
      });
      return;
    }
  });
}

void check_finite(const TreeToCheck& of, FindingList& found) {
  for (uint32_t i = 0; i < of.tree.nodes.size(); ++i) {
    const BvhNode& node = of.tree.nodes[i];
    for (int axis = 0; axis < 3; ++axis) {
      const float lo = node.lo[axis];
      const float hi = node.hi[axis];
      if (std::isfinite(lo) && std::isfinite(hi) && lo <= hi) continue;
      found.add(i, none, [&] { return fmt::format("{} from {} to {}", axes[axis], lo, hi); });
      break;
    }
  }
}

void check_complete(const TreeToCheck& of, FindingList& found) {
  std::vector<bool> is_used(of.boxes.size());
  for_each_reference(of.tree,
                     [&](uint32_t, uint32_t slot) { is_used[of.tree.references[slot]] = true; });
  for (uint32_t i = 0; i < is_used.size(); ++i) {
    if (is_used[i]) continue;
    found.add(none, i, [&] { return fmt::format("{} {} is in no leaf", primitive_name(of), i); });
  }
}

// How far and where `inner` reaches out of `outer`.
std::string excess(const Box& outer, const Box& inner) {
  for (int axis = 0; axis < 3; ++axis) {
    if (inner.lo[axis] < outer.lo[axis]) {
      return fmt::format("{} below lo {}", outer.lo[axis] - inner.lo[axis], axes[axis]);
    }
    if (inner.hi[axis] > outer.hi[axis]) {
      return fmt::format("{} above hi {}", inner.hi[axis] - outer.hi[axis], axes[axis]);
    }
  }
  return "not a number";
}

void check_inside_parent(const TreeToCheck& of, FindingList& found) {
  for (uint32_t i = 0; i < of.tree.nodes.size(); ++i) {
    const BvhNode& node = of.tree.nodes[i];
    if (is_leaf(node)) continue;
    for (const uint32_t child : {node.first, node.first + 1}) {
      const Box box = box_of(of.tree.nodes[child]);
      if (contains(box_of(node), box)) continue;
      found.add(child, none, [&] {
        return fmt::format("reaches out of its parent {} by {}", i, excess(box_of(node), box));
      });
    }
  }
}

void check_leaf_box(const TreeToCheck& of, FindingList& found) {
  const std::vector<uint32_t> leaves = leaves_of_each(of);
  for_each_reference(of.tree, [&](uint32_t node, uint32_t slot) {
    const uint32_t primitive = of.tree.references[slot];
    const Box box = box_of(of.tree.nodes[node]);
    if (leaves[primitive] > 1 || contains(box, of.boxes[primitive])) return;
    found.add(node, primitive, [&] {
      return fmt::format("{} {} reaches out of its only leaf by {}", primitive_name(of), primitive,
                         excess(box, of.boxes[primitive]));
    });
  });
}

void check_siblings(const TreeToCheck& of, FindingList& found) {
  for (uint32_t i = 0; i < of.tree.nodes.size(); ++i) {
    const BvhNode& node = of.tree.nodes[i];
    if (is_leaf(node) || node.first % 2 == 1) continue;
    found.add(i, none, [&] {
      return fmt::format("its children {} and {} are in two cache lines", node.first,
                         node.first + 1);
    });
  }
}

void check_leaf_size(const TreeToCheck& of, FindingList& found) {
  for (uint32_t i = 0; i < of.tree.nodes.size(); ++i) {
    const uint32_t count = of.tree.nodes[i].count;
    if (count <= of.options.max_leaf_size) continue;
    found.add(i, none, [&] {
      return fmt::format("{} references in a leaf; the limit is {}", count,
                         of.options.max_leaf_size);
    });
  }
}

void check_sah(const TreeToCheck& of, FindingList& found) {
  const SahTest test = sah_test(of.tree, of.options.traversal_cost, of.options.intersection_cost,
                                sah_test_limits, {});
  if (holds(test)) return;
  found.add(0, none, [&] {
    return fmt::format("{} random lines cost {:.3f} each, plus or minus {:.3f}; SAH says {:.3f}",
                       test.lines, test.measured, test.standard_error, test.sah);
  });
}

constexpr TreeRule canonical_rules[] = {
    {"links", "Nodes make a tree",
     "Children come after their parent and next to each other; every node but the root has one "
     "parent; so there is no cycle.",
     Severity::error, true, check_links},
    {"leaf_ranges", "Leaves own the references", "Every reference is owned by exactly one leaf.",
     Severity::error, true, check_leaf_ranges},
    {"references", "References exist", "Every reference is a triangle of the mesh, or an instance.",
     Severity::error, true, check_references},
    {"depth", "Depth as stored",
     "The stored depth is that of the deepest leaf, and the traversal's stack is deep enough.",
     Severity::error, true, check_depth},
    {"leaf_triangles", "Triangles as in the mesh",
     "The copies that the traversal reads are the triangles that are referenced.", Severity::error,
     true, check_leaf_triangles},
    {"complete", "Nothing is missing", "Every triangle, or instance, is in some leaf.",
     Severity::error, false, check_complete},
    {"finite", "Boxes are finite", "No box has NaN, infinity or lo above hi.", Severity::error,
     false, check_finite},
    {"inside_parent", "Children inside parents", "Every box contains those of its children.",
     Severity::error, false, check_inside_parent},
    {"leaf_box", "Leaves cover what is in them",
     "The box of a leaf contains each triangle that is in no other leaf, to the bit.",
     Severity::error, false, check_leaf_box},
    {"covered", "Split triangles are covered",
     "Of a triangle in several leaves, corners and 25 more points are each in the box of one of "
     "them, but for what clipping rounds away. What lies between is left to the rays.",
     Severity::error, false, check_covered},
    {"sah", "SAH is what lines cost",
     "Random lines through the root that do not stop cost what the surface areas say.",
     Severity::error, false, check_sah},
    {"idle_reference", "Split triangles are there",
     "Of a triangle in several leaves, some part is in the box of each.", Severity::warning, false,
     check_idle_reference},
    {"siblings", "Siblings share a cache line",
     "Left children have odd indices, so both boxes are in one line of 64 bytes.",
     Severity::warning, false, check_siblings},
    {"leaf_size", "Leaves are as small as asked",
     "No leaf has more references than the builder's option says; the depth limit may force it.",
     Severity::warning, false, check_leaf_size},
};

// Those of the wide tree come late, and then those that look into two trees: a broken gate among
// them leaves out none of the others.
constexpr auto rows = [] {
  std::array<TreeRule, std::size(canonical_rules) + std::size(wide_rules) + std::size(entry_rules)>
      all{};
  const auto wide = std::copy(std::begin(canonical_rules), std::end(canonical_rules), all.begin());
  const auto entry = std::copy(std::begin(wide_rules), std::end(wide_rules), wide);
  std::copy(std::begin(entry_rules), std::end(entry_rules), entry);
  return all;
}();

}  // namespace

std::string_view name(Severity severity) {
  return severity == Severity::error ? "error" : "warning";
}

std::vector<Finding> FindingList::take() {
  if (count_ > max_findings) {
    found_.push_back(
        {rule_, severity_, of_.id, none, none, fmt::format("and {} more", count_ - max_findings)});
  }
  return std::move(found_);
}

std::span<const TreeRule> tree_rules() {
  return rows;
}

TreeVerdict check_tree(const TreeToCheck& tree) {
  TreeVerdict verdict;
  for (const TreeRule& rule : rows) {
    FindingList list(rule.id, rule.severity, tree);
    rule.check(tree, list);
    std::vector<Finding> found = list.take();
    if (rule.gate && !found.empty()) verdict.walkable = false;
    verdict.findings.insert(verdict.findings.end(), std::make_move_iterator(found.begin()),
                            std::make_move_iterator(found.end()));
    if (!verdict.walkable) break;
  }
  return verdict;
}

}  // namespace tracer
