// Settings within their limits, and what can be edited of a scene.
#include "tracer/settings.h"

#include <algorithm>
#include <cmath>

#include "tracer/choice.h"

namespace tracer {
namespace {

RenderOptions clamped(RenderOptions options) {
  options.width = std::clamp(options.width, 1, max_image_size);
  options.height = std::clamp(options.height, 1, max_image_size);
  options.ray_depth = std::clamp(options.ray_depth, 0, max_ray_depth);
  options.samples = std::clamp(options.samples, 1, max_samples);
  return options;
}

// A number within limits; what is none becomes the lower one.
float limited(float value, float lo, float hi) {
  return value >= lo ? std::min(value, hi) : lo;
}

Deformer clamped(Deformer deformer) {
  if (std::isnan(deformer.amount)) deformer.amount = 0.0f;
  deformer.amount = std::clamp(deformer.amount, -max_amount, max_amount);
  deformer.speed = limited(deformer.speed, 0.0f, max_speed);
  return deformer;
}

UpdateOptions clamped(UpdateOptions update) {
  if (!find_row(updates(), update.strategy)) update.strategy = UpdateOptions{}.strategy;
  update.every = std::clamp(update.every, 1u, max_every);
  update.growth = limited(update.growth, min_growth, max_growth);
  update.frames_per_second = limited(update.frames_per_second, 1.0f, max_frame_rate);
  return update;
}

}  // namespace

Settings clamped(Settings settings) {
  settings.render = clamped(settings.render);
  settings.time = limited(settings.time, 0.0f, max_time);
  settings.deformer = clamped(settings.deformer);
  settings.motion.speed = limited(settings.motion.speed, 0.0f, max_motion_speed);
  settings.update = clamped(settings.update);
  return settings;
}

Look look_of(const Scene& scene) {
  return {scene.materials, scene.lights, scene.sky, scene.ambient, scene.camera};
}

Look fitted(const std::optional<Look>& look, const Scene& scene) {
  Look result = look ? *look : look_of(scene);
  const size_t known = std::min(result.materials.size(), scene.materials.size());
  result.materials.resize(known);
  for (size_t i = 0; i < known; ++i)
    result.materials[i].texture = scene.materials[i].texture;
  result.materials.insert(result.materials.end(),
                          scene.materials.begin() + static_cast<std::ptrdiff_t>(known),
                          scene.materials.end());
  return result;
}

}  // namespace tracer
