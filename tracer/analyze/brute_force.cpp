// Hits without any tree.
#include "tracer/analyze/brute_force.h"

#include <tbb/parallel_for.h>

#include "tracer/bvh/traverse.h"

namespace tracer {

BruteForce::BruteForce(const Scene& scene, std::vector<PlacedInstance> instances)
    : meshes_(scene.meshes.size()), instances_(std::move(instances)) {
  tbb::parallel_for(size_t{0}, meshes_.size(), [&](size_t i) {
    const Mesh& mesh = scene.meshes[i];
    Box box;
    std::vector<LeafTriangle>& list = meshes_[i].list;
    list.resize(mesh.triangles.size() + 1);
    for (size_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
      for (int k = 0; k < 3; ++k) {
        const vec3& corner = mesh.positions[mesh.triangles[triangle][k]];
        box = grown(box, corner);
        list[triangle].x[k] = corner.x;
        list[triangle].y[k] = corner.y;
        list[triangle].z[k] = corner.z;
      }
    }
    meshes_[i].box.lo = box.lo;
    meshes_[i].box.hi = box.hi;
  });
  for (const PlacedInstance& instance : instances_) {
    const BvhNode& box = meshes_[instance.mesh].box;
    for (int corner = 0; corner < 8; ++corner) {
      const vec3 point(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                       corner & 4 ? box.hi.z : box.lo.z);
      bounds_ = grown(bounds_, vec3(instance.to_world * vec4(point, 1.0f)));
    }
  }
}

Hit BruteForce::intersect(const Ray& ray) const {
  Hit hit;
  if (!is_valid(ray)) return hit;
  const float t_min = std::max(ray.t_min, 0.0f);
  float t_max = ray.t_max;
  for (uint32_t id = 0; id < instances_.size(); ++id) {
    const PlacedInstance& instance = instances_[id];
    const Triangles& mesh = meshes_[instance.mesh];
    const vec3 origin(instance.to_object * vec4(ray.origin, 1.0f));
    const vec3 direction(instance.to_object * vec4(ray.direction, 0.0f));
    const BoxRay box = box_ray(origin, direction);
    if (!box_span(mesh.box, box, t_min, t_max).hit) continue;
    const TriangleRay test = triangle_ray(origin, direction, box);
    for (uint32_t i = 0; i + 1 < mesh.list.size(); ++i) {
      const TriangleHit found = tracer::intersect(mesh.list[i], test, t_min, t_max);
      if (!found.hit || (found.t == hit.t && !is_before(id, i, hit))) continue;
      hit = {found.t, found.u, found.v, i, id};
      t_max = found.t;
    }
  }
  return hit;
}

}  // namespace tracer
