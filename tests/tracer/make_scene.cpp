// Small scenes and rays for the tests.
#include "make_scene.h"

#include <cstdlib>
#include <map>

#include "tracer/bvh/traverse.h"

namespace tracer::test {

Scene scene_of(std::vector<Mesh> meshes) {
  Scene scene;
  scene.name = "test";
  scene.materials.resize(1);
  scene.meshes = std::move(meshes);
  for (size_t i = 0; i < scene.meshes.size(); ++i) {
    Mesh& mesh = scene.meshes[i];
    mesh.materials.resize(mesh.triangles.size());
    mesh.normals.resize(mesh.positions.size(), vec3(0, 1, 0));
    Instance instance;
    instance.mesh = static_cast<uint32_t>(i);
    scene.instances.push_back(instance);
  }
  return scene;
}

SceneBvh bvh_of(const Scene& scene, const BuildOptions& options, float time) {
  return place_instances(scene, build_blases(scene, options, nullptr, {}), options, time);
}

Mesh sphere(int segments, float radius, vec3 center, float noise) {
  Mesh mesh;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  const int columns = 2 * segments;
  const auto vertex = [&](float theta, float phi) {
    const float r = radius * (1.0f + noise * unit(random));
    mesh.positions.push_back(center + r * vec3(std::sin(theta) * std::cos(phi), std::cos(theta),
                                               std::sin(theta) * std::sin(phi)));
  };
  vertex(0.0f, 0.0f);
  for (int row = 1; row < segments; ++row) {
    for (int column = 0; column < columns; ++column) {
      vertex(pi * static_cast<float>(row) / static_cast<float>(segments),
             2.0f * pi * static_cast<float>(column) / static_cast<float>(columns));
    }
  }
  vertex(pi, 0.0f);
  const auto index = [&](int row, int column) {
    if (row == 0) return 0u;
    if (row == segments) return static_cast<uint32_t>(mesh.positions.size() - 1);
    return static_cast<uint32_t>(1 + (row - 1) * columns + column % columns);
  };
  for (int row = 0; row < segments; ++row) {
    for (int column = 0; column < columns; ++column) {
      const uint32_t a = index(row, column), b = index(row + 1, column);
      const uint32_t c = index(row + 1, column + 1), d = index(row, column + 1);
      if (row + 1 < segments) mesh.triangles.push_back({a, c, b});
      if (row > 0) mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

Mesh soup(int count, float size, uint32_t seed) {
  Mesh mesh;
  std::mt19937 random(seed);
  for (int i = 0; i < count; ++i) {
    const vec3 middle = random_point(random, {vec3(0.0f), vec3(1.0f)});
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (int corner = 0; corner < 3; ++corner) {
      mesh.positions.push_back(middle + size * random_direction(random));
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

Mesh grid(int cells) {
  Mesh mesh;
  for (int z = 0; z <= cells; ++z) {
    for (int x = 0; x <= cells; ++x) {
      mesh.positions.push_back(vec3(static_cast<float>(x), 0.0f, static_cast<float>(z)) /
                               static_cast<float>(cells));
    }
  }
  const auto row = static_cast<uint32_t>(cells + 1);
  for (uint32_t z = 0; z + 1 < row; ++z) {
    for (uint32_t x = 0; x + 1 < row; ++x) {
      const uint32_t a = z * row + x;
      mesh.triangles.push_back({a, a + row, a + 1});
      mesh.triangles.push_back({a + 1, a + row, a + row + 1});
    }
  }
  return mesh;
}

std::vector<Box> boxes_of(const Mesh& mesh) {
  std::vector<Box> boxes;
  for (const uvec3& corners : mesh.triangles) {
    Box box;
    for (int k = 0; k < 3; ++k)
      box = grown(box, mesh.positions[corners[k]]);
    boxes.push_back(box);
  }
  return boxes;
}

BvhNode inner(vec3 lo, vec3 hi, uint32_t left) {
  return {lo, left, hi, 0};
}
BvhNode leaf(vec3 lo, vec3 hi, uint32_t first, uint32_t count) {
  return {lo, first, hi, count};
}

Bvh three_leaves() {
  return {{inner({0, 0, 0}, {1, 1, 4}, 1), leaf({0, 0, 0}, {1, 1, 1}, 0, 1),
           inner({0, 0, 1}, {1, 1, 4}, 3), leaf({0, 0, 1}, {1, 1, 2}, 1, 2),
           leaf({0, 0, 2}, {1, 1, 4}, 3, 3)},
          {0, 1, 2, 3, 4, 5},
          2};
}

vec3 random_direction(std::mt19937& random) {
  std::normal_distribution<float> normal;
  vec3 v(0.0f);
  while (glm::length(v) < 1e-3f)
    v = {normal(random), normal(random), normal(random)};
  return glm::normalize(v);
}

vec3 random_point(std::mt19937& random, const Box& box) {
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  const vec3 t(unit(random), unit(random), unit(random));
  return box.lo + t * (box.hi - box.lo);
}

Hit brute_force(const Scene& scene, const SceneBvh& bvh, const Ray& ray) {
  Hit hit;
  if (!is_valid(ray)) return hit;
  float t_max = ray.t_max;
  for (uint32_t id = 0; id < scene.instances.size(); ++id) {
    const PlacedInstance& instance = bvh.instances[id];
    const Mesh& mesh = scene.meshes[instance.mesh];
    const vec3 origin(instance.to_object * vec4(ray.origin, 1.0f));
    const vec3 direction(instance.to_object * vec4(ray.direction, 0.0f));
    const TriangleRay test = triangle_ray(origin, direction, box_ray(origin, direction));
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      LeafTriangle triangle[2] = {};
      for (int corner = 0; corner < 3; ++corner) {
        const vec3& position = mesh.positions[mesh.triangles[i][corner]];
        triangle->x[corner] = position.x;
        triangle->y[corner] = position.y;
        triangle->z[corner] = position.z;
      }
      const TriangleHit found = intersect(*triangle, test, ray.t_min, t_max);
      if (!found.hit || (found.t == hit.t && !is_before(id, i, hit))) continue;
      hit = {found.t, found.u, found.v, i, id};
      t_max = found.t;
    }
  }
  return hit;
}

int ray_count(int share) {
  const char* wanted = std::getenv("BVHSCOPE_TEST_RAYS");
  const double count = wanted ? std::atof(wanted) : 1e6;
  return static_cast<int>(count / share);
}

}  // namespace tracer::test
