// Thousands of small teapots that stand on the vertices of one big teapot.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include <tbb/parallel_sort.h>

#include "tracer/math/rng.h"
#include "tracer/scene/builtin_makers.h"
#include "tracer/scene/builtin_parts.h"
#include "tracer/scene/teapot.h"

namespace tracer {
namespace {

// A distinct point of a mesh, with its share of the surface.
struct Place {
  vec3 point, normal;
  float area = 0.0f;
};

// In the order of the coordinates.
std::vector<Place> distinct_places(const Mesh& mesh) {
  std::vector<uint32_t> order(mesh.positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](uint32_t vertex) {
    const vec3& p = mesh.positions[vertex];
    return std::tuple(p.y, p.x, p.z, vertex);
  };
  tbb::parallel_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
  std::vector<Place> places;
  std::vector<size_t> place_of(mesh.positions.size());
  for (const uint32_t vertex : order) {
    if (places.empty() || places.back().point != mesh.positions[vertex]) {
      places.push_back({mesh.positions[vertex], mesh.normals[vertex]});
    }
    place_of[vertex] = places.size() - 1;
  }
  for (const uvec3& triangle : mesh.triangles) {
    const vec3& a = mesh.positions[triangle.x];
    const vec3 doubled = glm::cross(mesh.positions[triangle.y] - a, mesh.positions[triangle.z] - a);
    for (int k = 0; k < 3; k++)
      places[place_of[triangle[k]]].area += glm::length(doubled) / 6.0f;
  }
  return places;
}

}  // namespace

Scene make_massive(std::span<const double> values, const Job& job) {
  const auto count = static_cast<size_t>(values[0]);
  const auto detail = static_cast<uint32_t>(values[1]);
  Scene scene;
  add_daylight(scene);
  add_palette(scene);
  Material mirror;
  mirror.name = "mirror";
  mirror.reflectivity = 0.9f;
  mirror.albedo = vec3(0.3f);
  const uint32_t mirror_material = add_material(scene, mirror);
  scene.meshes.push_back(make_teapot(detail));

  // A teapot has 32 detail^2 + 4 detail + 2 distinct points.
  const double enough = std::ceil(std::sqrt(static_cast<double>(count) / 32.0));
  job.progress(0.0f, "finding places");
  const std::vector<Place> places =
      distinct_places(make_teapot(std::max(2u, static_cast<uint32_t>(enough))));

  constexpr float big_height = 10.0f;
  const float share = static_cast<float>(places.size()) / static_cast<float>(count);
  scene.instances.resize(count);
  fill_in_parallel(count, job, 0.3f, 1.0f, "placing instances", [&](size_t first, size_t last) {
    for (size_t i = first; i < last; i++) {
      const Place& place = places[i * places.size() / count];
      const float size = big_height * std::min(0.1f, 0.7f * std::sqrt(share * place.area));
      Rng rng = make_rng(1, i);
      Instance& instance = scene.instances[i];
      instance.name = "teapot " + std::to_string(i + 1);
      instance.transform =
          standing_on(big_height * place.point, place.normal, uniform(rng, 0.0f, 2.0f * pi), size);
      const uint32_t choice = next(rng) % (palette_size + 1);
      instance.material = choice == palette_size ? mirror_material : choice;
      instance.motion.spin = uniform(rng, -2.0f, 2.0f);
    }
  });

  scene.lights.push_back({"sun", {14.0f, 26.0f, 18.0f}, {1.0f, 0.95f, 0.85f}, 1000.0f, true});
  scene.ambient = {0.22f, 0.24f, 0.30f};
  scene.camera.eye = {7.0f, 9.5f, 20.5f};
  scene.camera.target = {0.4f, 4.4f, 0.0f};
  scene.camera.fov_degrees = 42.0f;
  return scene;
}

}  // namespace tracer
