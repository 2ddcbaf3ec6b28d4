// Hits without any tree: every triangle of every instance that the ray may meet.
#pragma once

#include <vector>

#include "tracer/bvh/scene_bvh.h"
#include "tracer/math/ray.h"

namespace tracer {

// Copies of the scene's triangles, so that nothing of what is checked is used but where the
// instances stand. Instances are left out by the box of their mesh, tested as the traversal does.
class BruteForce {
 public:
  BruteForce(const Scene& scene, std::vector<PlacedInstance> instances);

  // The same hit to the bit that a right BVH gives: same test, same rule for equally near ones.
  Hit intersect(const Ray& ray) const;

  const Box& bounds() const { return bounds_; }  // of all instances, not widened

 private:
  struct Triangles {
    std::vector<LeafTriangle> list;  // one of padding follows
    BvhNode box;
  };
  std::vector<Triangles> meshes_;
  std::vector<PlacedInstance> instances_;
  Box bounds_;
};

}  // namespace tracer
