// Small scenes and rays for the tests.
#pragma once

#include <random>
#include <vector>

#include "tracer/bvh/scene_bvh.h"

namespace tracer::test {

// A scene of one mesh per entry, one identity instance each, one white material.
Scene scene_of(std::vector<Mesh> meshes);

SceneBvh bvh_of(const Scene& scene, const BuildOptions& options = {}, float time = 0.0f);

// A closed sphere of 2 * segments^2 triangles whose radius is `radius` times 1 .. 1 + noise;
// vertices are shared.
Mesh sphere(int segments, float radius = 1.0f, vec3 center = vec3(0.0f), float noise = 0.0f);

// `count` triangles with corners near random points of the unit cube, `size` large.
Mesh soup(int count, float size, uint32_t seed = 1);

// A unit square in the plane y = 0 of 2 * cells^2 triangles.
Mesh grid(int cells);

// One a triangle.
std::vector<Box> boxes_of(const Mesh& mesh);

BvhNode inner(vec3 lo, vec3 hi, uint32_t left);
BvhNode leaf(vec3 lo, vec3 hi, uint32_t first, uint32_t count);

// Root 0 with leaf 1 and node 2 with the leaves 3 and 4, of 1, 2 and 3 references. Half areas: the
// root's is 9, of node 2 7, of the leaves 3, 3 and 5.
Bvh three_leaves();

vec3 random_direction(std::mt19937& random);
vec3 random_point(std::mt19937& random, const Box& box);

// Tests every triangle of every instance, with the same triangle test and tie rule as the BVH.
Hit brute_force(const Scene& scene, const SceneBvh& bvh, const Ray& ray);

// Rays for a test: 10^6 unless the environment variable BVHSCOPE_TEST_RAYS says otherwise, divided
// by `share`.
int ray_count(int share = 1);

}  // namespace tracer::test
