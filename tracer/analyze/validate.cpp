// Rules for every tree, then rays against brute force.
#include "tracer/analyze/validate.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "tracer/analyze/brute_force.h"
#include "tracer/analyze/random_lines.h"
#include "tracer/bvh/trace.h"
#include "tracer/math/normalize.h"

namespace tracer {
namespace {

constexpr uint64_t seed = 7;
constexpr float trees_share = 0.3f;  // of the progress

std::string text(const vec3& v) {
  return fmt::format("{} {} {}", v.x, v.y, v.z);
}

// Empty if the instance can be entered.
std::string fault(const PlacedInstance& instance, const Scene& scene) {
  if (instance.mesh >= scene.meshes.size()) {
    return fmt::format("its mesh is {} of {}", instance.mesh, scene.meshes.size());
  }
  const mat4 product = instance.to_object * instance.to_world;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      const float wanted = column == row ? 1.0f : 0.0f;
      if (std::abs(product[column][row] - wanted) <= 1e-3f) continue;
      return fmt::format("to_object times to_world is {} in row {}, column {}",
                         product[column][row], row, column);
    }
  }
  return "";
}

std::vector<Finding> check_instances(const Scene& scene, const SceneBvh& bvh) {
  std::vector<Finding> findings;
  for (uint32_t i = 0; i < bvh.instances.size() && findings.size() < max_findings; ++i) {
    const std::string wrong = fault(bvh.instances[i], scene);
    if (wrong.empty()) continue;
    findings.push_back({instances_rule, Severity::error, none, none, none,
                        fmt::format("instance {}: {}", i, wrong)});
  }
  return findings;
}

std::vector<Box> triangle_boxes(const Mesh& mesh) {
  std::vector<Box> boxes(mesh.triangles.size());
  for (size_t i = 0; i < boxes.size(); ++i) {
    for (int k = 0; k < 3; ++k)
      boxes[i] = grown(boxes[i], mesh.positions[mesh.triangles[i][k]]);
  }
  return boxes;
}

TreeVerdict check_blas(const Scene& scene, const SceneBvh& bvh, uint32_t mesh) {
  const Blas& blas = *bvh.blases[mesh];
  return check_tree({blas.tree, triangle_boxes(scene.meshes[mesh]), bvh.options,
                     &scene.meshes[mesh], &blas, mesh, &blas.wide});
}

TreeVerdict check_tlas(const SceneBvh& bvh) {
  const std::vector<Box> boxes = instance_boxes(bvh);
  return check_tree({bvh.tlas, boxes, bvh.options, nullptr, nullptr, none, &bvh.wide_tlas, &bvh});
}

// Ray `index` of the test.
Ray test_ray(const Scene& scene, const SceneBvh& bvh, const Box& box, uint64_t index) {
  Rng rng = make_rng(seed, index);
  const auto below = [&](size_t count) { return uint32_t(uint64_t(next(rng)) * count >> 32); };
  if (index % 4 < 2) return random_line(box, uniform(rng), rng);

  const PlacedInstance& instance = bvh.instances[below(bvh.instances.size())];
  const Mesh& mesh = scene.meshes[instance.mesh];
  const uvec3 corners = mesh.triangles[below(mesh.triangles.size())];
  const uint32_t corner = below(3);
  const vec3& a = mesh.positions[corners[corner]];
  const vec3& b = mesh.positions[corners[(corner + 1) % 3]];
  const float along = index % 4 == 2 ? 0.0f : uniform(rng);
  const vec3 target(instance.to_world * vec4(glm::mix(a, b, along), 1.0f));
  Ray ray;
  ray.origin = center(box) + safe_length(extent(box)) * uniform(rng) * direction_on_sphere(rng);
  ray.direction = target - ray.origin;
  return ray;
}

struct Comparison {
  Ray ray;
  Hit expected, found;
  bool shadow_differs = false;
};

Comparison compare(const SceneBvh& bvh, const BruteForce& brute_force, const Ray& ray) {
  NoProbe probe;
  Comparison result{ray, brute_force.intersect(ray), trace<false>(bvh, ray, probe), false};
  result.shadow_differs = is_hit(trace<true>(bvh, ray, probe)) != is_hit(result.expected);
  return result;
}
bool differs(const Comparison& comparison) {
  return !(comparison.expected == comparison.found) || comparison.shadow_differs;
}

std::string text(const Hit& hit) {
  if (!is_hit(hit)) return "nothing";
  return fmt::format("triangle {} of instance {} at t {}", hit.triangle, hit.instance, hit.t);
}

