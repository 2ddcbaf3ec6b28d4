// Sixteen teapots of brick and mirror that turn and bounce under a sky.
// After the scene of J. Bikker, How to build a BVH, parts 5 to 8, 2022: the grid, the light and the
// ambient light are the article's.
#include <glm/gtc/matrix_transform.hpp>

#include "tracer/scene/builtin_makers.h"
#include "tracer/scene/builtin_parts.h"
#include "tracer/scene/teapot.h"

namespace tracer {

Scene make_teapots(std::span<const double> values, const Job&) {
  Scene scene;
  add_daylight(scene);

  const uint32_t brick_material = add_bricks(scene);
  const uint32_t mirror_material = add_mirror(scene);

  scene.meshes.push_back(make_teapot(static_cast<uint32_t>(values[0])));

  constexpr float spacing = 2.5f;
  constexpr float height = 0.75f;  // of one teapot: 1.5 wide
  for (int column = 0; column < 4; column++) {
    for (int row = 0; row < 4; row++) {
      const int number = 4 * column + row;
      const bool is_mirror = ((column + row) & 1) == 1;
      Instance instance;
      instance.name = (is_mirror ? "mirror teapot " : "brick teapot ") + std::to_string(number + 1);
      const vec3 place((static_cast<float>(column) - 1.5f) * spacing, 0.0f,
                       (static_cast<float>(row) - 1.5f) * spacing);
      const float turned = 0.7f + 0.9f * static_cast<float>(number * 7 % 16);
      instance.transform = glm::translate(mat4(1.0f), place) *
                           glm::rotate(mat4(1.0f), turned, vec3(0, 1, 0)) *
                           glm::scale(mat4(1.0f), vec3(height));
      instance.material = is_mirror ? mirror_material : brick_material;
      instance.motion.spin = 0.2f * static_cast<float>((number * 13 & 7) + 2);
      instance.motion.bounce_height = 2.0f;
      instance.motion.bounce_rate = 1.0f + 0.1f * static_cast<float>(number * 5 % 8);
      instance.motion.phase = pi * static_cast<float>((number * 11 + 15) % 16) / 16.0f;
      scene.instances.push_back(instance);
    }
  }

  scene.lights.push_back({"lamp", {3.0f, 10.0f, 2.0f}, {150.0f, 150.0f, 120.0f}, 1.0f, true});
  scene.ambient = {0.2f, 0.2f, 0.4f};
  // From here none of the sixteen hides another at time 0.
  scene.camera.eye = {7.05f, 4.0f, 9.7f};
  scene.camera.target = {0.0f, 1.7f, 0.0f};
  scene.camera.fov_degrees = 37.0f;
  return scene;
}

}  // namespace tracer
