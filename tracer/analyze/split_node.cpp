// Collecting what is below a node.
#include "tracer/analyze/split_node.h"

#include <algorithm>

#include <tbb/parallel_sort.h>

#include "tracer/bvh/rebraid.h"

namespace tracer {
namespace {

Box part_of(const Mesh& mesh, uint32_t triangle, const Box& node) {
  Box whole;
  for (int i = 0; i < 3; ++i)
    whole = grown(whole, mesh.positions[mesh.triangles[triangle][i]]);
  if (contains(node, whole)) return whole;
  const Corners corners = corners_of(mesh, triangle);
  Bounds rest = as_bounds(whole);
  for (int axis = 0; axis < 3; ++axis) {
    if (rest.lo[axis] < node.lo[axis]) rest = clip(corners, rest, axis, node.lo[axis]).right;
    if (rest.hi[axis] > node.hi[axis]) rest = clip(corners, rest, axis, node.hi[axis]).left;
  }
  const Box part{xyz(rest.lo), xyz(rest.hi)};
  return is_empty(part) ? intersected(whole, node) : part;
}

}  // namespace

std::vector<uint32_t> primitives_below(const TreeTable& table, uint32_t node) {
  std::vector<uint32_t> found, stack = {node};
  while (!stack.empty()) {
    const uint32_t at = stack.back();
    const TableNode& row = table.nodes[at];
    stack.pop_back();
    if (is_leaf(row)) {
      for (uint32_t i = row.first; i < row.first + row.references; ++i)
        found.push_back(table.entries.empty() ? table.references[i] : i);
    }
    for (const uint32_t child : children_of(table, at))
      stack.push_back(child);
  }
  tbb::parallel_sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

NodeParts parts_below(const Scene& scene, const SceneBvh& bvh, const TreeTable& table,
                      uint32_t mesh, uint32_t node) {
  NodeParts parts{primitives_below(table, node), {}};
  const Box& box = table.nodes[node].box;
  const bool in_parts = !table.entries.empty();
  const std::vector<Box> instances = mesh != none ? std::vector<Box>()
                                     : in_parts   ? part_boxes(bvh, table.references, table.entries)
                                                  : instance_boxes(bvh);
  parts.boxes.resize(parts.primitives.size());
  for_chunks(0, uint32_t(parts.boxes.size()), [&](size_t, uint32_t begin, uint32_t end) {
    for (uint32_t i = begin; i < end; ++i) {
      const uint32_t primitive = parts.primitives[i];
      parts.boxes[i] =
          mesh == none ? instances[primitive] : part_of(scene.meshes[mesh], primitive, box);
    }
  });
  return parts;
}

}  // namespace tracer