// The first leaf that references the triangle.
uint32_t leaf_of(const Bvh& tree, uint32_t triangle) {
  for (uint32_t i = 0; i < tree.nodes.size(); ++i) {
    const BvhNode& node = tree.nodes[i];
    for (uint32_t k = node.first; k < node.first + node.count; ++k) {
      if (tree.references[k] == triangle) return i;
    }
  }
  return none;
}

Finding finding_of(const SceneBvh& bvh, const Comparison& comparison) {
  const Hit& hit = is_hit(comparison.expected) ? comparison.expected : comparison.found;
  Finding finding{hits_rule, Severity::error, none, none, none, ""};
  if (is_hit(hit)) {
    finding.bvh = bvh.instances[hit.instance].mesh;
    finding.triangle = hit.triangle;
    finding.node = leaf_of(bvh.blases[finding.bvh]->tree, hit.triangle);
  }
  finding.message = fmt::format("ray from {} along {}: the BVH hits {}, brute force {}",
                                text(comparison.ray.origin), text(comparison.ray.direction),
                                text(comparison.found), text(comparison.expected));
  if (comparison.shadow_differs) finding.message += "; the any-hit traversal is wrong, too";
  return finding;
}

void check_rays(const Scene& scene, const SceneBvh& bvh, uint64_t rays, const Job& job,
                Validation& result) {
  const BruteForce brute_force(scene, bvh.instances);
  constexpr uint64_t steps = 200;  // of the progress
  const uint64_t step = std::max<uint64_t>((rays + steps - 1) / steps, 16);
  size_t told = 0;
  for (uint64_t begin = 0; begin < rays && !job.stopped(); begin += step) {
    std::vector<Comparison> compared(std::min(step, rays - begin));
    tbb::parallel_for(size_t{0}, compared.size(), [&](size_t i) {
      compared[i] =
          compare(bvh, brute_force, test_ray(scene, bvh, brute_force.bounds(), begin + i));
    });
    for (const Comparison& comparison : compared) {
      if (!differs(comparison)) continue;
      ++result.mismatches;
      if (told++ < max_findings) result.findings.push_back(finding_of(bvh, comparison));
    }
    result.rays_checked += compared.size();
    job.progress(trees_share + (1.0f - trees_share) * float(result.rays_checked) / float(rays),
                 "comparing rays with brute force");
  }
  if (told > max_findings) {
    result.findings.push_back({hits_rule, Severity::error, none, none, none,
                               fmt::format("and {} more", told - max_findings)});
  }
}

}  // namespace

bool has_errors(const Validation& validation) {
  return std::any_of(validation.findings.begin(), validation.findings.end(),
                     [](const Finding& finding) { return finding.severity == Severity::error; });
}

uint64_t default_ray_count(const Scene& scene) {
  // Most instances are left out by their box: a ray through n of them, evenly spread, meets the
  // boxes of some cube roots of n.
  constexpr double triangle_tests = 6e8;
  double triangles = 0.0;
  for (const Instance& instance : scene.instances)
    triangles += double(scene.meshes[instance.mesh].triangles.size());
  const auto instances = double(scene.instances.size());
  const double met = std::min(instances, 4.0 * std::cbrt(instances));
  const double tests = std::max(1.0, instances + met * triangles / std::max(1.0, instances));
  return std::clamp<uint64_t>(uint64_t(triangle_tests / tests), 100, 20'000);
}

Validation validate(const Scene& scene, const SceneBvh& bvh, uint64_t rays, const Job& job) {
  Validation result;
  job.progress(0.0f, "checking the trees");
  result.findings = check_instances(scene, bvh);
  bool walkable = result.findings.empty();

  std::vector<TreeVerdict> verdicts(bvh.blases.size() + 1);  // the first is the TLAS's
  tbb::parallel_for(size_t{1}, verdicts.size(), [&](size_t i) {
    if (!job.stopped()) verdicts[i] = check_blas(scene, bvh, uint32_t(i - 1));
  });
  // The TLAS is built over nodes of the BLASes.
  walkable = walkable && std::all_of(bvh.blases.begin(), bvh.blases.end(),
                                     [](const auto& blas) { return !blas->tree.nodes.empty(); });
  for (const TreeVerdict& verdict : verdicts)
    walkable = walkable && verdict.walkable;
  if (walkable && !job.stopped()) verdicts[0] = check_tlas(bvh);
  walkable = walkable && verdicts[0].walkable;
  for (TreeVerdict& verdict : verdicts) {
    result.findings.insert(result.findings.end(), std::make_move_iterator(verdict.findings.begin()),
                           std::make_move_iterator(verdict.findings.end()));
  }
  if (job.stopped()) return result;
  result.trees_checked = verdicts.size();
  job.progress(trees_share, "checking the trees");
  if (walkable && !bvh.instances.empty()) check_rays(scene, bvh, rays, job, result);
  return result;
}

}  // namespace tracer
