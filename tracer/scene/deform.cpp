// Twist, wave and bend move points and turn normals with the cofactor of the derivative; explode
// moves triangles. As in A. Barr, Global and Local Deformations of Solid Primitives, 1984.
#include "tracer/scene/deform.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "tracer/choice.h"

namespace tracer {

using glm::dmat3;
using glm::dvec3;

// In the frame of a deformer x runs along the axis and y is the side to which it bends; the middle
// of the mesh's box is the origin and its largest extent is 1.
struct Deformation {
  double strength = 0.0;
  double swings = 0.0;  // since time 0
  Box box;
  double size = 0.0;    // the largest extent
  double length = 0.0;  // along the axis, as a share of the size
  std::array<int, 3> order{0, 1, 2};
};

namespace {

constexpr double turn = 2.0 * 3.14159265358979323846;
constexpr double largest_coordinate = 1.844e18;  // of a Mesh
constexpr size_t grain = 4096;                   // vertices or triangles a task takes

struct Warp {
  dvec3 point{0.0};
  dmat3 derivative{1.0};
};

Warp twist(const dvec3& p, const Deformation& how) {
  if (how.length == 0.0) return {p};
  const double rate = turn * how.strength / how.length;
  const double c = std::cos(rate * p.x);
  const double s = std::sin(rate * p.x);
  const double y = c * p.y - s * p.z;
  const double z = s * p.y + c * p.z;
  return {{p.x, y, z}, {{1.0, -rate * z, rate * y}, {0.0, c, s}, {0.0, -s, c}}};
}

Warp wave(const dvec3& p, const Deformation& how) {
  constexpr double waves = 2.0;  // along the mesh
  const double rate = how.length > 0.0 ? turn * waves / how.length : 0.0;
  const double phase = rate * p.x - turn * how.swings;
  const double height = 0.5 * how.strength;
  return {{p.x, p.y + height * std::sin(phase), p.z},
          {{1.0, height * rate * std::cos(phase), 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
}

// The axis becomes an arc in the plane of x and y.
Warp bend(const dvec3& p, const Deformation& how) {
  if (how.length == 0.0) return {p};
  const double curvature = turn * how.strength / how.length;
  const double angle = curvature * p.x;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  // sin a / a and (1 - cos a) / a also where a is close to 0.
  const double half = std::sin(0.5 * angle);
  const double sinc = std::abs(angle) < 1e-8 ? 1.0 : s / angle;
  const double versine = std::abs(angle) < 1e-8 ? 0.5 * angle : 2.0 * half * half / angle;
  const double stretch = 1.0 - curvature * p.y;
  return {{p.x * sinc - p.y * s, p.x * versine + p.y * c, p.z},
          {{stretch * c, stretch * s, 0.0}, {-s, c, 0.0}, {0.0, 0.0, 1.0}}};
}

float within(double coordinate) {
  return static_cast<float>(std::clamp(coordinate, -largest_coordinate, largest_coordinate));
}

vec3 moved(const vec3& from, const dvec3& by) {
  return {within(from.x + by.x), within(from.y + by.y), within(from.z + by.z)};
}

// What a derivative does to the cross product of two edges.
dmat3 cofactor(const dmat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

template <Warp (*warp)(const dvec3&, const Deformation&)>
Mesh by_point(const Mesh& rest, const Deformation& how) {
  Mesh mesh = rest;
  const dvec3 middle = 0.5 * (dvec3(how.box.lo) + dvec3(how.box.hi));
  const auto [x, y, z] = how.order;
  tbb::parallel_for(tbb::blocked_range<size_t>(0, rest.positions.size(), grain),
                    [&, x = x, y = y, z = z](const auto& range) {
                      for (size_t i = range.begin(); i < range.end(); ++i) {
                        const dvec3 p = (dvec3(rest.positions[i]) - middle) / how.size;
                        const dvec3 local(p[x], p[y], p[z]);
                        const Warp to = warp(local, how);
                        const dvec3 step = how.size * (to.point - local);
                        dvec3 by(0.0);
                        by[x] = step.x;
                        by[y] = step.y;
                        by[z] = step.z;
                        mesh.positions[i] = moved(rest.positions[i], by);
                        const vec3& n = rest.normals[i];
                        const dvec3 turned = cofactor(to.derivative) * dvec3(n[x], n[y], n[z]);
                        const double length = glm::length(turned);
                        if (!(length > 0.0) || !std::isfinite(length))
                          continue;  // crushed: keeps its own
                        mesh.normals[i][x] = static_cast<float>(turned.x / length);
                        mesh.normals[i][y] = static_cast<float>(turned.y / length);
                        mesh.normals[i][z] = static_cast<float>(turned.z / length);
                      }
                    });
  return mesh;
}

// 0.5 .. 1.5. The mixing is Murmur3's finalizer (A. Appleby, 2011).
double uneven(uint32_t triangle) {
  uint32_t h = triangle + 0x9e3779b9u;
  h = (h ^ h >> 16) * 0x85ebca6bu;
  h = (h ^ h >> 13) * 0xc2b2ae35u;
  h ^= h >> 16;
  return 0.5 + h / 4294967296.0;
}

// Every triangle flies away from the middle as it is, some faster than others. What neighbours
// shared becomes an entry for each of them.
Mesh explode(const Mesh& rest, const Deformation& how) {
  Mesh mesh;
  mesh.name = rest.name;
  mesh.materials = rest.materials;
  const size_t count = rest.triangles.size();
  mesh.triangles.resize(count);
  mesh.positions.resize(3 * count);
  mesh.normals.resize(3 * count);
  mesh.uvs.resize(rest.uvs.empty() ? 0 : 3 * count);
  const dvec3 middle = 0.5 * (dvec3(how.box.lo) + dvec3(how.box.hi));
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count, grain), [&](const auto& range) {
    for (size_t i = range.begin(); i < range.end(); ++i) {
      const uvec3& corners = rest.triangles[i];
      const dvec3 centroid = (dvec3(rest.positions[corners.x]) + dvec3(rest.positions[corners.y]) +
                              dvec3(rest.positions[corners.z])) /
                             3.0;
      const dvec3 by = how.strength * uneven(static_cast<uint32_t>(i)) * (centroid - middle);
      for (int k = 0; k < 3; ++k) {
        const size_t to = 3 * i + size_t(k);
        mesh.positions[to] = moved(rest.positions[corners[k]], by);
        mesh.normals[to] = rest.normals[corners[k]];
        if (!rest.uvs.empty()) mesh.uvs[to] = rest.uvs[corners[k]];
        mesh.triangles[i][k] = static_cast<uint32_t>(to);
      }
    }
  });
  return mesh;
}

double to_and_fro(double amount, double swings, bool held) {
  return held ? amount : amount * std::sin(turn * swings);
}
double out_and_back(double amount, double swings, bool held) {
  return held ? amount : amount * 0.5 * (1.0 - std::cos(turn * swings));
}
double all_the_time(double amount, double, bool) {
  return amount;
}

constexpr DeformerRow rows[] = {
    {"none", "None", "The meshes stay as they were loaded", "nothing"},
    {"twist", "Twist", "Turns each slice about the axis, one end against the other, to and fro",
     "turns from end to end", by_point<twist>, to_and_fro},
    {"wave", "Wave", "Two waves travel along the axis, one wave length a swing",
     "height from trough to crest, as a share of the largest extent", by_point<wave>, all_the_time},
    {"bend", "Bend", "Bends the axis into an arc, to and fro", "turns that the arc makes",
     by_point<bend>, to_and_fro},
    {"explode", "Explode",
     "Every triangle flies away from the middle as one stiff piece, some faster than others, and "
     "comes back",
     "way outward, as a share of a triangle's distance from the middle", explode, out_and_back},
};

constexpr AxisRow axis_rows[] = {
    {"x", "x", "Along x; bends and waves towards y"},
    {"y", "y", "Along y; bends and waves towards x"},
    {"z", "z", "Along z; bends and waves towards y"},
};
constexpr std::array<std::array<int, 3>, 3> orders = {{{0, 1, 2}, {1, 0, 2}, {2, 1, 0}}};

const DeformerRow* row_of(const Deformer& deformer) {
  const DeformerRow* row = find_row(deformers(), deformer.kind);
  return row != nullptr && row->deform != nullptr ? row : nullptr;
}

bool is_held(const Deformer& deformer) {
  return !(deformer.speed >= least_speed);
}

// Whole swings are left out while the numbers are exact.
double swings_at(const Deformer& deformer, float time) {
  if (is_held(deformer)) return 0.0;
  const double swings = double(deformer.speed) * double(time);
  return swings - std::floor(swings);
}

}  // namespace

std::span<const AxisRow> axes() {
  return axis_rows;
}

std::span<const DeformerRow> deformers() {
  return rows;
}

bool is_active(const Deformer& deformer) {
  return row_of(deformer) != nullptr && deformer.amount != 0.0f;
}

bool is_moving(const Deformer& deformer) {
  return is_active(deformer) && !is_held(deformer);
}

double strength_at(const Deformer& deformer, float time) {
  const DeformerRow* row = row_of(deformer);
  if (row == nullptr) return 0.0;
  return row->strength(deformer.amount, swings_at(deformer, time), is_held(deformer));
}

Mesh deformed(const Mesh& rest, const Deformer& deformer, float time) {
  Deformation how;
  how.strength = strength_at(deformer, time);
  how.box = bounds(rest);
  const dvec3 extent = dvec3(how.box.hi) - dvec3(how.box.lo);
  how.size = std::max({extent.x, extent.y, extent.z});
  if (how.strength == 0.0 || !(how.size > 0.0)) return rest;
  const AxisRow* axis = find_row(axes(), deformer.axis);
  const auto number = axis != nullptr ? size_t(axis - axes().data()) : 1;
  how.order = orders[number];
  how.swings = swings_at(deformer, time);
  how.length = extent[int(number)] / how.size;
  return row_of(deformer)->deform(rest, how);
}

std::shared_ptr<const Scene> deformed(const std::shared_ptr<const Scene>& rest,
                                      const Deformer& deformer, float time) {
  if (strength_at(deformer, time) == 0.0) return rest;
  // A member that is new breaks this line, so that none is forgotten.
  const auto& [name, meshes, instances, materials, textures, lights, sky_image, sky, ambient,
               camera, counts, warnings] = *rest;
  auto scene = std::make_shared<Scene>(Scene{name,
                                             {},
                                             instances,
                                             materials,
                                             textures,
                                             lights,
                                             sky_image,
                                             sky,
                                             ambient,
                                             camera,
                                             counts,
                                             warnings});
  scene->meshes.resize(rest->meshes.size());
  tbb::parallel_for(size_t{0}, rest->meshes.size(), [&](size_t i) {
    scene->meshes[i] = deformed(rest->meshes[i], deformer, time);
  });
  return scene;
}

}  // namespace tracer
