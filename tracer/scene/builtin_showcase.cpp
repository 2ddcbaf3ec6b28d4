// A brick teapot, a mirror and a glass sphere and three matt ones on a checker floor.
#include <glm/gtc/matrix_transform.hpp>

#include "tracer/scene/builtin_makers.h"
#include "tracer/scene/builtin_parts.h"
#include "tracer/scene/teapot.h"

namespace tracer {
namespace {

// Squares of 1 unit on y = 0, the materials 0 and 1 in turns.
Mesh make_checker_floor(uint32_t squares) {
  Mesh mesh;
  mesh.name = "checker floor";
  const float low = -0.5f * static_cast<float>(squares);
  for (uint32_t i = 0; i < squares; i++) {
    for (uint32_t j = 0; j < squares; j++) {
      const float x = low + static_cast<float>(i), z = low + static_cast<float>(j);
      add_flat_quad(mesh, {x, 0, z}, {x, 0, z + 1}, {x + 1, 0, z + 1}, {x + 1, 0, z}, (i + j) & 1);
    }
  }
  return mesh;
}

}  // namespace

Scene make_showcase(std::span<const double> values, const Job&) {
  const auto detail = static_cast<uint32_t>(values[0]);
  const auto squares = static_cast<uint32_t>(values[1]);
  Scene scene;
  add_daylight(scene);

  Material pale, dark;
  pale.name = "pale square";
  pale.albedo = vec3(0.70f, 0.68f, 0.62f);
  dark.name = "dark square";
  dark.albedo = vec3(0.10f, 0.11f, 0.13f);
  pale.reflectivity = dark.reflectivity = 0.08f;
  add_material(scene, pale);
  add_material(scene, dark);
  const uint32_t brick_material = add_bricks(scene);
  const uint32_t mirror_material = add_mirror(scene);
  Material glass;
  glass.name = "glass";
  glass.transmission = 1.0f;
  glass.refraction_index = 1.5f;
  const uint32_t glass_material = add_material(scene, glass);
  Material gold;
  gold.name = "gold";
  gold.albedo = vec3(0.60f, 0.38f, 0.10f);
  gold.reflectivity = 0.6f;
  gold.specular = vec3(1.0f, 0.78f, 0.34f);
  const uint32_t gold_material = add_material(scene, gold);
  const uint32_t teal_material = add_matt(scene, "teal", {0.05f, 0.42f, 0.40f});

  scene.meshes.push_back(make_checker_floor(squares));
  scene.meshes.push_back(make_teapot(detail));
  scene.meshes.push_back(make_sphere(128, 64));
  const auto place = [&](const char* name, uint32_t mesh, vec3 at, float size, uint32_t material) {
    Instance instance;
    instance.name = name;
    instance.mesh = mesh;
    instance.transform = glm::translate(mat4(1.0f), at) * glm::scale(mat4(1.0f), vec3(size));
    instance.material = material;
    scene.instances.push_back(instance);
  };
  place("floor", 0, vec3(0.0f), 1.0f, none);
  place("teapot", 1, {0.0f, 0.0f, 0.0f}, 1.5f, brick_material);
  place("mirror sphere", 2, {-2.6f, 1.2f, -1.4f}, 1.2f, mirror_material);
  place("glass sphere", 2, {1.3f, 0.8f, 2.2f}, 0.8f, glass_material);
  place("gold sphere", 2, {2.7f, 0.7f, -1.0f}, 0.7f, gold_material);
  place("teal sphere", 2, {-1.5f, 0.45f, 1.9f}, 0.45f, teal_material);

  scene.lights.push_back({"key", {4.0f, 7.0f, 5.0f}, {1.0f, 0.93f, 0.80f}, 55.0f, true});
  scene.lights.push_back({"fill", {-6.0f, 4.0f, 3.0f}, {0.60f, 0.75f, 1.0f}, 15.0f, true});
  scene.ambient = {0.15f, 0.17f, 0.22f};
  scene.camera.eye = {0.6f, 2.9f, 8.2f};
  scene.camera.target = {0.0f, 0.75f, 0.0f};
  scene.camera.fov_degrees = 38.0f;
  return scene;
}

}  // namespace tracer
