// Where the instances of a scene are, and the camera of a scene that brings none.
#include "tracer/scene/scene.h"

namespace tracer {

mat4 pose(const Instance& instance, float time) {
  return pose(instance.transform, instance.motion, time);
}

Box bounds(const Scene& scene) {
  std::vector<Box> boxes;
  for (const Mesh& mesh : scene.meshes)
    boxes.push_back(bounds(mesh));
  Box all;
  for (const Instance& instance : scene.instances) {
    const Box& box = boxes[instance.mesh];
    const mat4 to_world = pose(instance, 0.0f);
    for (int corner = 0; corner < 8; ++corner) {
      const vec3 point(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                       corner & 4 ? box.hi.z : box.lo.z);
      all = grown(all, vec3(to_world * vec4(point, 1.0f)));
    }
  }
  return all;
}

Camera default_camera(const Box& box) {
  Camera camera;
  camera.eye = vec3(1.0f, 0.6f, 1.5f);
  camera.target = vec3(0.0f);
  return framed_on(camera, box, 16.0f / 9.0f);
}

}  // namespace tracer
