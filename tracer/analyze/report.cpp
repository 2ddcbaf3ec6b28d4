// The report's JSON. Field names carry their units; figures are over all BLASes, each counted once,
// unless the name says tlas_.
#include "tracer/analyze/report.h"

#include "tracer/analyze/blend.h"
#include "tracer/analyze/measures.h"
#include "tracer/analyze/quality.h"
#include "tracer/bvh/ray_kernels.h"
#include "tracer/machine.h"

namespace tracer {
namespace {

Json vector_json(const vec3& v) {
  return Json::array({v.x, v.y, v.z});
}

Json percentiles_json(const Percentiles& cost) {
  return {{"mean", cost.mean},
          {"p50", cost.p50},
          {"p95", cost.p95},
          {"p99", cost.p99},
          {"max", cost.max}};
}

Json rays_json(const Snapshot& snapshot) {
  Json rays = Json::object();
  const std::array<RayStatistics, ray_class_count> statistics =
      snapshot.ray_statistics ? *snapshot.ray_statistics : ray_statistics(snapshot.film);
  for (int i = 0; i < ray_class_count; ++i) {
    const RayRate& rate = snapshot.rates[i];
    const auto share = [&](uint64_t some) {
      return rate.rays > 0 ? double(some) / double(rate.rays) : 0.0;
    };
    const double per_thread = rate.seconds > 0.0 ? double(rate.rays) / rate.seconds : 0.0;
    rays[std::string(ray_classes()[i].id)] = {
        {"count", statistics[i].count},
        {"nodes", percentiles_json(statistics[i].nodes)},
        {"triangles", percentiles_json(statistics[i].triangles)},
        {"leaves", percentiles_json(statistics[i].leaves)},
        {"instances", percentiles_json(statistics[i].instances)},
        {"mrays_per_s", 1e-6 * per_thread * thread_count()},
        {"kernel", kernel_of(snapshot.settings.render, snapshot.bvh->options.layout,
                             static_cast<RayClass>(i))},
        {"in_packets", share(rate.in_packets)},
        {"in_streams", share(rate.in_streams)}};
  }
  return rays;
}

Json pairs_json(const InstanceOverlap& instances) {
  Json pairs = Json::array();
  for (const InstancePair& pair : instances.worst) {
    pairs.push_back({{"a", pair.a}, {"b", pair.b}, {"overlap", pair.overlap}});
  }
  return pairs;
}

Json sah_test_json(const Measures& measures) {
  if (!measures.sah_test) return nullptr;
  return {{"mesh", measures.sah_test_mesh},
          {"sah", measures.sah_test->sah},
          {"measured", measures.sah_test->measured},
          {"standard_error", measures.sah_test->standard_error},
          {"lines", measures.sah_test->lines},
          {"holds", holds(*measures.sah_test)}};
}

// How the trees came to the shape of the moment. Times are those of this moment alone.
Json update_json(const Snapshot& snapshot) {
  const Settings& settings = snapshot.settings;
  const UpdateFacts& facts = snapshot.update;
  return {{"deformer", settings.deformer.kind},
          {"strategy", settings.update.strategy},
          {"time_s", settings.time},
          {"deformed", facts.deformed},
          {"refitted", facts.refitted},
          {"built_at_s", facts.built_time < 0.0f ? Json() : Json(facts.built_time)},
          {"deform_ms", facts.deform_ms},
          {"refit_ms", facts.refit_ms},
          {"build_ms", facts.build_ms},
          {"tlas_ms", snapshot.bvh->tlas_ms},
          {"growth_mean", snapshot.growth.mean},
          {"growth_max", snapshot.growth.max},
          {"growth_max_mesh", snapshot.growth.mesh == none ? Json() : Json(snapshot.growth.mesh)},
          {"growth_max_node", snapshot.growth.node == none ? Json() : Json(snapshot.growth.node)},
          {"warning", facts.warning}};
}

// EPO, overlap and empty space, and what only a TLAS has.
Json measures_json(const Snapshot& snapshot, const std::stop_token& stop) {
  const BuildOptions& options = snapshot.bvh->options;
  const Measures measures =
      measure(*snapshot.scene, snapshot.bvh, nullptr, {.stop = stop, .report = nullptr});
  const Epo blas = measures.blas_epo.value_or(Epo());
  const Epo tlas = measures.tlas_epo.value_or(Epo());
  const Overlap blas_shared = measures.blas_overlap.value_or(Overlap());
  const Overlap tlas_shared = measures.tlas_overlap.value_or(Overlap());
  const InstanceOverlap instances = measures.instances.value_or(InstanceOverlap());
  return {{"epo", blas.value},
          {"epo_standard_error", blas.standard_error},
          {"epo_samples", blas.samples},
          {"epo_traversal_cost", options.traversal_cost},
          {"epo_intersection_cost", options.intersection_cost},
          {"overlap", blas_shared.siblings},
          {"empty_space", blas_shared.empty_space},
          {"sah_test", sah_test_json(measures)},
          {"tlas_epo", tlas.value},
          {"tlas_epo_standard_error", tlas.standard_error},
          {"tlas_overlap", tlas_shared.siblings},
          {"tlas_empty_space", tlas_shared.empty_space},
          {"tlas_instance_overlap", instances.mean},
          {"tlas_overlapping_neighbours", instances.mean_neighbours},
          {"tlas_worst_pairs", pairs_json(instances)},
          {"tlas_wasted_entries", share(snapshot.wasted_entries)}};
}

// Over the builds that are reported; null if fewer than three differ.
Json blend_json(const Json& builds) {
  std::vector<BlendSample> samples;
  for (const Json& build : builds) {
    const Json& primary = build.at("rays").at("primary");
    samples.push_back({build.at("sah"), build.at("epo"),
                       primary.at("nodes").at("mean").get<double>() *
                               build.at("sah_traversal_cost").get<double>() +
                           primary.at("triangles").at("mean").get<double>() *
                               build.at("sah_intersection_cost").get<double>()});
  }
  const std::optional<Blend> blend = fit_blend(samples);
  if (!blend) return nullptr;
  Json costs = Json::array();
  for (const BlendSample& sample : samples) {
    costs.push_back({{"predicted", predicted_cost(*blend, sample.sah, sample.epo)},
                     {"measured", sample.measured}});
  }
  return {{"alpha", blend->alpha},
          {"scale", blend->scale},
          {"correlation", blend->correlation},
          {"mean_absolute_percentage_error", 100.0 * blend->mean_error},
          {"builds", costs}};
}

}  // namespace

Json scene_json(const Scene& scene) {
  uint64_t triangles = 0;
  for (const Mesh& mesh : scene.meshes)
    triangles += mesh.triangles.size();
  uint64_t instanced_triangles = 0;
  for (const Instance& instance : scene.instances) {
    instanced_triangles += scene.meshes[instance.mesh].triangles.size();
  }
  const Box box = bounds(scene);
  return {{"name", scene.name},
          {"meshes", scene.meshes.size()},
          {"instances", scene.instances.size()},
          {"triangles", triangles},
          {"instanced_triangles", instanced_triangles},
          {"materials", scene.materials.size()},
          {"textures", scene.textures.size()},
          {"lights", scene.lights.size()},
          {"bounds_min", vector_json(box.lo)},
          {"bounds_max", vector_json(box.hi)}};
}

Json machine_json() {
  return {{"cpu", cpu_name()},
          {"threads", thread_count()},
          {"isa", isa_name()},
          {"kernel_isa", preferred_isa().id}};
}

Json settings_json(const Settings& settings) {
  const Camera camera = settings.look ? settings.look->camera : Camera{};
  return {{"width", settings.render.width},       {"height", settings.render.height},
          {"depth", settings.render.ray_depth},   {"eye", vector_json(camera.eye)},
          {"target", vector_json(camera.target)}, {"fov_degrees", camera.fov_degrees}};
}

Json build_json(const Snapshot& snapshot, const std::stop_token& stop) {
  const SceneBvh& bvh = *snapshot.bvh;
  const BuildOptions& options = bvh.options;
  const TreeStatistics blas =
      snapshot.blas_statistics ? *snapshot.blas_statistics : blas_statistics(bvh);
  const TreeStatistics tlas =
      snapshot.tlas_statistics ? *snapshot.tlas_statistics : tlas_statistics(bvh);
  Json build = {
      {"builder", options.builder},
      {"layout", snapshot.settings.build.layout},
      {"options",
       {{"optimizer", options.optimizer},
        {"bins", options.bins},
        {"search_radius", options.search_radius},
        {"collapse", options.collapse},
        {"reinsertion_share", options.reinsertion_share},
        {"reinsertion_rounds", options.reinsertion_rounds},
        {"presplit", options.presplit},
        {"split_budget", options.split_budget},
        {"min_overlap", options.min_overlap},
        {"rebraid", options.rebraid},
        {"max_leaf_size", options.max_leaf_size},
        {"max_depth", options.max_depth},
        {"widening", options.widening},
        {"occlusion_order", options.occlusion_order}}},
      {"build_ms", snapshot.build_ms},
      {"nodes", blas.nodes},
      {"leaves", blas.leaves},
      {"references", blas.references},
      {"max_depth", blas.max_depth},
      {"mean_leaf_depth", blas.mean_leaf_depth},
      {"max_leaf_size", blas.max_leaf_size},
      {"bytes", blas.bytes},
      {"bytes_per_triangle", double(blas.bytes) / double(std::max<uint64_t>(blas.primitives, 1))},
      {"sah", blas.sah},
      {"sah_traversal_cost", blas.traversal_cost},
      {"sah_intersection_cost", blas.intersection_cost},
      {"leaf_size_histogram", blas.leaf_size_histogram},
      {"leaf_depth_histogram", blas.leaf_depth_histogram},
      {"tlas_nodes", tlas.nodes},
      {"tlas_leaves", tlas.leaves},
      {"tlas_max_depth", tlas.max_depth},
      {"tlas_sah", tlas.sah},
      {"tlas_build_ms", bvh.tlas_ms},
      {"tlas_bytes", tlas.bytes}};
  build["update"] = update_json(snapshot);
  build.update(measures_json(snapshot, stop));
  build["rays"] = rays_json(snapshot);
  return build;
}

Json report_json(std::span<const std::shared_ptr<const Snapshot>> snapshots,
                 const std::stop_token& stop) {
  const Snapshot& first = *snapshots.front();
  Json builds = Json::array();
  for (const std::shared_ptr<const Snapshot>& snapshot : snapshots) {
    builds.push_back(build_json(*snapshot, stop));
  }
  Json report = {{"schema", 1},
                 {"scene", scene_json(*first.scene)},
                 {"settings", settings_json(first.settings)},
                 {"builds", builds}};
  report["settings"]["tests"] = first.settings.render.fast ? "fast" : "watertight";
  if (snapshots.size() > 1) report["blend"] = blend_json(builds);
  report["machine"] = machine_json();
  return report;
}

}  // namespace tracer
