// Building and placing: one BLAS a mesh, one TLAS over the instances.
#include "tracer/bvh/scene_bvh.h"

#include <algorithm>
#include <cassert>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "tracer/bvh/leaf_order.h"
#include "tracer/bvh/rebraid.h"
#include "tracer/bvh/world_box.h"
#include "tracer/clock.h"

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

namespace {

// The TLAS then refers to instances; returns where each is entered.
std::vector<EntryPoint> named(Bvh& tlas, const TlasInput& input) {
  std::vector<EntryPoint> entries;
  if (input.entries.empty()) return entries;
  entries.reserve(tlas.references.size());
  for (uint32_t& reference : tlas.references) {
    entries.push_back(input.entries[reference]);
    reference = input.instances[reference];
  }
  return entries;
}

}  // namespace

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
  const TlasInput input = tlas_input(bvh);
  bvh.tlas = build({input.boxes}, options, nullptr, {});
  bvh.entries = named(bvh.tlas, input);
  bvh.wide_tlas = widen(bvh.tlas, {}, options, bvh.entries);
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
  uint64_t sum = bytes(bvh.tlas) + bytes(bvh.wide_tlas) +
                 bvh.instances.size() * sizeof(PlacedInstance) +
                 bvh.entries.size() * sizeof(EntryPoint);
  for (const auto& blas : bvh.blases)
    sum += bytes(*blas);
  return sum;
}

}  // namespace tracer
