// Priorities of nodes, from the leaves up.
#include "tracer/bvh/occlusion_order.h"

#include <cmath>

#include "tracer/bvh/bottom_up.h"

namespace tracer {
namespace {

constexpr OcclusionOrderRow rows[] = {
    {"tree", "As in the tree", "From the right to the left, as widening has left them.", ""},
    {"area", "Largest first (SATO)", "The child of the largest box first.",
     "J.-H. Nah, D. Manocha, SATO: Surface Area Traversal Order for Shadow Ray Tracing, 2014"},
    {"cost", "Likely, cheap first",
     "The child first whose cost, by SAH, is lowest for its chance to block a ray: that of a "
     "random line through its box to meet its triangles. The TLAS keeps its order.",
     "T. Ize, C. Hansen, RTSAH Traversal Order for Occlusion Rays, 2011; S. Ogaki, A. "
     "Derouet-Jourdan, An N-ary BVH Child Node Sorting Technique for Occlusion Tests, 2016"},
};

float area_of(const LeafTriangle& t) {
  const vec3 a(t.x[0], t.y[0], t.z[0]), b(t.x[1], t.y[1], t.z[1]), c(t.x[2], t.y[2], t.z[2]);
  return 0.5f * glm::length(glm::cross(b - a, c - a));
}

// A random line that meets a convex box meets surfaces of area T inside it 2 T / (area of the box)
// times on average (M. Crofton, On the Theory of Local Probability, 1868): were these meetings
// independent, it would be blocked with probability 1 - exp(-that).
std::vector<float> blocking_per_cost(const Bvh& tree, std::span<const LeafTriangle> triangles,
                                     const BuildOptions& options) {
  struct Below {
    float triangle_area = 0.0f;
    float cost = 0.0f;  // SAH, times half the area of the node
  };
  std::vector<Below> below(tree.nodes.size());
  std::vector<float> priorities(tree.nodes.size());
  for_nodes_bottom_up(std::span(tree.nodes), [&](const BvhNode& node) {
    const auto index = size_t(&node - tree.nodes.data());
    const float area = half_area(box_of(node));
    Below& own = below[index];
    if (is_leaf(node)) {
      for (uint32_t i = node.first; i < node.first + node.count; ++i)
        own.triangle_area += area_of(triangles[i]);
      own.cost = area * options.intersection_cost * float(node.count);
    } else {
      const Below& left = below[node.first];
      const Below& right = below[node.first + 1];
      own.triangle_area = left.triangle_area + right.triangle_area;
      own.cost = area * options.traversal_cost + left.cost + right.cost;
    }
    const float blocked = area > 0.0f ? 1.0f - std::exp(-own.triangle_area / area) : 0.0f;
    priorities[index] = own.cost > 0.0f ? blocked * area / own.cost : 0.0f;
  });
  return priorities;
}

}  // namespace

std::span<const OcclusionOrderRow> occlusion_orders() {
  return rows;
}

std::vector<float> occlusion_priorities(const Bvh& tree, std::span<const LeafTriangle> triangles,
                                        const BuildOptions& options) {
  if (options.occlusion_order == "cost" && !triangles.empty())
    return blocking_per_cost(tree, triangles, options);
  if (options.occlusion_order != "area") return {};
  std::vector<float> areas;
  areas.reserve(tree.nodes.size());
  for (const BvhNode& node : tree.nodes)
    areas.push_back(half_area(box_of(node)));
  return areas;
}

}  // namespace tracer
