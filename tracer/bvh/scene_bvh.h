// The two-level BVH of a scene: one BLAS a mesh, one TLAS over the instances.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "tracer/bvh/build.h"
#include "tracer/bvh/wide_bvh.h"
#include "tracer/scene/scene.h"
#include "tracer/untouched.h"

namespace tracer {

struct Blas {
  Bvh tree;
  UntouchedVector<LeafTriangle> triangles;  // in the order of tree.references, plus one of padding
  WideTree wide;                            // the same tree as BuildOptions::layout wants it
  double build_ms = 0.0;
  // Half the area that each node had when the tree was built; nothing: it has not been refitted.
  std::shared_ptr<const std::vector<float>> built_areas;
};

struct PlacedInstance {
  uint32_t mesh = 0;
  bool in_place = true;  // the transforms are the identity
  mat4 to_world{1.0f};
  mat4 to_object{1.0f};
  mat3 normal_to_world{1.0f};  // inverse transpose
};

struct SceneBvh {
  std::vector<std::shared_ptr<const Blas>> blases;  // one a mesh, in the order of Scene::meshes
  Bvh tlas;                                         // references are instances
  std::vector<EntryPoint> entries;  // by place in tlas.references; none: the roots (rebraid.h)
  WideTree wide_tlas;
  std::vector<PlacedInstance> instances;
  BuildOptions options;
  double blas_ms = 0.0;  // sum over the BLASes, each by the clock on the wall
  double tlas_ms = 0.0;
};

// Throw Error for bad options. The log counts the references of all meshes together. Stopped:
// nullptr and an empty vector.
std::shared_ptr<const Blas> build_blas(const Mesh& mesh, const BuildOptions& options, BuildLog* log,
                                       const std::stop_token& stop);
std::vector<std::shared_ptr<const Blas>> build_blases(const Scene& scene,
                                                      const BuildOptions& options, BuildLog* log,
                                                      const std::stop_token& stop);

// The top level for object-to-world transforms, one an instance.
SceneBvh place_instances(const Scene& scene, std::vector<std::shared_ptr<const Blas>> blases,
                         const BuildOptions& options, float time,
                         const InstanceMotion& motion = {});

// Where rays enter the BLAS of the instance at a place in tlas.references.
inline EntryPoint entry_at(const SceneBvh& bvh, size_t place) {
  return bvh.entries.empty() ? EntryPoint() : bvh.entries[place];
}

Box bounds(const SceneBvh& bvh);

// The instances' boxes in the world, widened by what transforming a ray may round away.
std::vector<Box> instance_boxes(const SceneBvh& bvh);

// Bytes of the nodes, references and leaf triangles of all BLASes, and of the TLAS.
uint64_t bytes(const Blas& blas);
uint64_t bytes(const SceneBvh& bvh);

}  // namespace tracer
