// One pixel's rays, with every step of their traversal.
#include "tracer/analyze/ray_log_report.h"

#include <cmath>

#include <fmt/format.h>

#include "tracer/analyze/ray_words.h"

namespace tracer {
namespace {

Json number_json(float number) {
  return std::isfinite(number) ? Json(number) : Json();
}

Json index_json(uint32_t index) {
  return index == none ? Json() : Json(index);
}

Json point_json(const vec3& point) {
  return Json::array({point.x, point.y, point.z});
}

std::string_view id_of(RayClass ray_class) {
  return ray_classes()[static_cast<size_t>(ray_class)].id;
}

Json hit_json(const Hit& hit) {
  if (!is_hit(hit)) return nullptr;
  return {{"t", hit.t},
          {"u", hit.u},
          {"v", hit.v},
          {"triangle", hit.triangle},
          {"instance", hit.instance}};
}

Json counters_json(const Counters& counters) {
  return {{"nodes", counters.nodes},
          {"leaves", counters.leaves},
          {"triangles", counters.triangles},
          {"instances", counters.instances}};
}

bool has_span(const Step& step) {
  return step.kind == StepKind::node || step.kind == StepKind::leaf ||
         step.result == StepResult::hit;
}

Json step_json(const Step& step) {
  return {{"kind", name(step.kind)},
          {"id", step.id},
          {"level", step.instance == none ? "tlas" : "blas"},
          {"instance", index_json(step.instance)},
          {"depth", step.depth},
          {"t_entry", has_span(step) ? number_json(step.t_entry) : Json()},
          {"t_exit", has_span(step) ? number_json(step.t_exit) : Json()},
          {"t_best", number_json(step.t_best)},
          {"result", name(step.result)},
          {"from", step.kind == StepKind::instance ? Json(step.from) : Json()},
          {"stack", step.stack}};
}

Json ray_json(const LoggedRay& ray) {
  Json steps = Json::array();
  for (const Step& step : ray.steps)
    steps.push_back(step_json(step));
  const CastRay& cast = ray.cast;
  return {{"class", id_of(cast.ray_class)},
          {"depth", cast.bounce},
          {"parent", index_json(cast.parent)},
          {"origin", point_json(cast.ray.origin)},
          {"direction", point_json(cast.ray.direction)},
          {"t_min", number_json(cast.ray.t_min)},
          {"t_max", number_json(cast.ray.t_max)},
          {"hit", hit_json(cast.hit)},
          {"counters", counters_json(ray.counters)},
          {"steps", steps}};
}

constexpr std::string_view counter_columns = "{:>8}{:>8}{:>10}{:>10}{:>8}{}\n";

std::string rays_text(const RayLog& log) {
  size_t width = 16;
  const std::vector<RayPlace> tree = ray_tree(log);
  for (const RayPlace& place : tree)
    width = std::max<size_t>(width, 2 * place.level + 18);
  std::string text =
      fmt::format("{:>5}  {:<{}}", "ray", "class", width) +
      fmt::format(counter_columns, "nodes", "leaves", "triangles", "instances", "steps", "  hit");
  const auto row = [&](const std::string& index, const std::string& ray_class, const Counters& sum,
                       size_t steps, const std::string& hit) {
    text += fmt::format("{:>5}  {:<{}}", index, ray_class, width) +
            fmt::format(counter_columns, sum.nodes, sum.leaves, sum.triangles, sum.instances, steps,
                        hit);
  };
  size_t steps = 0;
  for (const RayPlace& place : tree) {
    const LoggedRay& ray = log.rays[place.ray];
    steps += ray.steps.size();
    row(std::to_string(place.ray),
        std::string(2 * place.level, ' ') + std::string(id_of(ray.cast.ray_class)), ray.counters,
        ray.steps.size(), "  " + hit_words(ray.cast));
  }
  row("all", "", counted(log), steps, "");
  return text;
}

std::string distance(bool known, float t) {
  return known ? fmt::format("{:.5g}", t) : "";
}

std::string steps_text(const LoggedRay& ray, size_t index) {
  const Ray& way = ray.cast.ray;
  std::string text = fmt::format(
      "\nSteps of ray {} ({}): origin {:.6g} {:.6g} {:.6g}, direction {:.6g} {:.6g} {:.6g}\n",
      index, id_of(ray.cast.ray_class), way.origin.x, way.origin.y, way.origin.z, way.direction.x,
      way.direction.y, way.direction.z);
  text += fmt::format("{:>6}  {:<5}{:>6}  {:<18}{:>11}{:>11}{:>11}{:>7}  {}\n", "step", "level",
                      "depth", "what", "entry t", "exit t", "best t", "stack", "result");
  for (size_t i = 0; i < ray.steps.size(); ++i) {
    const Step& step = ray.steps[i];
    const std::string reason = why(ray, i);
    text += fmt::format("{:>6}  {:<5}{:>6}  {:<18}{:>11}{:>11}{:>11}{:>7}  {}{}{}\n", i + 1,
                        step.instance == none ? "tlas" : "blas", step.depth, what(step),
                        distance(has_span(step), step.t_entry),
                        distance(has_span(step), step.t_exit), distance(true, step.t_best),
                        step.stack.size(), name(step.result), reason.empty() ? "" : ": ", reason);
  }
  return text;
}

}  // namespace

Json ray_log_json(const Snapshot& snapshot, const RayLog& log) {
  Json rays = Json::array();
  for (const LoggedRay& ray : log.rays)
    rays.push_back(ray_json(ray));
  return {{"schema", 1},
          {"scene", scene_json(*snapshot.scene)},
          {"settings", settings_json(snapshot.settings)},
          {"pixel", {log.pixel.x, log.pixel.y}},
          {"builder", log.bvh->options.builder},
          {"layout", snapshot.settings.build.layout},
          {"rays", rays},
          {"machine", machine_json()}};
}

std::string ray_log_text(const Snapshot& snapshot, const RayLog& log,
                         std::span<const size_t> with_steps) {
  std::string text = fmt::format("{}, {}, pixel {}, {} of {} x {}\n\n", snapshot.scene->name,
                                 log.bvh->options.builder, log.pixel.x, log.pixel.y,
                                 snapshot.settings.render.width, snapshot.settings.render.height);
  text += rays_text(log);
  for (const size_t ray : with_steps)
    text += steps_text(log.rays[ray], ray);
  return text;
}

}  // namespace tracer
