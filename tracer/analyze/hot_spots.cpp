// The most expensive nodes against their prediction. The causes are told by rules of thumb, from
// what the boxes below a node look like.
#include "tracer/analyze/hot_spots.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "tracer/analyze/overlap.h"

namespace tracer {
namespace {

constexpr double much_overlap = 0.25;   // of the node's area, in common to two of its children
constexpr double much_empty = 0.75;     // of its volume
constexpr double thin_triangle = 0.15;  // area of a triangle / half area of its box
constexpr double fills_leaf = 0.7;      // half area of the triangle's box / that of its leaf
constexpr uint32_t many_references = 2 * block_size + 1;  // widening merges leaves of up to less
constexpr size_t considered = 4096;  // nodes of each tree that reasons are looked for

struct Candidate {
  uint32_t mesh, node;
  double visits, predicted, excess;
};

double unit_cost(const TreeTable& table, uint32_t node) {
  const TableNode& row = table.nodes[node];
  return is_leaf(row) ? double(row.references) * double(table.intersection_cost)
                      : double(table.traversal_cost);
}

Box box_of(const Mesh& mesh, uint32_t triangle) {
  Box box;
  for (int k = 0; k < 3; ++k)
    box = grown(box, mesh.positions[mesh.triangles[triangle][k]]);
  return box;
}

double area_of(const Mesh& mesh, uint32_t triangle) {
  const uvec3& corner = mesh.triangles[triangle];
  const glm::dvec3 a(mesh.positions[corner.x]);
  return 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[corner.y]) - a,
                                      glm::dvec3(mesh.positions[corner.z]) - a));
}

double longest_edge(const Mesh& mesh, uint32_t triangle) {
  const uvec3& corner = mesh.triangles[triangle];
  double longest = 0.0;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 edge(mesh.positions[corner[(k + 1) % 3]] - mesh.positions[corner[k]]);
    longest = std::max(longest, glm::length(edge));
  }
  return longest;
}

// Leaves whose box has something in common with the box, counted up to a limit.
uint64_t leaves_in(const TreeTable& table, const Box& box) {
  constexpr uint64_t limit = 1'000'000;
  uint64_t count = 0;
  std::vector<uint32_t> stack = {0};
  while (!stack.empty() && count < limit) {
    const uint32_t node = stack.back();
    const TableNode& row = table.nodes[node];
    stack.pop_back();
    if (is_empty(intersected(row.box, box))) continue;
    if (is_leaf(row)) {
      ++count;
      continue;
    }
    for (const uint32_t child : children_of(table, node))
      stack.push_back(child);
  }
  return count;
}

// "entered 240 times, 2.4 times what its surface predicts".
std::string against_prediction(const HotSpot& spot) {
  if (!(spot.predicted > 0.0)) return fmt::format("entered {:.0f} times", spot.visits);
  return fmt::format("entered {:.0f} times, {:.3g} times what its surface predicts", spot.visits,
                     spot.visits / spot.predicted);
}

// The triangle of a leaf that makes its box large and fills little of it.
uint32_t large_triangle(const Mesh& mesh, const TreeTable& table, const TableNode& leaf) {
  uint32_t found = none;
  double most = 0.0;
  for (uint32_t i = leaf.first; i < leaf.first + leaf.references; ++i) {
    const uint32_t triangle = table.references[i];
    if (triangle >= mesh.triangles.size()) continue;
    const double box = half_area(intersected(box_of(mesh, triangle), leaf.box));
    const double leaf_box = half_area(leaf.box);
    if (!(leaf_box > 0.0) || box < fills_leaf * leaf_box || box <= most) continue;
    if (area_of(mesh, triangle) > thin_triangle * half_area(box_of(mesh, triangle))) continue;
    most = box;
    found = triangle;
  }
  return found;
}

