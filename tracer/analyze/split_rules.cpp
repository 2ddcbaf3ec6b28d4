// Sampling points of a split triangle, and clipping it at the boxes of its leaves.
#include "tracer/analyze/split_rules.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

namespace tracer {
namespace {

// What clipping by a builder may round away, of a coordinate.
constexpr float clip_rounding = 4.0f * std::numeric_limits<float>::epsilon();

Box widened(const Box& box, const Box& content) {
  const vec3 by = clip_rounding * glm::max(glm::abs(content.lo), glm::abs(content.hi));
  return {box.lo - by, box.hi + by};
}

// Points (i a + j b + k c) / points_a_side, i + j + k = points_a_side: corners, edges and inside.
constexpr int points_a_side = 6;

bool is_covered(const vec3& point, std::span<const Box> boxes) {
  return std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) {
    return contains(box, Box{point, point});
  });
}

void check_split_triangle(const TreeToCheck& of, uint32_t triangle, std::span<const Box> leaves,
                          FindingList& found) {
  const uvec3 corners = of.mesh->triangles[triangle];
  for (int i = 0; i <= points_a_side; ++i) {
    for (int j = 0; i + j <= points_a_side; ++j) {
      const vec3 weights = vec3(i, j, points_a_side - i - j) / float(points_a_side);
      const vec3 point = weights.x * of.mesh->positions[corners.x] +
                         weights.y * of.mesh->positions[corners.y] +
                         weights.z * of.mesh->positions[corners.z];
      if (is_covered(point, leaves)) continue;
      found.add(none, triangle, [&] {
        return fmt::format("its {} leaves leave out the point {} {} {}", leaves.size(), point.x,
                           point.y, point.z);
      });
      return;
    }
  }
}

struct Use {
  uint32_t primitive, node;
};

// Those of primitives with several leaves, by primitive.
std::vector<Use> split_uses(const TreeToCheck& of) {
  const std::vector<uint32_t> leaves = leaves_of_each(of);
  std::vector<Use> uses;
  for_each_reference(of.tree, [&](uint32_t node, uint32_t slot) {
    const uint32_t primitive = of.tree.references[slot];
    if (leaves[primitive] > 1) uses.push_back({primitive, node});
  });
  std::stable_sort(uses.begin(), uses.end(),
                   [](const Use& a, const Use& b) { return a.primitive < b.primitive; });
  return uses;
}

// I. Sutherland, G. Hodgman, Reentrant Polygon Clipping, 1974: whether anything is left of a
// triangle inside a box.
bool touches(const Mesh& mesh, uint32_t triangle, const Box& box) {
  const uvec3 corners = mesh.triangles[triangle];
  std::vector<glm::dvec3> polygon = {glm::dvec3(mesh.positions[corners.x]),
                                     glm::dvec3(mesh.positions[corners.y]),
                                     glm::dvec3(mesh.positions[corners.z])};
  for (int plane = 0; plane < 6 && !polygon.empty(); ++plane) {
    const int axis = plane / 2;
    const double sign = plane % 2 == 0 ? 1.0 : -1.0;
    const double at = plane % 2 == 0 ? box.lo[axis] : box.hi[axis];
    std::vector<glm::dvec3> inside;
    for (size_t i = 0; i < polygon.size(); ++i) {
      const glm::dvec3& a = polygon[i];
      const glm::dvec3& b = polygon[(i + 1) % polygon.size()];
      const double from = sign * (a[axis] - at);
      const double to = sign * (b[axis] - at);
      if (from >= 0.0) inside.push_back(a);
      if ((from < 0.0) != (to < 0.0)) inside.push_back(a + from / (from - to) * (b - a));
    }
    polygon = std::move(inside);
  }
  return !polygon.empty();
}

}  // namespace

std::vector<uint32_t> leaves_of_each(const TreeToCheck& of) {
  std::vector<uint32_t> count(of.boxes.size());
  for (const uint32_t primitive : of.tree.references)
    ++count[primitive];
  return count;
}

void check_covered(const TreeToCheck& of, FindingList& found) {
  if (of.mesh == nullptr) return;
  const std::vector<Use> uses = split_uses(of);
  std::vector<Box> leaves;
  for (size_t i = 0; i < uses.size(); ++i) {
    const uint32_t triangle = uses[i].primitive;
    leaves.push_back(widened(box_of(of.tree.nodes[uses[i].node]), of.boxes[triangle]));
    if (i + 1 < uses.size() && uses[i + 1].primitive == triangle) continue;
    check_split_triangle(of, triangle, leaves, found);
    leaves.clear();
  }
}

void check_idle_reference(const TreeToCheck& of, FindingList& found) {
  if (of.mesh == nullptr) return;
  for (const Use& use : split_uses(of)) {
    const Box box = widened(box_of(of.tree.nodes[use.node]), of.boxes[use.primitive]);
    if (touches(*of.mesh, use.primitive, box)) continue;
    found.add(use.node, use.primitive, [&] {
      return fmt::format("the leaf references triangle {}, which is nowhere in its box",
                         use.primitive);
    });
  }
}

}  // namespace tracer
