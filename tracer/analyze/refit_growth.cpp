// How much the nodes of refitted trees have grown since they were built.
#include "tracer/analyze/refit_growth.h"

#include <algorithm>

namespace tracer {
namespace {

// The area at the build that a node counts with.
float built_area(const Blas& blas, size_t node) {
  const std::vector<float>& areas = *blas.built_areas;
  return std::max({areas[node], 1e-6f * areas[0], std::numeric_limits<float>::min()});
}

float growth_of(const Blas& blas, size_t node) {
  const float now = half_area(box_of(blas.tree.nodes[node]));
  if (now == (*blas.built_areas)[node]) return 1.0f;
  return std::min(now / built_area(blas, node), std::numeric_limits<float>::max());
}

}  // namespace

std::vector<float> node_growth(const Blas& blas) {
  std::vector<float> growth(blas.tree.nodes.size(), 1.0f);
  if (!blas.built_areas) return growth;
  for (size_t i = 0; i < growth.size(); ++i)
    growth[i] = growth_of(blas, i);
  return growth;
}

std::vector<float> triangle_growth(const Blas& blas, size_t triangles) {
  std::vector<float> growth(triangles, blas.built_areas ? 0.0f : 1.0f);
  if (!blas.built_areas) return growth;
  for (size_t i = 0; i < blas.tree.nodes.size(); ++i) {
    const BvhNode& node = blas.tree.nodes[i];
    if (!is_leaf(node)) continue;
    const float leaf = growth_of(blas, i);
    for (uint32_t k = node.first; k < node.first + node.count; ++k) {
      float& triangle = growth[blas.tree.references[k]];
      triangle = std::max(triangle, leaf);
    }
  }
  return growth;
}

RefitGrowth refit_growth(const SceneBvh& bvh) {
  RefitGrowth result;
  const bool refitted = std::any_of(bvh.blases.begin(), bvh.blases.end(),
                                    [](const auto& blas) { return blas->built_areas != nullptr; });
  if (!refitted) return result;
  double areas = 0.0;
  double weighted = 0.0;
  for (uint32_t mesh = 0; mesh < bvh.blases.size(); ++mesh) {
    const Blas& blas = *bvh.blases[mesh];
    if (!blas.built_areas) {
      for (const BvhNode& node : blas.tree.nodes) {
        const double area = half_area(box_of(node));
        areas += area;
        weighted += area;
      }
      continue;
    }
    for (uint32_t node = 0; node < blas.tree.nodes.size(); ++node) {
      const float growth = growth_of(blas, node);
      const double area = built_area(blas, node);
      areas += area;
      weighted += area * growth;
      if (result.node != none && growth <= float(result.max)) continue;
      result.max = growth;
      result.mesh = mesh;
      result.node = node;
    }
  }
  if (areas > 0.0 && result.node != none) result.mean = weighted / areas;
  return result;
}

}  // namespace tracer
