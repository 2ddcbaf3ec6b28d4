// T4: a ray that leaves a surface does not hit it again; normals under any affine transform.
#include "tracer/render/surface.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/bvh/ray_kernels.h"
#include "tracer/bvh/traverse.h"

namespace tracer::test {
namespace {

struct SelfHits {
  int cast = 0;
  int hits = 0;
  int with_fixed_epsilon = 0;
};

// Hits random triangles of a soup, spawns rays to the same side, to the other side and grazing, and
// counts those that meet the triangle they left.
SelfHits self_hits(float coordinate, float size, const mat4& transform, int rays) {
  Mesh mesh = soup(2000, size);
  for (vec3& position : mesh.positions)
    position = position * size + vec3(coordinate);
  Scene scene = scene_of({std::move(mesh)});
  scene.instances[0].transform = transform;
  const SceneBvh bvh = bvh_of(scene);
  const Box box = bounds(bvh);
  std::mt19937 random(9);
  SelfHits result;
  for (int i = 0; i < rays; ++i) {
    const Mesh& aimed = scene.meshes[0];
    const vec3 target =
        aimed.positions[random() % aimed.positions.size()] + 0.3f * size * random_direction(random);
    Ray ray;
    ray.origin = center(box) + glm::length(extent(box)) * random_direction(random);
    ray.direction = glm::normalize(vec3(transform * vec4(target, 1.0f)) - ray.origin);
    NoProbe probe;
    const Hit hit = intersect(bvh, ray, probe);
    if (!is_hit(hit)) continue;
    const Surface surface = surface_at(scene, bvh, ray.direction, hit);
    vec3 way = random_direction(random);
    if (result.cast % 3 == 0) {
      const vec3& normal = surface.geometric_normal;
      way = glm::normalize(way - 0.999f * glm::dot(way, normal) * normal);
    }
    Ray next;
    next.direction = way;
    next.origin = spawn_point(surface, way);
    const Hit again = intersect(bvh, next, probe);
    ++result.cast;
    result.hits += is_hit(again) && again.triangle == hit.triangle ? 1 : 0;
    next.origin = surface.position + 1e-4f * way;
    const Hit old_way = intersect(bvh, next, probe);
    result.with_fixed_epsilon += is_hit(old_way) && old_way.triangle == hit.triangle ? 1 : 0;
  }
  return result;
}

TEST(Surface, NoSelfHitsAtAnyScale) {
  for (const float coordinate : {0.0f, 1e-3f, 1.0f, 100.0f, 1e4f, 1e6f}) {
    for (const float size : {0.01f, 1.0f, 100.0f}) {
      if (size < 1e-6f * coordinate) continue;  // no triangle is left
      const SelfHits found = self_hits(coordinate, size, mat4(1.0f), ray_count(50));
      EXPECT_EQ(found.hits, 0) << "of " << found.cast << " at " << coordinate << ", size " << size;
      EXPECT_GT(found.cast, 0);
    }
  }
}

TEST(Surface, NoSelfHitsInInstances) {
  mat4 shear(1.0f);
  shear[1][0] = 2.0f;
  const mat4 transforms[] = {
      glm::scale(mat4(1.0f), vec3(1e-3f)),
      glm::scale(mat4(1.0f), vec3(1e4f, 1.0f, 1e-2f)),
      glm::translate(mat4(1.0f), vec3(1e5f, -3e4f, 10.0f)),
      glm::translate(mat4(1.0f), vec3(50.0f, 20.0f, -70.0f)) *
          glm::rotate(mat4(1.0f), 1.1f, vec3(1, -2, 0.5f)) * shear,
      glm::scale(mat4(1.0f), vec3(-1.0f, 1.0f, 1.0f)),
  };
  for (const mat4& transform : transforms) {
    for (const float coordinate : {0.0f, 1.0f, 1e4f}) {
      const SelfHits found = self_hits(coordinate, 1.0f, transform, ray_count(50));
      EXPECT_EQ(found.hits, 0) << "of " << found.cast << " at " << coordinate;
      EXPECT_GT(found.cast, 0);
    }
  }
}

TEST(Surface, AFixedEpsilonFails) {
  const SelfHits found = self_hits(1e4f, 1.0f, mat4(1.0f), 2000);
  EXPECT_GT(found.with_fixed_epsilon, 100);
}

TEST(Surface, NormalsUnderNonUniformScale) {
  // The plane x + y = 1 scaled by 2 in x is x / 2 + y = 1: its normal is (1, 2, 0) / sqrt(5).
  Mesh mesh;
  mesh.positions = {vec3(1, 0, -1), vec3(0, 1, -1), vec3(0.5f, 0.5f, 1)};
  mesh.triangles = {{0, 1, 2}};
  mesh.normals.assign(3, glm::normalize(vec3(1, 1, 0)));
  Scene scene = scene_of({mesh});
  scene.instances[0].transform = glm::scale(mat4(1.0f), vec3(2, 1, 1));
  const SceneBvh bvh = bvh_of(scene);
  Ray ray{vec3(5, 2, 0), 0.0f, glm::normalize(vec3(-4, -1.5f, -0.3f)), infinity};
  NoProbe probe;
  const Hit hit = intersect(bvh, ray, probe);
  ASSERT_TRUE(is_hit(hit));
  const Surface surface = surface_at(scene, bvh, ray.direction, hit);
  const vec3 expected = glm::normalize(vec3(1, 2, 0));
  EXPECT_LT(glm::length(surface.geometric_normal - expected), 1e-5f);
  EXPECT_LT(glm::length(surface.shading_normal - expected), 1e-5f);
  EXPECT_TRUE(surface.front);
  EXPECT_LT(glm::length(surface.position - (ray.origin + hit.t * ray.direction)), 1e-5f);
}

TEST(Surface, NormalsUnderShear) {
  // Shearing x by y moves the ground y = 0 within itself and tilts the wall x = 0.
  Mesh mesh;
  mesh.positions = {vec3(0, -1, -1), vec3(0, 1, -1), vec3(0, 0, 1)};
  mesh.triangles = {{0, 1, 2}};
  mesh.normals.assign(3, vec3(1, 0, 0));
  Scene scene = scene_of({mesh});
  scene.instances[0].transform[1][0] = 1.0f;
  const SceneBvh bvh = bvh_of(scene);
  Ray ray{vec3(5, 0.1f, 0), 0.0f, vec3(-1, 0, 0), infinity};
  NoProbe probe;
  const Hit hit = intersect(bvh, ray, probe);
  ASSERT_TRUE(is_hit(hit));
  const Surface surface = surface_at(scene, bvh, ray.direction, hit);
  EXPECT_LT(glm::length(surface.shading_normal - glm::normalize(vec3(1, -1, 0))), 1e-5f);
}

struct SomeHits {
  std::vector<vec3> directions;
  std::vector<Hit> hits;
};

// Of all instances in turns, so that neighbours lie in different ones, then of one after another.
SomeHits some_hits(const Scene& scene, size_t count) {
  SomeHits some;
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  const size_t instances = scene.instances.size();
  for (size_t i = 0; i < count; ++i) {
    const size_t instance = i < count / 2 ? i % instances : i * instances / count;
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    const float u = unit(random), v = (1.0f - u) * unit(random);
    some.hits.push_back(
        {1.0f, u, v, uint32_t(random() % mesh.triangles.size()), static_cast<uint32_t>(instance)});
    some.directions.push_back(random_direction(random));
  }
  return some;
}

// A soup whose last triangles have no area, tiny edges and no normals; another one with uv.
Scene scene_of_all_kinds() {
  Mesh odd = soup(40, 0.3f);
  odd.normals.assign(odd.positions.size(), glm::normalize(vec3(0.2f, 1.0f, -0.4f)));
  for (size_t corner = 0; corner < 6; ++corner)
    odd.positions[odd.triangles[39 - corner / 3][int(corner % 3)]] = vec3(0.5f);
  for (int corner = 0; corner < 3; ++corner) {
    odd.positions[odd.triangles[37][corner]] *= 1e-25f;
    odd.normals[odd.triangles[36][corner]] = vec3(0.0f);
  }
  Mesh textured = sphere(6);
  for (const vec3& position : textured.positions)
    textured.uvs.emplace_back(position.x, position.z);
  Scene scene = scene_of({odd, textured, sphere(5, 2.0f)});
  scene.instances[1].transform = glm::scale(mat4(1.0f), vec3(1e-3f, 5.0f, -2.0f));
  scene.instances[2].transform = glm::translate(
      glm::rotate(mat4(1.0f), 0.7f, vec3(1.0f, 2.0f, 3.0f)), vec3(100.0f, -3.0f, 0.1f));
  return scene;
}

bool are_same(const Surface& a, const Surface& b) {
  return a.position == b.position && a.position_error == b.position_error &&
         a.geometric_normal == b.geometric_normal && a.shading_normal == b.shading_normal &&
         a.uv == b.uv && a.barycentric == b.barycentric && a.material == b.material &&
         a.triangle == b.triangle && a.instance == b.instance && a.front == b.front;
}

TEST(Surface, ManyHitsAreAsOneIsWithEveryInstructionSet) {
  const Scene scene = scene_of_all_kinds();
  const SceneBvh bvh = bvh_of(scene);
  const SomeHits some = some_hits(scene, 301);  // no multiple of eight
  std::vector<Surface> first(some.hits.size());
  surfaces_at(scene, bvh, some.directions, some.hits, first);
  for (const IsaRow& isa : isas()) {
    prefer_isa(isa.id);
    std::vector<Surface> found(some.hits.size());
    surfaces_at(scene, bvh, some.directions, some.hits, found);
    for (size_t i = 0; i < found.size(); ++i) {
      EXPECT_TRUE(are_same(found[i], first[i])) << isa.id << ", hit " << i;
      EXPECT_TRUE(are_same(surface_at(scene, bvh, some.directions[i], some.hits[i]), first[i]))
          << isa.id << ", hit " << i << " alone";
    }
  }
  prefer_isa("");
}

// In double, by the definitions.
TEST(Surface, IsWhatItsCornersSay) {
  using glm::dmat4, glm::dvec3, glm::dvec4;
  const Scene scene = scene_of_all_kinds();
  const SceneBvh bvh = bvh_of(scene);
  const SomeHits some = some_hits(scene, 300);
  std::vector<Surface> found(some.hits.size());
  surfaces_at(scene, bvh, some.directions, some.hits, found);
  for (size_t i = 0; i < found.size(); ++i) {
    const Hit& hit = some.hits[i];
    const Mesh& mesh = scene.meshes[scene.instances[hit.instance].mesh];
    if (hit.instance == 0 && hit.triangle >= 36) continue;  // the odd ones
    const dmat4 to_world(scene.instances[hit.instance].transform);
    const glm::uvec3 corners = mesh.triangles[hit.triangle];
    const auto mixed = [&](const auto& values) {
      return (1.0 - hit.u - hit.v) * dvec3(values[corners.x]) +
             double(hit.u) * dvec3(values[corners.y]) + double(hit.v) * dvec3(values[corners.z]);
    };
    const auto placed = [&](const dvec3& point) { return dvec3(to_world * dvec4(point, 1.0)); };
    const dvec3 a = placed(mesh.positions[corners.x]), b = placed(mesh.positions[corners.y]),
                c = placed(mesh.positions[corners.z]);
    const dvec3 position = placed(mixed(mesh.positions));
    const dvec3 way =
        glm::normalize(glm::cross(b - a, c - a)) * (glm::determinant(to_world) < 0.0 ? -1.0 : 1.0);
    dvec3 shading =
        glm::normalize(glm::transpose(glm::inverse(glm::dmat3(to_world))) * mixed(mesh.normals));
    if (glm::dot(shading, way) < 0.0) shading = -shading;
    const dvec3 off = glm::abs(dvec3(found[i].position) - position);
    EXPECT_TRUE(glm::all(glm::lessThanEqual(off, dvec3(found[i].position_error)))) << i;
    EXPECT_LT(glm::length(dvec3(found[i].geometric_normal) - way), 1e-4) << i;
    EXPECT_LT(glm::length(dvec3(found[i].shading_normal) - shading), 1e-4) << i;
    EXPECT_EQ(found[i].front, glm::dot(way, dvec3(some.directions[i])) <= 0.0) << i;
    EXPECT_EQ(found[i].geometric_normal, geometric_normal_at(scene, bvh, hit)) << i;
    EXPECT_LT(glm::length(found[i].uv - uv_at(scene, hit)), 1e-6f) << i;
  }
}

TEST(Surface, InstanceMaterialReplacesTheMeshs) {
  Scene scene = scene_of({sphere(8)});
  scene.materials.resize(2);
  scene.instances[0].material = 1;
  const SceneBvh bvh = bvh_of(scene);
  Ray ray{vec3(0, 0.1f, 5), 0.0f, vec3(0, 0, -1), infinity};
  NoProbe probe;
  const Hit hit = intersect(bvh, ray, probe);
  ASSERT_TRUE(is_hit(hit));
  EXPECT_EQ(surface_at(scene, bvh, ray.direction, hit).material, 1u);
}

}  // namespace
}  // namespace tracer::test
