// A scene whose instances overlap, for tests of re-braiding.
#pragma once

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "make_scene.h"

namespace tracer::test {

inline mat4 moved(const vec3& by) {
  return glm::translate(mat4(1.0f), by);
}

// A tube along the diagonal of a cube, whose box it leaves empty.
inline Mesh stick() {
  Mesh mesh = grid(48);
  for (vec3& position : mesh.positions) {
    const float around = 2.0f * pi * position.x;
    const vec3 across = 0.1f * vec3(std::cos(around), std::sin(around), 0.0f);
    position = across + 4.0f * vec3(position.z - 0.5f);
  }
  return mesh;
}

// Sticks, spheres, needles, floors and single triangles upon each other, one of each in place, the
// others turned, stretched, and some of them mirrored.
inline Scene crowd() {
  Scene scene = scene_of(
      {stick(), sphere(16, 1.0f, vec3(0.0f), 0.1f), soup(400, 0.4f), grid(12), soup(1, 0.5f)});
  std::mt19937 random(23);
  for (int i = 0; i < 36; ++i) {
    Instance instance = scene.instances[i % 2 == 0 ? 0 : size_t(i / 2) % 5];
    const vec3 place = random_point(random, {vec3(-2), vec3(2)});
    const vec3 size = random_point(random, {vec3(0.3f), vec3(1.6f)});
    instance.transform = glm::scale(glm::rotate(moved(place), float(i), random_direction(random)),
                                    i % 7 == 0 ? vec3(-size.x, size.y, size.z) : size);
    scene.instances.push_back(instance);
  }
  return scene;
}

}  // namespace tracer::test
