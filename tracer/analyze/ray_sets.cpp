// Ray classes, one function each.
#include "tracer/analyze/ray_sets.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "tracer/bvh/ray_kernels.h"
#include "tracer/math/rng.h"
#include "tracer/render/surface.h"

namespace tracer {
namespace {

constexpr uint64_t seed = 1;
constexpr int tile = 8;  // pixels

std::vector<Hit> trace(const SceneBvh& bvh, std::span<const Ray> rays) {
  std::vector<Hit> hits(rays.size());
  const RayKernel kernel = ray_kernel(bvh.options.layout);
  tbb::parallel_for(tbb::blocked_range<size_t>(0, rays.size(), 4096), [&](const auto& range) {
    kernel.intersect(bvh, rays.subspan(range.begin(), range.size()),
                     std::span(hits).subspan(range.begin(), range.size()));
  });
  return hits;
}

// In tiles, row by row; those at the edge are narrower.
std::vector<Ray> primary_rays(const Camera& camera, int width, int height) {
  std::vector<Ray> rays;
  rays.reserve(size_t(width) * size_t(height));
  const CameraFrame view = frame(camera, width, height);
  for (int top = 0; top < height; top += tile) {
    for (int left = 0; left < width; left += tile) {
      for (int y = top; y < std::min(top + tile, height); ++y) {
        for (int x = left; x < std::min(left + tile, width); ++x)
          rays.push_back(primary_ray(view, vec2(x, y) + 0.5f));
      }
    }
  }
  return rays;
}

// Where primary ray `index` hit something, the surface there.
template <class Use>
void for_each_surface(const RayStart& start, const Use& use) {
  for (size_t i = 0; i < start.hits.size(); ++i) {
    if (!is_hit(start.hits[i])) continue;
    const vec3& direction = start.primary[i].direction;
    use(i, direction, surface_at(start.scene, start.bvh, direction, start.hits[i]));
  }
}

// The normal on the side that the ray came from.
vec3 facing_normal(const Surface& surface) {
  return surface.front ? surface.geometric_normal : -surface.geometric_normal;
}

std::vector<Ray> primary(const RayStart& start) {
  return {start.primary.begin(), start.primary.end()};
}

// To one light from the whole of a tile, to the next one from the next tile. Without lights: to a
// point above the scene.
std::vector<Ray> shadow(const RayStart& start) {
  std::vector<vec3> lights;
  for (const Light& light : start.lights) {
    if (light.on) lights.push_back(light.position);
  }
  if (lights.empty()) {
    const float size = glm::length(extent(start.bounds));
    lights.push_back(center(start.bounds) + size * vec3(0.3f, 1.0f, 0.2f));
  }
  std::vector<Ray> rays;
  for_each_surface(start, [&](size_t i, const vec3&, const Surface& surface) {
    const vec3& light = lights[i / (tile * tile) % lights.size()];
    const vec3 towards = light - surface.position;
    if (glm::dot(towards, facing_normal(surface)) <= 0.0f) return;  // dark without asking
    const vec3 origin = spawn_point(surface, towards);
    rays.push_back({origin, 0.0f, light - origin, 1.0f});
  });
  return rays;
}

std::vector<Ray> reflection(const RayStart& start) {
  std::vector<Ray> rays;
  for_each_surface(start, [&](size_t, const vec3& direction, const Surface& surface) {
    const vec3 normal = facing_normal(surface);
    const vec3 shading = surface.front ? surface.shading_normal : -surface.shading_normal;
    vec3 mirrored = glm::reflect(direction, shading);
    if (glm::dot(mirrored, normal) <= 0.0f) mirrored = glm::reflect(direction, normal);
    rays.push_back({spawn_point(surface, mirrored), 0.0f, mirrored, infinity});
  });
  return rays;
}

std::vector<Ray> diffuse(const RayStart& start) {
  std::vector<Ray> rays;
  for_each_surface(start, [&](size_t i, const vec3&, const Surface& surface) {
    Rng rng = make_rng(seed, i);
    vec3 direction = direction_on_sphere(rng);
    if (glm::dot(direction, facing_normal(surface)) < 0.0f) direction = -direction;
    rays.push_back({spawn_point(surface, direction), 0.0f, direction, infinity});
  });
  return rays;
}

std::vector<Ray> random(const RayStart& start) {
  const vec3 middle = center(start.bounds);
  const float radius = 0.5f * glm::length(extent(start.bounds));
  std::vector<Ray> rays;
  for (size_t i = 0; i < start.primary.size(); ++i) {
    Rng rng = make_rng(seed, i);
    const vec3 from = middle + radius * direction_on_sphere(rng);
    const vec3 to = middle + radius * direction_on_sphere(rng);
    const float length = glm::length(to - from);
    if (length > 0.0f) rays.push_back({from, 0.0f, (to - from) / length, infinity});
  }
  return rays;
}

constexpr RaySetRow rows[] = {
    {"primary", "Primary", "Through the pixels of a view, in tiles of 8 x 8: nearest hit", false,
     true, true, primary},
    {"shadow", "Shadow", "From what primary rays hit to the lights: any hit", true, true, true,
     shadow},
    {"reflection", "Reflection", "Mirrored at what primary rays hit: nearest hit", false, false,
     true, reflection},
    {"diffuse", "Diffuse bounce",
     "From what primary rays hit, evenly over the hemisphere: nearest hit", false, false, true,
     diffuse},
    {"random", "Random", "Between random points of the sphere around the scene: nearest hit", false,
     false, false, random},
};

uint64_t hit_count(const SceneBvh& bvh, const Camera& camera) {
  const std::vector<Hit> hits = trace(bvh, primary_rays(camera, 4 * tile, 4 * tile));
  return static_cast<uint64_t>(std::count_if(hits.begin(), hits.end(), is_hit));
}

bool is_wanted(const RaySetOptions& options, std::string_view id) {
  return options.classes.empty() ||
         std::find(options.classes.begin(), options.classes.end(), id) != options.classes.end();
}

}  // namespace

std::span<const RaySetRow> ray_set_rows() {
  return rows;
}

Camera inside_camera(const SceneBvh& bvh, const Camera& camera) {
  const Box box = bounds(bvh);
  const vec3 own = camera.target - camera.eye;
  const std::array<vec3, 7> directions = {own / std::max(glm::length(own), 1e-30f),
                                          vec3(1, 0, 0),
                                          vec3(0, 0, 1),
                                          vec3(-1, 0, 0),
                                          vec3(0, 0, -1),
                                          vec3(0, -1, 0),
                                          vec3(0, 1, 0)};
  const float size = std::max(glm::length(extent(box)), 1e-30f);
  Camera best;
  uint64_t most = 0;
  for (size_t i = 0; i < directions.size(); ++i) {
    Camera inside;
    inside.eye = center(box);
    inside.target = inside.eye + size * directions[i];
    inside.up = std::abs(directions[i].y) > 0.9f ? vec3(0, 0, 1) : vec3(0, 1, 0);
    inside.fov_degrees = 90.0f;
    const uint64_t hits = hit_count(bvh, inside);
    if (i > 0 && hits <= most) continue;
    best = inside;
    most = hits;
  }
  return best;
}

std::vector<RaySet> make_ray_sets(const Scene& scene, const SceneBvh& bvh,
                                  std::span<const Light> lights, const RaySetOptions& options,
                                  const std::stop_token& stop) {
  const std::pair<const char*, Camera> views[] = {{"camera", options.camera},
                                                  {"inside", inside_camera(bvh, options.camera)}};
  std::vector<RaySet> sets;
  for (const auto& [view, camera] : views) {
    const std::vector<Ray> rays = primary_rays(camera, options.width, options.height);
    const std::vector<Hit> hits = trace(bvh, rays);
    const RayStart start{scene, bvh, lights, rays, hits, bounds(bvh)};
    for (const RaySetRow& row : rows) {
      if (stop.stop_requested()) return sets;
      if (!is_wanted(options, row.id) || (!row.of_view && view != views[0].first)) continue;
      RaySet set{std::string(row.id), row.of_view ? view : "", row.any_hit, row.coherent,
                 row.make(start)};
      if (!set.rays.empty()) sets.push_back(std::move(set));
    }
  }
  const auto place = [](const RaySet& set) {
    return std::find_if(std::begin(rows), std::end(rows),
                        [&](const RaySetRow& row) { return row.id == set.id; });
  };
  std::stable_sort(sets.begin(), sets.end(),
                   [&](const RaySet& a, const RaySet& b) { return place(a) < place(b); });
  return sets;
}

}  // namespace tracer