void explain_leaf(const Scene& scene, const TreeTable& table, HotSpot& spot) {
  const TableNode& leaf = table.nodes[spot.node];
  const Mesh& mesh = scene.meshes[spot.mesh];
  spot.triangle = large_triangle(mesh, table, leaf);
  if (spot.triangle != none) {
    spot.cause = HotCause::large_triangle;
    const Box box = intersected(box_of(mesh, spot.triangle), leaf.box);
    spot.text = fmt::format(
        "Triangle {}, {:.3g} long, fills {:.1f} % of its box and lies in the way of {} leaves: "
        "pre-split it, or build with SBVH",
        spot.triangle, longest_edge(mesh, spot.triangle),
        100.0 * area_of(mesh, spot.triangle) / double(half_area(box_of(mesh, spot.triangle))),
        leaves_in(table, box));
  } else if (leaf.references >= many_references) {
    spot.cause = HotCause::full_leaf;
    spot.text = fmt::format(
        "{} triangles in one leaf, all tested whenever it is entered: lower the leaf size; if it "
        "cannot be split, the triangles lie upon each other",
        leaf.references);
  } else {
    spot.text = fmt::format("Leaf of {} triangles, {}: the view looks here", leaf.references,
                            against_prediction(spot));
  }
}

void explain_inner(const TreeTable& table, HotSpot& spot) {
  const TableNode& row = table.nodes[spot.node];
  std::vector<Box> children;
  for (const uint32_t child : children_of(table, spot.node))
    children.push_back(table.nodes[child].box);
  const ChildFit fit = child_fit(row.box, children);
  const char* cure = table.tlas ? "instances overlap; move them apart, or split their meshes"
                                : "build with SBVH or pre-splitting, or optimize by reinsertion";
  // Each child may overlap each other one: as much as two children would have, for every further
  // one.
  if (fit.overlap > much_overlap * double(children.size() - 1)) {
    spot.cause = table.tlas ? HotCause::instances : HotCause::overlap;
    const double common = 100.0 * fit.overlap;
    spot.text = children.size() == 2
                    ? fmt::format(
                          "Its children have {:.0f} % of its area in common, so most rays "
                          "take both: {}",
                          common, cure)
                    : fmt::format(
                          "Pairs of its {} children have {:.0f} % of its area in common, "
                          "added up, so most rays take several: {}",
                          children.size(), common, cure);
  } else if (fit.empty_space > much_empty) {
    spot.cause = HotCause::empty_space;
    spot.text = fmt::format("{:.0f} % of its box is empty, and rays pass through it for nothing",
                            100.0 * fit.empty_space);
  } else {
    spot.text = fmt::format("Node over {} {}, {}: the view looks here", row.references,
                            references_name(table), against_prediction(spot));
  }
}

void explain(const Scene& scene, const TreeTable& table, HotSpot& spot) {
  const TableNode& row = table.nodes[spot.node];
  if (!is_leaf(row)) {
    explain_inner(table, spot);
  } else if (!table.tlas) {
    explain_leaf(scene, table, spot);
  } else {
    spot.cause = HotCause::instances;
    spot.triangle = table.references[row.first];
    spot.text = fmt::format("Instance {}, {}; the boxes of {} other leaves lie in its way",
                            spot.triangle, against_prediction(spot), leaves_in(table, row.box) - 1);
  }
}

// How often random lines through the root would enter the node if it were as it should be: by its
// area, or by that of its triangles in a leaf, whose box can be as large as it likes.
double ideal_share(const Scene& scene, const TreeTable& table, uint32_t mesh, uint32_t node) {
  const double share = area_share(table, node);
  const TableNode& row = table.nodes[node];
  const double root = half_area(table.nodes[0].box);
  if (table.tlas || !is_leaf(row) || !(root > 0.0)) return share;
  double triangles = 0.0;
  for (uint32_t i = row.first; i < row.first + row.references; ++i)
    triangles += area_of(scene.meshes[mesh], table.references[i]);
  return std::min(share, triangles / root);
}

