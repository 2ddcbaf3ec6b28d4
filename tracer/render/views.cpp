// The views: one small function and one row each.
#include "tracer/render/views.h"

#include <cmath>

#include <tbb/parallel_for.h>

#include "tracer/analyze/point_cost.h"
#include "tracer/scene/texture.h"

namespace tracer {
namespace {

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();

Ray ray_of(const ViewPixel& pixel) {
  return primary_ray(pixel.input.camera, vec2(pixel.x, pixel.y) + 0.5f);
}

Surface surface_of(const ViewPixel& pixel) {
  const Snapshot& snapshot = pixel.input.snapshot;
  return surface_at(*snapshot.scene, *snapshot.bvh, ray_of(pixel).direction, pixel.hit);
}

vec2 uv_of(const ViewPixel& pixel) {
  return uv_at(*pixel.input.snapshot.scene, pixel.hit);
}

vec3 normal_of(const ViewPixel& pixel) {
  return geometric_normal_at(*pixel.input.snapshot.scene, *pixel.input.snapshot.bvh, pixel.hit);
}

vec3 to_srgb(vec3 linear) {
  return {srgb_from_linear(linear.x), srgb_from_linear(linear.y), srgb_from_linear(linear.z)};
}

// A colour for a number, bright enough to tell neighbours apart. The mixing is Murmur3's finalizer
// (A. Appleby, 2011).
vec3 hashed_color(uint32_t id) {
  uint32_t h = id + 0x9e3779b9u;
  h = (h ^ h >> 16) * 0x85ebca6bu;
  h = (h ^ h >> 13) * 0xc2b2ae35u;
  h ^= h >> 16;
  return vec3(64 + h % 192, 64 + (h >> 8) % 192, 64 + (h >> 16) % 192) / 255.0f;
}

// How squarely the viewer looks at a surface, as a grey that never gets dark: shows the shape.
float headlight(const ViewPixel& pixel, vec3 normal) {
  return 0.45f + 0.55f * std::abs(glm::dot(normal, ray_of(pixel).direction));
}

vec3 albedo(const ViewPixel& pixel) {
  const Snapshot& snapshot = pixel.input.snapshot;
  const Material& material =
      snapshot.settings.look->materials[material_at(*snapshot.scene, pixel.hit)];
  return to_srgb(albedo_at(*snapshot.scene, material, uv_of(pixel)));
}

vec3 uv(const ViewPixel& pixel) {
  const vec2 uv = uv_of(pixel);
  return {glm::fract(uv), 0.0f};
}

// Eight by eight fields over the unit square, tinted by where in it they are.
vec3 uv_checker(const ViewPixel& pixel) {
  const vec2 uv = uv_of(pixel);
  const ivec2 field = ivec2(glm::floor(uv * 8.0f));
  const float brightness = ((field.x ^ field.y) & 1) != 0 ? 1.0f : 0.35f;
  return brightness * vec3(0.35f + 0.65f * glm::fract(uv), 0.6f);
}

vec3 normal(const ViewPixel& pixel) {
  return 0.5f + 0.5f * normal_of(pixel);
}

vec3 shading_normal(const ViewPixel& pixel) {
  return 0.5f + 0.5f * surface_of(pixel).shading_normal;
}

vec3 facing(const ViewPixel& pixel) {
  const vec3 normal = normal_of(pixel);
  const bool front = glm::dot(normal, ray_of(pixel).direction) <= 0.0f;
  const vec3 color = front ? vec3(0.25f, 0.80f, 0.35f) : vec3(0.90f, 0.20f, 0.18f);
  return color * headlight(pixel, normal);
}

vec3 barycentric(const ViewPixel& pixel) {
  const Hit& hit = pixel.hit;
  return {1.0f - hit.u - hit.v, hit.u, hit.v};
}

vec3 triangle(const ViewPixel& pixel) {
  return hashed_color(pixel.hit.triangle);
}

vec3 instance(const ViewPixel& pixel) {
  return hashed_color(pixel.hit.instance);
}

vec3 material(const ViewPixel& pixel) {
  return hashed_color(material_at(*pixel.input.snapshot.scene, pixel.hit));
}

// The barycentric weights where a ray meets the plane of a triangle with this normal.
vec3 weights_in_plane(const Ray& ray, vec3 a, vec3 ab, vec3 ac, vec3 normal) {
  const float t = glm::dot(a - ray.origin, normal) / glm::dot(ray.direction, normal);
  const vec3 p = ray.origin + t * ray.direction - a;
  const float per_area = 1.0f / glm::dot(normal, normal);
  const float v = glm::dot(glm::cross(p, ac), normal) * per_area;
  const float w = glm::dot(glm::cross(ab, p), normal) * per_area;
  return {1.0f - v - w, v, w};
}

// A triangle as the picture shows it, in pixels.
struct Projection {
  float to_edge;  // from this pixel to the nearest edge
  float radius;   // of the largest circle inside
};

// A weight is zero on its edge, one at the corner across, and grows evenly over the image: its
// value over its gradient is the distance to the edge. In the middle all three distances are the
// radius.
Projection projected(const ViewPixel& pixel) {
  const Snapshot& snapshot = pixel.input.snapshot;
  const Hit& hit = pixel.hit;
  const PlacedInstance& placed = snapshot.bvh->instances[hit.instance];
  const Mesh& mesh = snapshot.scene->meshes[placed.mesh];
  const uvec3 corners = mesh.triangles[hit.triangle];
  const vec3 a = vec3(placed.to_world * vec4(mesh.positions[corners.x], 1.0f));
  const vec3 ab = mat3(placed.to_world) * (mesh.positions[corners.y] - mesh.positions[corners.x]);
  const vec3 ac = mat3(placed.to_world) * (mesh.positions[corners.z] - mesh.positions[corners.x]);
  const vec3 normal = glm::cross(ab, ac);

  const vec2 centre = vec2(pixel.x, pixel.y) + 0.5f;
  const Ray right = primary_ray(pixel.input.camera, centre + vec2(1.0f, 0.0f));
  const Ray below = primary_ray(pixel.input.camera, centre + vec2(0.0f, 1.0f));
  const vec3 here(1.0f - hit.u - hit.v, hit.u, hit.v);
  const vec3 dx = weights_in_plane(right, a, ab, ac, normal) - here;
  const vec3 dy = weights_in_plane(below, a, ab, ac, normal) - here;
  const vec3 gradient = glm::sqrt(dx * dx + dy * dy);
  const vec3 distance = here / gradient;
  return {std::min({distance.x, distance.y, distance.z}),
          1.0f / (gradient.x + gradient.y + gradient.z)};
}

// Lines fade where triangles get so small that there would be nothing but lines.
vec3 wireframe(const ViewPixel& pixel) {
  const float line_half_width = 0.6f;
  const vec3 line(0.05f, 0.06f, 0.10f);
  const float grey = headlight(pixel, normal_of(pixel));
  const Projection triangle = projected(pixel);
  const float cover = glm::clamp(line_half_width + 0.5f - triangle.to_edge, 0.0f, 1.0f);
  const float opacity = glm::clamp(triangle.radius / 4.0f, 0.25f, 1.0f);
  return glm::mix(vec3(0.80f, 0.83f, 0.88f) * grey, line, cover * opacity);
}

float depth(const ViewPixel& pixel) {
  return is_hit(pixel.hit) ? pixel.hit.t : no_value;
}

float counter(const ViewPixel& pixel) {
  const Counters counted = of_class(pixel.counters, pixel.input.ray_class);
  return counted.rays > 0 ? float(counted.*pixel.input.counter) : no_value;
}

// What SAH counts, measured.
float cost(const ViewPixel& pixel) {
  const Counters counted = of_class(pixel.counters, pixel.input.ray_class);
  if (counted.rays == 0) return no_value;
  const BuildOptions& options = pixel.input.snapshot.bvh->options;
  return float(counted.nodes) * options.traversal_cost +
         float(counted.triangles) * options.intersection_cost;
}

float ray_depth(const ViewPixel& pixel) {
  return float(pixel.depth);
}

float growth(const ViewPixel& pixel) {
  if (!is_hit(pixel.hit)) return no_value;
  const uint32_t mesh = pixel.input.snapshot.bvh->instances[pixel.hit.instance].mesh;
  return pixel.input.growth[mesh][pixel.hit.triangle];
}

float useless_boxes(const ViewPixel& pixel) {
  if (!is_hit(pixel.hit)) return no_value;
  const Snapshot& snapshot = pixel.input.snapshot;
  return float(point_cost(*snapshot.scene, *snapshot.bvh, pixel.hit).useless);
}

float point_epo(const ViewPixel& pixel) {
  if (!is_hit(pixel.hit)) return no_value;
  const Snapshot& snapshot = pixel.input.snapshot;
  return float(point_cost(*snapshot.scene, *snapshot.bvh, pixel.hit).cost);
}

constexpr ViewRow color_row(std::string_view id, std::string_view label, std::string_view help,
                            vec3 (*color)(const ViewPixel&)) {
  return {id, label, help, "", ViewKind::color, false, false, color, nullptr};
}

constexpr ViewRow rows[] = {
    {"shaded", "Shaded", "Light as it reaches the camera, exposed and tone mapped", "",
     ViewKind::radiance},
    color_row("albedo", "Albedo", "Diffuse colour with its texture, no light", albedo),
    color_row("uv", "UV", "Texture coordinates: red is u, green is v, repeating", uv),
    color_row("uv_checker", "UV checker", "8x8 fields over the texture: shows stretch and seams",
              uv_checker),
    color_row("normal", "Geometric normal", "Of the flat triangle, world x y z as red green blue",
              normal),
    color_row("shading_normal", "Shading normal", "Interpolated, world x y z as red green blue",
              shading_normal),
    color_row("facing", "Facing",
              "Green: seen from the front, as the winding says; red: from behind", facing),
    {"depth", "Depth", "Distance from the camera along the ray", "scene units", ViewKind::value,
     false, false, nullptr, depth},
    color_row("barycentric", "Barycentric", "Weights of the three corners as red, green, blue",
              barycentric),
    color_row("triangle", "Triangle", "One colour a triangle", triangle),
    color_row("instance", "Instance", "One colour an instance", instance),
    color_row("material", "Material", "One colour a material", material),
    color_row("wireframe", "Wireframe", "Edges of the triangles, of even width", wireframe),
    {"counter", "Counter", "Heat map of the chosen counter and ray class", "", ViewKind::value,
     true, true, nullptr, counter},
    {"cost", "Traversal cost",
     "Measured cost in SAH's units: nodes * Ct + triangle tests * Ci of the chosen ray class",
     "triangle tests per pixel", ViewKind::value, false, true, nullptr, cost},
    {"ray_depth", "Ray depth", "Bounces that the deepest ray of the pixel made", "bounces",
     ViewKind::value, true, false, nullptr, ray_depth},
    {"growth", "Refit growth",
     "Area of the leaf box that holds the triangle, now against when the tree was built; 1 "
     "everywhere unless a deformed mesh is refitted",
     "times the area at the build", ViewKind::value, false, false, nullptr, growth, true},
    {"overlap", "Overlap",
     "Boxes of both levels that cover the surface at the pixel and have nothing to do with it: a "
     "ray that ends there enters them for nothing",
     "useless boxes", ViewKind::value, true, false, nullptr, useless_boxes},
    {"epo", "End-point overlap",
     "What those boxes cost a ray that ends there: Ct an inner node, count * Ci a leaf. Raw EPO is "
     "the mean of this over the surface",
     "triangle tests", ViewKind::value, false, false, nullptr, point_epo},
};

}  // namespace

ViewInput view_input(const Snapshot& snapshot, const ViewRow& view, const CounterRow& counter,
                     int ray_class) {
  const Camera& camera = snapshot.settings.look ? snapshot.settings.look->camera : Camera{};
  ViewInput input{snapshot,
                  frame(camera, snapshot.film.width, snapshot.film.height),
                  counter.member,
                  ray_class,
                  {}};
  if (!view.by_growth || !snapshot.bvh) return input;
  input.growth.resize(snapshot.bvh->blases.size());
  tbb::parallel_for(size_t{0}, input.growth.size(), [&](size_t i) {
    input.growth[i] =
        triangle_growth(*snapshot.bvh->blases[i], snapshot.scene->meshes[i].triangles.size());
  });
  return input;
}

std::span<const ViewRow> views() {
  return rows;
}

}  // namespace tracer
