// Building and placing: one BLAS a mesh, one TLAS over the instances.
#include "tracer/bvh/scene_bvh.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "tracer/bvh/leaf_order.h"
#include "tracer/clock.h"
#include "tracer/math/normalize.h"
#include "tracer/math/simd.h"

namespace tracer {

namespace {

constexpr size_t grain = 2048;  // triangles that a parallel pass hands to one task

UntouchedVector<Box> triangle_boxes(const Mesh& mesh) {
  UntouchedVector<Box> boxes(mesh.triangles.size());
  tbb::parallel_for(tbb::blocked_range<size_t>(0, boxes.size(), grain), [&](const auto& range) {
    for (size_t i = range.begin(); i < range.end(); ++i) {
      const uvec3 corners = mesh.triangles[i];
      const vec3& a = mesh.positions[corners.x];
      const vec3& b = mesh.positions[corners.y];
      const vec3& c = mesh.positions[corners.z];
      boxes[i] = {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
    }
  });
  return boxes;
}

UntouchedVector<LeafTriangle> leaf_triangles(const Mesh& mesh, const Bvh& tree) {
  // The traversal loads 16 bytes at a time and reads past the last triangle.
  UntouchedVector<LeafTriangle> triangles(tree.references.size() + 1);
  triangles.back() = {};
  tbb::parallel_for(tbb::blocked_range<size_t>(0, tree.references.size(), grain),
                    [&](const auto& range) {
                      for (size_t i = range.begin(); i < range.end(); ++i) {
                        prefetch_ahead(mesh, tree.references, i);
                        copy_corners(triangles[i], mesh, tree.references[i]);
                      }
                    });
  return triangles;
}

// Boxes that hold a whole mesh: of the nodes of its tree, the largest ones opened until there are
// enough. Together they fit a turned instance better than the root's box does.
std::vector<Box> cover(const Bvh& tree) {
  constexpr size_t enough = 64;
  const auto size = [&](uint32_t node) {
    const BvhNode& of = tree.nodes[node];
    return of.count > 0 ? 0.0f : half_area(box_of(of));
  };
  const auto is_smaller = [&](uint32_t a, uint32_t b) { return size(a) < size(b); };
  std::vector<uint32_t> nodes = {0};  // a heap
  while (nodes.size() < enough && tree.nodes[nodes.front()].count == 0) {
    std::pop_heap(nodes.begin(), nodes.end(), is_smaller);
    const uint32_t left = tree.nodes[nodes.back()].first;
    nodes.back() = left;
    std::push_heap(nodes.begin(), nodes.end(), is_smaller);
    nodes.push_back(left + 1);
    std::push_heap(nodes.begin(), nodes.end(), is_smaller);
  }
  std::vector<Box> boxes;
  boxes.reserve(nodes.size());
  for (const uint32_t node : nodes)
    boxes.push_back(box_of(tree.nodes[node]));
  return boxes;
}

// The world box of transformed boxes (J. Arvo, Transforming Axis-aligned Bounding Boxes, 1990),
// widened by what transforming a ray may round away.
Box world_box(std::span<const Box> boxes, const mat4& to_world) {
  constexpr float rounding = 8.0f * std::numeric_limits<float>::epsilon();
  float4 column[4];
  for (int axis = 0; axis < 4; ++axis)
    column[axis] = load4(&to_world[axis][0]);
  float4 lo = broadcast(infinity), hi = broadcast(-infinity), magnitude = broadcast(0.0f);
  for (const Box& box : boxes) {
    float4 from = column[3], to = column[3], size = abs(column[3]);
    for (int axis = 0; axis < 3; ++axis) {
      const float4 a = column[axis] * broadcast(box.lo[axis]);
      const float4 b = column[axis] * broadcast(box.hi[axis]);
      from += min(a, b);
      to += max(a, b);
      size += max(abs(a), abs(b));
    }
    lo = min(lo, from);
    hi = max(hi, to);
    magnitude = max(magnitude, size);
  }
  // A turned instance's axes mix what is rounded away.
  const float wider = rounding * max_component(xyz(magnitude));
  return {xyz(lo) - wider, xyz(hi) + wider};
}

}  // namespace

std::shared_ptr<const Blas> build_blas(const Mesh& mesh, const BuildOptions& options, BuildLog* log,
                                       const std::stop_token& stop) {
  const auto start = Clock::now();
  const UntouchedVector<Box> boxes = triangle_boxes(mesh);
  auto blas = std::make_shared<Blas>();
  blas->tree = build({boxes, &mesh}, options, log, stop);
  if (stop.stop_requested()) return nullptr;
  blas->triangles = leaf_triangles(mesh, blas->tree);
  blas->wide = widen(blas->tree, blas->triangles, options);
  blas->build_ms = ms_since(start);
  return blas;
}

std::vector<std::shared_ptr<const Blas>> build_blases(const Scene& scene,
                                                      const BuildOptions& options, BuildLog* log,
                                                      const std::stop_token& stop) {
  check(options);
  std::vector<std::shared_ptr<const Blas>> blases(scene.meshes.size());
  tbb::parallel_for(size_t{0}, blases.size(),
                    [&](size_t i) { blases[i] = build_blas(scene.meshes[i], options, log, stop); });
  if (stop.stop_requested()) blases.clear();
  return blases;
}

SceneBvh place_instances(const Scene& scene, std::vector<std::shared_ptr<const Blas>> blases,
                         const BuildOptions& options, float time, const InstanceMotion& motion) {
  assert(blases.size() == scene.meshes.size());
  const auto start = Clock::now();
  SceneBvh bvh;
  bvh.options = options;
  bvh.blases = std::move(blases);
  for (const auto& blas : bvh.blases)
    bvh.blas_ms += blas->build_ms;
  bvh.instances.resize(scene.instances.size());
  tbb::parallel_for(size_t{0}, bvh.instances.size(), [&](size_t i) {
    const Instance& instance = scene.instances[i];
    PlacedInstance& placed = bvh.instances[i];
    placed.mesh = instance.mesh;
    const Box mesh = box_of(bvh.blases[instance.mesh]->tree.nodes[0]);
    const mat4& rest = instance.transform;
    placed.to_world = pose(rest, chosen(motion, instance.motion, mesh, rest), time);
    placed.in_place = placed.to_world == mat4(1.0f);
    placed.to_object = glm::inverse(placed.to_world);
    placed.normal_to_world = glm::transpose(mat3(placed.to_object));
  });
  const std::vector<Box> boxes = instance_boxes(bvh);
  bvh.tlas = build({boxes}, options, nullptr, {});
  bvh.wide_tlas = widen(bvh.tlas, {}, options);
  bvh.tlas_ms = ms_since(start);
  return bvh;
}

Box bounds(const SceneBvh& bvh) {
  return bvh.tlas.nodes.empty() ? Box{} : box_of(bvh.tlas.nodes[0]);
}

std::vector<Box> instance_boxes(const SceneBvh& bvh) {
  std::vector<std::vector<Box>> covers(bvh.blases.size());
  tbb::parallel_for(size_t{0}, covers.size(),
                    [&](size_t mesh) { covers[mesh] = cover(bvh.blases[mesh]->tree); });
  std::vector<Box> boxes(bvh.instances.size());
  tbb::parallel_for(size_t{0}, boxes.size(), [&](size_t i) {
    const PlacedInstance& placed = bvh.instances[i];
    boxes[i] = world_box(covers[placed.mesh], placed.to_world);
  });
  return boxes;
}

uint64_t bytes(const Bvh& bvh) {
  return bvh.nodes.size() * sizeof(BvhNode) + bvh.references.size() * sizeof(uint32_t);
}

uint64_t bytes(const Blas& blas) {
  return bytes(blas.tree) + blas.triangles.size() * sizeof(LeafTriangle) + bytes(blas.wide);
}

uint64_t bytes(const SceneBvh& bvh) {
  uint64_t sum =
      bytes(bvh.tlas) + bytes(bvh.wide_tlas) + bvh.instances.size() * sizeof(PlacedInstance);
  for (const auto& blas : bvh.blases)
    sum += bytes(*blas);
  return sum;
}

}  // namespace tracer
