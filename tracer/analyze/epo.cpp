// EPO by Monte Carlo: random points of the surface, each a point query that leaves out the
// ancestors (T. Aila, T. Karras, S. Laine, On Quality Metrics of Bounding Volume Hierarchies,
// 2013).
#include "tracer/analyze/epo.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>

#include "tracer/analyze/ancestry.h"
#include "tracer/analyze/surface_points.h"

namespace tracer {
namespace {

constexpr uint64_t seed = 20130701;

struct Costs {
  double traversal, intersection;
};
double cost(const BvhNode& node, const Costs& costs) {
  return is_leaf(node) ? node.count * costs.intersection : costs.traversal;
}

bool contains(const BvhNode& node, const vec3& p) {
  return p.x >= node.lo.x && p.x <= node.hi.x && p.y >= node.lo.y && p.y <= node.hi.y &&
         p.z >= node.lo.z && p.z <= node.hi.z;
}

// Calls visit(node) for `top` and the nodes below it whose box holds the point.
template <class Visit>
void for_each_holding(const Bvh& tree, uint32_t top, const vec3& point, const Visit& visit) {
  if (!contains(tree.nodes[top], point)) return;
  assert(tree.depth <= max_tree_depth);
  std::array<uint32_t, max_tree_depth + 2> stack;
  uint32_t waiting = 0;
  stack[waiting++] = top;
  while (waiting > 0) {
    const uint32_t now = stack[--waiting];
    visit(now);
    const BvhNode& node = tree.nodes[now];
    if (is_leaf(node)) continue;
    for (const uint32_t child : {node.first, node.first + 1}) {
      if (contains(tree.nodes[child], point)) stack[waiting++] = child;
    }
  }
}

uint32_t sibling(const Bvh& tree, uint32_t node, uint32_t parent) {
  const uint32_t left = tree.nodes[parent].first;
  return left == node ? left + 1 : left;
}

// Calls visit(node) for the nodes whose box holds the point and which are not above the primitive:
// they hang to the side of the way from its leaf to the root, or of its ways.
template <class Visit>
void for_each_overlap(const Bvh& tree, const Ancestry& ancestry, const vec3& point,
                      uint32_t primitive, const Visit& visit) {
  const std::span<const uint32_t> leaves = ancestry.leaves(primitive);
  std::vector<uint32_t> ways;  // of several leaves: the nodes on any of them
  if (leaves.size() > 1) {
    for (const uint32_t leaf : leaves) {
      for (uint32_t node = leaf; node != none; node = ancestry.parent(node))
        ways.push_back(node);
    }
    std::sort(ways.begin(), ways.end());
    ways.erase(std::unique(ways.begin(), ways.end()), ways.end());
    for (const uint32_t node : ways) {
      if (node == 0) continue;
      const uint32_t side = sibling(tree, node, ancestry.parent(node));
      if (std::binary_search(ways.begin(), ways.end(), side)) continue;
      for_each_holding(tree, side, point, visit);
    }
    return;
  }
  for (const uint32_t leaf : leaves) {
    for (uint32_t node = leaf; node != 0; node = ancestry.parent(node))
      for_each_holding(tree, sibling(tree, node, ancestry.parent(node)), point, visit);
  }
}

// sample(share, rng, add) calls add(tree, node) for each node that overlaps one random point.
template <class Sample>
Epo estimate_epo(std::span<const Bvh* const> trees, const Costs& costs, const SampleLimits& limits,
                 const std::stop_token& stop, const Sample& sample) {
  std::vector<std::vector<uint32_t>> counts;  // of overlaps, by tree and node
  for (const Bvh* tree : trees)
    counts.emplace_back(tree->nodes.size());
  const Estimate estimate = estimate_mean(limits, seed, stop, [&](double share, Rng& rng) {
    double sum = 0.0;
    sample(share, rng, [&](uint32_t tree, uint32_t node) {
      sum += cost(trees[tree]->nodes[node], costs);
      std::atomic_ref(counts[tree][node]).fetch_add(1, std::memory_order_relaxed);
    });
    return sum;
  });

  Epo result{estimate.mean, estimate.standard_error, estimate.samples, {}};
  const double one = 1.0 / double(std::max<uint64_t>(estimate.samples, 1));
  for (size_t tree = 0; tree < trees.size(); ++tree) {
    std::vector<float>& shares = result.node_shares.emplace_back(counts[tree].size());
    for (size_t i = 0; i < shares.size(); ++i)
      shares[i] = float(counts[tree][i] * one * cost(trees[tree]->nodes[i], costs));
  }
  return result;
}

// Trees over meshes. A tree is chosen by its number of triangles, a point in it by area.
Epo epo_of_meshes(std::span<const Mesh* const> meshes, std::span<const Bvh* const> trees,
                  const Costs& costs, const SampleLimits& limits, const std::stop_token& stop) {
  std::vector<AreaTable> areas(meshes.size());
  std::vector<Ancestry> ancestries(meshes.size());
  tbb::parallel_for(size_t{0}, 2 * meshes.size(), [&](size_t i) {
    const size_t mesh = i / 2;
    if (i % 2 == 0) {
      areas[mesh] = area_table(*meshes[mesh]);
    } else {
      ancestries[mesh] = Ancestry(*trees[mesh], meshes[mesh]->triangles.size());
    }
  });
  std::vector<double> sums;  // of triangles
  for (const Mesh* mesh : meshes)
    sums.push_back((sums.empty() ? 0.0 : sums.back()) + double(mesh->triangles.size()));
  if (sums.empty() || sums.back() == 0.0) return {};

  return estimate_epo(trees, costs, limits, stop, [&](double share, Rng& rng, const auto& add) {
    const Choice tree = choose(sums, share);
    const Choice triangle = choose(areas[tree.index].sums, tree.rest);
    const double v = uniform(rng);
    const vec3 point = point_in_triangle(*meshes[tree.index], triangle.index, triangle.rest, v);
    for_each_overlap(*trees[tree.index], ancestries[tree.index], point, triangle.index,
                     [&](uint32_t node) { add(tree.index, node); });
  });
}

// What an affine map does to areas: a surface of area vector a (along its normal, as long as its
// area) becomes one of area vector cofactor * a. The bound holds for |cofactor * a| / |a|; it is
// reached by similarities.
struct AreaMap {
  glm::dmat3 cofactor;
  double bound;
};
AreaMap area_map(const mat4& transform) {
  const glm::dmat3 m{mat3(transform)};
  const glm::dmat3 cofactor(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  const glm::dmat3 square = glm::transpose(cofactor) * cofactor;
  double largest = 0.0;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 row = glm::abs(square[i]);
    largest = std::max(largest, row.x + row.y + row.z);
  }
  return {cofactor, std::sqrt(largest)};
}

glm::dvec3 area_vector(const Mesh& mesh, uint32_t triangle) {
  const uvec3 corners = mesh.triangles[triangle];
  const glm::dvec3 a(mesh.positions[corners.x]);
  return glm::cross(glm::dvec3(mesh.positions[corners.y]) - a,
                    glm::dvec3(mesh.positions[corners.z]) - a);
}

}  // namespace

Epo epo(const Mesh& mesh, const Bvh& tree, float traversal_cost, float intersection_cost,
        const SampleLimits& limits, const std::stop_token& stop) {
  const Mesh* const meshes[] = {&mesh};
  const Bvh* const trees[] = {&tree};
  return epo_of_meshes(meshes, trees, {traversal_cost, intersection_cost}, limits, stop);
}

Epo blas_epo(const Scene& scene, const SceneBvh& bvh, const SampleLimits& limits,
             const std::stop_token& stop) {
  std::vector<const Mesh*> meshes;
  std::vector<const Bvh*> trees;
  for (size_t i = 0; i < bvh.blases.size(); ++i) {
    meshes.push_back(&scene.meshes[i]);
    trees.push_back(&bvh.blases[i]->tree);
  }
  return epo_of_meshes(meshes, trees, {bvh.options.traversal_cost, bvh.options.intersection_cost},
                       limits, stop);
}

Epo tlas_epo(const Scene& scene, const SceneBvh& bvh, const SampleLimits& limits,
             const std::stop_token& stop) {
  if (bvh.instances.empty()) return {};
  std::vector<AreaTable> areas(scene.meshes.size());
  tbb::parallel_for(size_t{0}, areas.size(),
                    [&](size_t i) { areas[i] = area_table(scene.meshes[i]); });
  const Ancestry ancestry(bvh.tlas, bvh.instances.size());
  std::vector<AreaMap> maps;
  std::vector<double> sums;  // of areas in the world, at most
  for (const PlacedInstance& instance : bvh.instances) {
    maps.push_back(area_map(instance.to_world));
    sums.push_back((sums.empty() ? 0.0 : sums.back()) +
                   total(areas[instance.mesh]) * maps.back().bound);
  }
  const Bvh* const trees[] = {&bvh.tlas};
  const Costs costs = {bvh.options.traversal_cost, bvh.options.intersection_cost};
  return estimate_epo(trees, costs, limits, stop, [&](double share, Rng& rng, const auto& add) {
    // Rejection: a surface that its map stretches less than the bound is taken less often. The next
    // try comes from anywhere, so that all strata together still are an even sample.
    constexpr int most_tries = 1000;
    for (int i = 0; i < most_tries; ++i) {
      const Choice chosen = choose(sums, share);
      const PlacedInstance& instance = bvh.instances[chosen.index];
      const Mesh& mesh = scene.meshes[instance.mesh];
      const Choice triangle = choose(areas[instance.mesh].sums, chosen.rest);
      const double v = uniform(rng);
      const double accept = uniform(rng);
      share = next(rng) * 0x1p-32;
      const AreaMap& map = maps[chosen.index];
      const glm::dvec3 area = area_vector(mesh, triangle.index);
      if (accept * map.bound * glm::length(area) > glm::length(map.cofactor * area)) continue;
      const vec3 point = point_in_triangle(mesh, triangle.index, triangle.rest, v);
      for_each_overlap(bvh.tlas, ancestry, vec3(instance.to_world * vec4(point, 1.0f)),
                       chosen.index, [&](uint32_t node) { add(0u, node); });
      return;
    }
  });
}

}  // namespace tracer
