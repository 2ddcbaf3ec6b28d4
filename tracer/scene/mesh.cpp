// Mesh bounds, and normals for meshes that bring none.
#include "tracer/scene/mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>
#include <unordered_map>

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

namespace tracer {
namespace {

bool before(const vec3& a, const vec3& b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  return a.z < b.z;
}

// For every entry the number of its position; equal positions have the same.
std::vector<uint32_t> welded(const std::vector<vec3>& positions, uint32_t& count) {
  std::vector<uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  tbb::parallel_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    if (positions[a] == positions[b]) return a < b;
    return before(positions[a], positions[b]);
  });
  std::vector<uint32_t> points(positions.size());
  count = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && positions[order[i]] != positions[order[i - 1]]) ++count;
    points[order[i]] = count;
  }
  if (!order.empty()) ++count;
  return points;
}

// A corner is 3 * triangle + k. The corners without a normal, grouped by point.
struct PointCorners {
  std::vector<uint32_t> first;  // by point, and the end
  std::vector<uint32_t> corners;
};

PointCorners corners_without_normal(const Mesh& mesh, const std::vector<uint32_t>& points,
                                    uint32_t point_count) {
  PointCorners result;
  result.first.assign(point_count + 1, 0);
  const auto each = [&](auto use) {
    for (uint32_t corner = 0; corner < 3 * mesh.triangles.size(); ++corner) {
      const uint32_t entry = mesh.triangles[corner / 3][int(corner % 3)];
      if (mesh.normals[entry] == vec3(0.0f)) use(corner, points[entry]);
    }
  };
  each([&](uint32_t, uint32_t point) { ++result.first[point + 1]; });
  std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
  result.corners.resize(result.first.back());
  std::vector<uint32_t> next(result.first.begin(), result.first.end() - 1);
  each([&](uint32_t corner, uint32_t point) { result.corners[next[point]++] = corner; });
  return result;
}

// Its length is twice the triangle's area.
glm::dvec3 face_normal(const Mesh& mesh, uint32_t triangle) {
  const uvec3& t = mesh.triangles[triangle];
  const glm::dvec3 a(mesh.positions[t.x]);
  return glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
}

vec3 unit(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0.0 ? vec3(v / length) : vec3(0.0f, 1.0f, 0.0f);
}

uint32_t root(std::vector<uint32_t>& parents, uint32_t i) {
  while (parents[i] != i)
    i = parents[i] = parents[parents[i]];
  return i;
}

// The groups of faces around one point that share a normal: joined across edges that are not
// sharper than the crease.
std::vector<uint32_t> smooth_groups(const Mesh& mesh, const std::vector<uint32_t>& points,
                                    std::span<const uint32_t> corners,
                                    std::span<const glm::dvec3> normals, double least_cosine) {
  struct Edge {
    uint32_t other_end;
    uint32_t face;  // index in corners
  };
  std::vector<Edge> edges;
  edges.reserve(2 * corners.size());
  for (uint32_t i = 0; i < corners.size(); ++i) {
    const uvec3& triangle = mesh.triangles[corners[i] / 3];
    const int k = int(corners[i] % 3);
    edges.push_back({points[triangle[(k + 1) % 3]], i});
    edges.push_back({points[triangle[(k + 2) % 3]], i});
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.other_end != b.other_end ? a.other_end < b.other_end : a.face < b.face;
  });
  std::vector<uint32_t> groups(corners.size());
  std::iota(groups.begin(), groups.end(), 0u);
  for (size_t e = 1; e < edges.size(); ++e) {
    if (edges[e].other_end != edges[e - 1].other_end) continue;
    const uint32_t a = edges[e - 1].face;
    const uint32_t b = edges[e].face;
    const double lengths = glm::length(normals[a]) * glm::length(normals[b]);
    if (glm::dot(normals[a], normals[b]) < least_cosine * lengths) continue;
    const uint32_t root_a = root(groups, a);
    const uint32_t root_b = root(groups, b);
    groups[std::max(root_a, root_b)] = std::min(root_a, root_b);
  }
  for (uint32_t i = 0; i < groups.size(); ++i)
    groups[i] = root(groups, i);
  return groups;
}

}  // namespace

Box bounds(const Mesh& mesh) {
  Box box;
  for (const vec3& p : mesh.positions)
    box = grown(box, p);
  return box;
}

void fill_missing_normals(Mesh& mesh, float crease_degrees) {
  uint32_t point_count = 0;
  if (std::find(mesh.normals.begin(), mesh.normals.end(), vec3(0.0f)) == mesh.normals.end()) return;
  const std::vector<uint32_t> points = welded(mesh.positions, point_count);
  const PointCorners around = corners_without_normal(mesh, points, point_count);
  const double least_cosine = std::cos(double(crease_degrees) * double(pi) / 180.0);

  // By place in around.corners: its group's first place, and there the group's normal.
  std::vector<uint32_t> groups(around.corners.size());
  std::vector<vec3> group_normals(around.corners.size());
  tbb::parallel_for(0u, point_count, [&](uint32_t point) {
    const uint32_t first = around.first[point];
    const std::span corners =
        std::span(around.corners).subspan(first, around.first[point + 1] - first);
    if (corners.empty()) return;
    std::vector<glm::dvec3> normals(corners.size());
    for (size_t i = 0; i < corners.size(); ++i)
      normals[i] = face_normal(mesh, corners[i] / 3);
    std::vector<uint32_t> own(corners.size(), 0u);
    if (crease_degrees < 180.0f) {
      own = smooth_groups(mesh, points, corners, normals, least_cosine);
    }
    std::vector<glm::dvec3> sums(corners.size(), glm::dvec3(0.0));
    for (size_t i = 0; i < corners.size(); ++i)
      sums[own[i]] += normals[i];
    for (size_t i = 0; i < corners.size(); ++i) {
      groups[first + i] = first + own[i];
      // Faces back to back cancel out: then one of them decides.
      const double least = 1e-6 * glm::length(normals[i]);
      const bool cancelled = glm::length(sums[i]) <= least;
      if (own[i] == i) group_normals[first + i] = unit(cancelled ? normals[i] : sums[i]);
    }
  });

  // The first group at an entry keeps it, others get new ones.
  std::vector<uint32_t> taken(mesh.positions.size(), none);
  std::unordered_map<uint64_t, uint32_t> added;
  for (size_t place = 0; place < groups.size(); ++place) {
    const uint32_t corner = around.corners[place];
    uint32_t& entry = mesh.triangles[corner / 3][int(corner % 3)];
    const uint32_t group = groups[place];
    if (taken[entry] == none) {
      taken[entry] = group;
      mesh.normals[entry] = group_normals[group];
    } else if (taken[entry] != group) {
      const uint64_t key = uint64_t(entry) << 32 | group;
      const auto [found, is_new] = added.try_emplace(key, uint32_t(mesh.positions.size()));
      if (is_new) {
        mesh.positions.push_back(vec3(mesh.positions[entry]));
        mesh.normals.push_back(group_normals[group]);
        if (!mesh.uvs.empty()) mesh.uvs.push_back(vec2(mesh.uvs[entry]));
      }
      entry = found->second;
    }
  }
  // Entries that no triangle uses.
  std::replace(mesh.normals.begin(), mesh.normals.end(), vec3(0.0f), vec3(0.0f, 1.0f, 0.0f));
}

}  // namespace tracer
