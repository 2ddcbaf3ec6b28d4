// Whitted-style ray tracing in batches (T. Whitted, An Improved Illumination Model for Shaded
// Display, 1980). Paths end where what they can still add is invisible (R. Hall, D. Greenberg, A
// Testbed for Realistic Image Synthesis, 1983), so that glass does not cost 2^depth rays.
#include "tracer/render/whitted.h"

#include <algorithm>
#include <cmath>

#include "tracer/bvh/ray_kernels.h"
#include "tracer/bvh/trace.h"
#include "tracer/clock.h"
#include "tracer/math/normalize.h"

namespace tracer {

namespace {

constexpr float min_weight = 1.0f / 1024.0f;  // below it a path is not followed

size_t index(RayClass ray_class) {
  return static_cast<size_t>(ray_class);
}

vec3 reflected(const vec3& direction, const vec3& normal) {
  return direction - 2.0f * glm::dot(direction, normal) * normal;
}

// The share of unpolarised light that a dielectric boundary reflects (Fresnel's equations). eta is
// the refraction index outside divided by the one inside, cosines are positive.
float fresnel_reflectance(float cos_in, float cos_out, float eta) {
  const float parallel = (cos_in - eta * cos_out) / (cos_in + eta * cos_out);
  const float perpendicular = (eta * cos_in - cos_out) / (eta * cos_in + cos_out);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

// Tracers: the ways to trace a batch of rays of one class.
struct Timing {
  static constexpr bool sees_sky = true;
  const RenderOptions& options;
  RayRates& rates;
  std::array<KernelChoice, ray_class_count>& choices;

  template <class Batch>
  void closest(const SceneBvh& bvh, Batch& batch) const {
    timed(bvh, batch,
          [&](const RayKernel& kernel) { kernel.intersect(bvh, batch.rays, batch.hits); });
  }
  template <class Batch>
  void any(const SceneBvh& bvh, Batch& batch) const {
    timed(bvh, batch,
          [&](const RayKernel& kernel) { kernel.occluded(bvh, batch.rays, batch.blocked); });
  }

 private:
  template <class Batch, class Work>
  void timed(const SceneBvh& bvh, const Batch& batch, const Work& work) const {
    const std::string& layout = bvh.options.layout;
    const size_t ray_class = index(batch.ray_class);
    const size_t rays = batch.rays.size();
    std::string_view kernel = kernel_of(options, layout, batch.ray_class);
    if (kernel == automatic_kernel) {
      kernel = suitable_kernel(batch.rays);
      if (kernel == "single") kernel = choices[ray_class].next(rays);
      if (!has_kernel(layout, kernel)) kernel = "single";
    }
    const Clock::time_point start = Clock::now();
    work(ray_kernel(layout, kernel, {}, options.fast ? Tests::fast : Tests::watertight));
    const double seconds = 1e-3 * ms_since(start);
    choices[ray_class].took(kernel, rays, seconds);
    rates[ray_class] +=
        {rays, seconds, kernel == "packet" ? rays : 0, kernel == "stream" ? rays : 0};
  }
};

// Those that record something of every ray: probe_of(class, sample) makes what does;
// done(class, sample, probe) sees it afterwards.
template <class Tracer, class Probe>
struct Recording {
  static constexpr bool sees_sky = false;
  template <class Batch>
  void closest(const SceneBvh& bvh, Batch& batch) {
    trace<false>(bvh, batch);
  }
  template <class Batch>
  void any(const SceneBvh& bvh, Batch& batch) {
    trace<true>(bvh, batch);
    for (size_t i = 0; i < batch.rays.size(); ++i)
      batch.blocked[i] = is_hit(batch.hits[i]);
  }

 private:
  template <bool any_hit, class Batch>
  void trace(const SceneBvh& bvh, Batch& batch) {
    const Tracer& tracer = static_cast<const Tracer&>(*this);
    probes_.clear();
    for (const auto& path : batch.paths)
      probes_.push_back(tracer.probe_of(batch.ray_class, path.sample));
    trace_all<any_hit>(bvh, std::span<const Ray>(batch.rays), std::span<Probe>(probes_),
                       std::span<Hit>(batch.hits));
    for (size_t i = 0; i < batch.rays.size(); ++i)
      tracer.done(batch.ray_class, batch.paths[i].sample, probes_[i]);
  }

  std::vector<Probe> probes_;  // one a ray
};

struct Counting : Recording<Counting, CountProbe> {
  static constexpr bool sees_sky = true;
  std::vector<ClassCounters>& counters;

  explicit Counting(std::vector<ClassCounters>& to) : counters(to) {}
  CountProbe probe_of(RayClass ray_class, uint32_t sample) const {
    Counters& counted = counters[sample][index(ray_class)];
    ++counted.rays;
    return CountProbe(counted);
  }
  void done(RayClass, uint32_t, const CountProbe&) const {}
};

struct Visiting : Recording<Visiting, VisitProbe> {
  ClassVisits& visits;

  explicit Visiting(ClassVisits& to) : visits(to) {}
  VisitProbe probe_of(RayClass ray_class, uint32_t) const {
    return VisitProbe(visits[index(ray_class)]);
  }
  void done(RayClass, uint32_t, const VisitProbe&) const {}
};

struct Watching : Recording<Watching, WatchProbe> {
  const Watched& node;
  std::span<uint8_t> entered;

  Watching(const Watched& watched, std::span<uint8_t> to) : node(watched), entered(to) {}
  WatchProbe probe_of(RayClass, uint32_t) const { return WatchProbe(node); }
  void done(RayClass ray_class, uint32_t sample, const WatchProbe& probe) const {
    if (probe.entered) entered[sample] |= uint8_t(1u << index(ray_class));
  }
};

struct Keeping {
  static constexpr bool sees_sky = false;
  std::vector<CastRay>& rays;

  template <class Batch>
  void closest(const SceneBvh& bvh, Batch& batch) const {
    NoProbe probe;
    for (size_t i = 0; i < batch.rays.size(); ++i) {
      batch.hits[i] = tracer::trace<false>(bvh, batch.rays[i], probe);
      rays[batch.serials[i]].hit = batch.hits[i];
    }
  }
  template <class Batch>
  void any(const SceneBvh& bvh, Batch& batch) const {
    NoProbe probe;
    for (size_t i = 0; i < batch.rays.size(); ++i) {
      const Hit hit = tracer::trace<true>(bvh, batch.rays[i], probe);
      rays[batch.serials[i]].hit = hit;
      batch.blocked[i] = is_hit(hit);
    }
  }
};

}  // namespace

std::string_view kernel_of(const RenderOptions& options, std::string_view layout,
                           RayClass ray_class) {
  const std::string_view kernel = options.kernels[index(ray_class)];
  return has_kernel(layout, kernel) ? kernel : automatic_kernel;
}

std::string_view KernelChoice::next(size_t rays) {
  constexpr uint32_t turns_of_slower = 16;
  if (rays < few_) return "single";
  if (stream_.rays == 0.0) return "stream";
  if (single_.rays == 0.0) return "single";
  const bool stream_is_faster = single_.rays * stream_.seconds < stream_.rays * single_.seconds;
  const bool slower = ++turns_ % turns_of_slower == 0;
  return stream_is_faster != slower ? "stream" : "single";
}

void KernelChoice::took(std::string_view kernel, size_t rays, double seconds) {
  constexpr double kept =
      0.7;  // of what is known, as more comes: a bad measurement is forgotten soon
  if (kernel == "packet" || rays < few_) return;
  Taken& taken = kernel == "stream" ? stream_ : single_;
  taken.rays = kept * taken.rays + double(rays);
  taken.seconds = kept * taken.seconds + seconds;
}

Whitted::Whitted() {
  for (size_t i = 0; i < batches_.size(); ++i)
    batches_[i].ray_class = next_[i].ray_class = static_cast<RayClass>(i);
}

void Whitted::trace(const World& world, const CameraFrame& camera, std::span<const vec2> points,
                    bool counting) {
  counters_.assign(counting ? points.size() : 0, ClassCounters{});
  if (counting) {
    trace_bounces(world, camera, points, Counting(counters_));
  } else {
    trace_bounces(world, camera, points, Timing{world.options, rates_, choices_});
  }
}

void Whitted::trace_visits(const World& world, const CameraFrame& camera,
                           std::span<const vec2> points, ClassVisits& visits) {
  trace_bounces(world, camera, points, Visiting(visits));
}

void Whitted::trace_watching(const World& world, const CameraFrame& camera,
                             std::span<const vec2> points, const Watched& node,
                             std::span<uint8_t> entered) {
  trace_bounces(world, camera, points, Watching(node, entered));
}

std::vector<CastRay> Whitted::trace_rays(const World& world, const CameraFrame& camera,
                                         std::span<const vec2> points) {
  std::vector<CastRay> rays;
  cast_ = &rays;
  trace_bounces(world, camera, points, Keeping{rays});
  cast_ = nullptr;
  return rays;
}

template <class Tracer>
void Whitted::trace_bounces(const World& world, const CameraFrame& camera,
                            std::span<const vec2> points, Tracer&& tracer) {
  sees_sky_ = std::remove_reference_t<Tracer>::sees_sky;
  hits_.clear();
  radiance_.assign(points.size(), vec3(0.0f));
  depth_.assign(points.size(), 0);
  shadows_.resize(world.look.lights.size());
  add_primary(camera, points);
  bool are_left = !points.empty();
  for (int bounce = 0; are_left; ++bounce) {
    for (Batch& batch : batches_) {
      if (batch.rays.empty()) continue;
      batch.hits.resize(batch.rays.size());
      tracer.closest(world.bvh, batch);
      shade_all(world, batch, bounce);
      if (bounce == 0) std::swap(hits_, batch.hits);
      batch.clear();
    }
    trace_shadows(world, tracer);
    std::swap(batches_, next_);
    are_left =
        std::ranges::any_of(batches_, [](const Batch& batch) { return !batch.rays.empty(); });
  }
}

template <class Tracer>
void Whitted::trace_shadows(const World& world, Tracer& tracer) {
  for (Batch& batch : shadows_) {
    if (batch.rays.empty()) continue;
    batch.hits.resize(batch.rays.size());
    batch.blocked.resize(batch.rays.size());
    tracer.any(world.bvh, batch);
    for (size_t i = 0; i < batch.paths.size(); ++i)
      if (batch.blocked[i] == 0) radiance_[batch.paths[i].sample] += batch.paths[i].weight;
    batch.clear();
  }
}

void Whitted::Batch::clear() {
  rays.clear();
  paths.clear();
  serials.clear();
}

void Whitted::add_primary(const CameraFrame& camera, std::span<const vec2> points) {
  Batch& batch = batches_[index(RayClass::primary)];
  batch.rays.resize(points.size());
  primary_rays(camera, points, batch.rays);
  batch.paths.resize(points.size());
  for (uint32_t i = 0; i < points.size(); ++i)
    batch.paths[i] = {vec3(1.0f), i};
  if (cast_ == nullptr) return;
  for (uint32_t i = 0; i < points.size(); ++i)
    keep(batch, batch.rays[i], i, none);
}

void Whitted::add(Batch& batch, const Ray& ray, const Path& path, uint32_t parent) {
  batch.rays.push_back(ray);
  batch.paths.push_back(path);
  if (cast_ != nullptr) keep(batch, ray, path.sample, parent);
}

void Whitted::keep(Batch& batch, const Ray& ray, uint32_t sample, uint32_t parent) {
  CastRay cast{ray, batch.ray_class, sample, parent, 0, {}};
  if (parent != none)
    cast.bounce = (*cast_)[parent].bounce + (batch.ray_class == RayClass::shadow ? 0 : 1);
  batch.serials.push_back(static_cast<uint32_t>(cast_->size()));
  cast_->push_back(cast);
}

void Whitted::shade_all(const World& world, const Batch& batch, int bounce) {
  if (bounce > 0)
    for (const Path& path : batch.paths)
      depth_[path.sample] = static_cast<uint8_t>(bounce);
  const size_t count = batch.rays.size();
  // What is hit, and what is not: without branches.
  to_surface_.resize(count);
  to_sky_.resize(count);
  size_t surfaces = 0, skies = 0;
  for (size_t i = 0; i < count; ++i) {
    const bool hits = is_hit(batch.hits[i]);
    to_surface_[surfaces] = static_cast<uint32_t>(i);
    to_sky_[skies] = static_cast<uint32_t>(i);
    surfaces += hits ? 1 : 0;
    skies += hits ? 0 : 1;
  }
  to_surface_.resize(surfaces);
  to_sky_.resize(skies);
  if (sees_sky_) add_sky(world, batch);

  for (size_t first = 0; first < surfaces; first += shaded_at_once_)
    shade_some(world, batch, first, std::min(first + shaded_at_once_, surfaces), bounce);
}

// First what the next ones lie at, then these: the memory answers meanwhile.
void Whitted::shade_some(const World& world, const Batch& batch, size_t first, size_t end,
                         int bounce) {
  const size_t all = to_surface_.size(), count = end - first;
  const auto hit = [&](size_t at) -> const Hit& { return batch.hits[to_surface_[at]]; };
  for (size_t at = first; at < end; ++at) {
    const size_t next = at + shaded_at_once_, next_but_one = next + shaded_at_once_;
    if (next_but_one < all) prefetch_indices(world.scene, hit(next_but_one));
    if (next < all) prefetch_corners(world.scene, hit(next));
    shaded_.hits[at - first] = hit(at);
    shaded_.directions[at - first] = batch.rays[to_surface_[at]].direction;
  }
  surfaces_at(world.scene, world.bvh, {shaded_.directions.data(), count},
              {shaded_.hits.data(), count}, {shaded_.surfaces.data(), count});
  for (size_t i = 0; i < count; ++i) {
    const Surface& surface = shaded_.surfaces[i];
    const Material& material = world.look.materials[surface.material];
    shaded_.textures[i] = fetch_albedo(world.scene, material, surface.uv);
  }
  for (size_t i = 0; i < count; ++i) {
    const uint32_t ray = to_surface_[first + i];
    const uint32_t serial = cast_ == nullptr ? none : batch.serials[ray];
    shade(
        world,
        {batch.paths[ray], shaded_.directions[i], serial, shaded_.surfaces[i], shaded_.textures[i]},
        bounce < world.options.ray_depth);
  }
}

void Whitted::add_sky(const World& world, const Batch& batch) {
  for (size_t first = 0; first < to_sky_.size(); first += skies_at_once_) {
    const size_t count = std::min(skies_at_once_, to_sky_.size() - first);
    for (size_t i = 0; i < count; ++i)
      sky_.directions[i] = batch.rays[to_sky_[first + i]].direction;
    sky_radiance(world.scene.sky_image, world.look.sky, {sky_.directions.data(), count},
                 {sky_.radiance.data(), count});
    for (size_t i = 0; i < count; ++i) {
      const Path& path = batch.paths[to_sky_[first + i]];
      radiance_[path.sample] += path.weight * sky_.radiance[i];
    }
  }
}

void Whitted::shade(const World& world, const Shaded& at, bool may_bounce) {
  const Surface& surface = at.surface;
  const vec3& weight = at.path.weight;
  const Material& material = world.look.materials[surface.material];
  const vec3 normal = surface.front ? surface.shading_normal : -surface.shading_normal;
  radiance_[at.path.sample] += weight * material.emission;

  const float diffuse_share = 1.0f - material.reflectivity - material.transmission;
  if (diffuse_share > 0.0f) {
    const vec3 albedo = albedo_at(world.scene, material, at.texture);
    add_direct_light(world, at, normal, weight * diffuse_share * albedo);
  }
  if (!may_bounce) return;
  if (material.reflectivity > 0.0f) {
    cast(at, reflected(at.direction, normal), weight * material.reflectivity * material.specular,
         RayClass::reflection);
  }
  if (material.transmission > 0.0f) enter_glass(at, normal, material);
}

// Lambert: ambient light at once, each light's share if its shadow ray gets through.
void Whitted::add_direct_light(const World& world, const Shaded& at, const vec3& normal,
                               const vec3& diffuse) {
  const Surface& surface = at.surface;
  vec3& radiance = radiance_[at.path.sample];
  radiance += diffuse * world.look.ambient;
  for (uint32_t i = 0; i < world.look.lights.size(); ++i) {
    const Light& light = world.look.lights[i];
    if (!light.on) continue;
    const vec3 way = light.position - surface.position;
    const float distance = safe_length(way);
    const vec3 direction = safe_normalize(way, normal);
    const float cosine = glm::dot(direction, normal);
    if (!(cosine > 0.0f) || !(distance > 0.0f)) continue;
    const vec3 arriving = diffuse * light.color * (light.intensity * cosine / distance / distance);
    if (!world.options.shadows) {
      radiance += arriving;
    } else if (max_component(arriving) > 0.0f) {
      Ray ray;
      ray.origin = spawn_point(surface, direction);
      ray.direction = light.position - ray.origin;
      ray.t_max = 1.0f;
      add(shadows_[i], ray, {arriving, at.path.sample}, at.serial);
    }
  }
}

// Refraction by Snell's law and reflection, shared out by Fresnel's; total reflection where there
// is no way through.
void Whitted::enter_glass(const Shaded& at, const vec3& normal, const Material& material) {
  const vec3& direction = at.direction;
  const vec3 weight = at.path.weight * material.transmission * material.specular;
  const float eta = at.surface.front ? 1.0f / material.refraction_index : material.refraction_index;
  const float cos_in = std::clamp(-glm::dot(direction, normal), 0.0f, 1.0f);
  const float sin2_out = eta * eta * (1.0f - cos_in * cos_in);
  if (sin2_out >= 1.0f) {
    cast(at, reflected(direction, normal), weight, RayClass::reflection);
    return;
  }
  const float cos_out = std::sqrt(1.0f - sin2_out);
  const float reflectance = fresnel_reflectance(cos_in, cos_out, eta);
  cast(at, reflected(direction, normal), weight * reflectance, RayClass::reflection);
  cast(at, eta * direction + (eta * cos_in - cos_out) * normal, weight * (1.0f - reflectance),
       RayClass::refraction);
}

void Whitted::cast(const Shaded& from, const vec3& direction, const vec3& weight,
                   RayClass ray_class) {
  if (!(max_component(weight) >= min_weight)) return;
  const Surface& surface = from.surface;
  vec3 way = safe_normalize(direction, surface.geometric_normal);
  // An interpolated normal can send a ray to the wrong side of the true surface: mirror it back.
  const vec3& normal = surface.geometric_normal;
  const bool goes_through = (glm::dot(way, normal) > 0.0f) != surface.front;
  if (goes_through != (ray_class == RayClass::refraction)) way = reflected(way, normal);
  Ray ray;
  ray.origin = spawn_point(surface, way);
  ray.direction = way;
  add(next_[index(ray_class)], ray, {weight, from.path.sample}, from.serial);
}

}  // namespace tracer