bool costs_more(const Candidate& a, const Candidate& b) {
  return a.excess != b.excess ? a.excess > b.excess : a.node < b.node;
}

// The nodes of one tree that cost most beyond the prediction. of_root: how many rays enter the
// tree.
std::vector<Candidate> candidates(const Scene& scene, const TreeTable& table, uint32_t mesh,
                                  const std::vector<uint32_t>& visits, double of_root,
                                  double& cost) {
  std::vector<Candidate> found;  // a heap, on top the one that costs least
  for (uint32_t node = 0; node < table.nodes.size(); ++node) {
    if (visits[node] == 0) continue;
    const double all = visits[node] * unit_cost(table, node);
    cost += all;
    const bool full = found.size() == considered;
    if (full && all <= found.front().excess) continue;  // spares a look at the triangles
    const double predicted = of_root * ideal_share(scene, table, mesh, node);
    const double excess = (visits[node] - predicted) * unit_cost(table, node);
    if (excess <= 0.0 || (full && excess <= found.front().excess)) continue;
    if (full) {
      std::pop_heap(found.begin(), found.end(), costs_more);
      found.pop_back();
    }
    found.push_back({mesh, node, double(visits[node]), predicted, excess});
    std::push_heap(found.begin(), found.end(), costs_more);
  }
  std::sort_heap(found.begin(), found.end(), costs_more);
  return found;
}

}  // namespace

std::string_view name(HotCause cause) {
  constexpr std::string_view names[] = {"large triangle", "overlap",   "empty space",
                                        "full leaf",      "instances", "view"};
  return names[static_cast<size_t>(cause)];
}

HotSpots hot_spots(const Scene& scene, const std::shared_ptr<const Inspection>& inspection,
                   const std::shared_ptr<const CountedVisits>& counted, int ray_class, size_t most,
                   const Job& job) {
  HotSpots result{inspection, counted, ray_class, 0.0, {}};
  if (!inspection || !counted || !counted->visits || inspection->bvh != counted->bvh) return result;
  job.progress(0.0f, "looking for hot nodes");
  std::vector<Candidate> all;
  for (uint32_t i = 0; i <= inspection->blases.size() && !job.stopped(); ++i) {
    const uint32_t mesh = i == inspection->blases.size() ? none : i;
    const TreeTable* table = table_of(*inspection, mesh);
    if (table == nullptr || table->nodes.empty()) continue;
    const auto visits = tree_visits(*counted->visits, mesh, ray_class);
    const double of_root = root_visits(*inspection, mesh, visits);
    const auto found = candidates(scene, *table, mesh, visits, of_root, result.cost);
    all.insert(all.end(), found.begin(), found.end());
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.excess > b.excess; });
  std::map<std::pair<uint32_t, uint32_t>, size_t> triangles;  // that have a spot
  size_t of_view = 0;
  for (const Candidate& candidate : all) {
    if (result.spots.size() - of_view >= most || job.stopped()) break;
    HotSpot spot;
    spot.mesh = candidate.mesh;
    spot.node = candidate.node;
    spot.visits = candidate.visits;
    spot.predicted = candidate.predicted;
    spot.excess = result.cost > 0.0 ? candidate.excess / result.cost : 0.0;
    explain(scene, *table_of(*inspection, spot.mesh), spot);
    if (spot.cause == HotCause::view && ++of_view > most) {
      --of_view;
      continue;
    }
    if (spot.cause == HotCause::large_triangle) {  // pieces of it may lie in many leaves
      const auto [at, is_new] =
          triangles.try_emplace({spot.mesh, spot.triangle}, result.spots.size());
      if (!is_new) {
        result.spots[at->second].excess += spot.excess;
        continue;
      }
    }
    result.spots.push_back(std::move(spot));
  }
  std::stable_sort(result.spots.begin(), result.spots.end(),
                   [](const HotSpot& a, const HotSpot& b) { return a.excess > b.excess; });
  return result;
}

}  // namespace tracer
