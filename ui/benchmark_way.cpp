// What a row of the Benchmark panel chooses for the scene.
#include "ui/benchmark_way.h"

#include <fmt/format.h>

#include "tracer/choice.h"
#include "tracer/render/whitted.h"

namespace ui {
namespace {

size_t class_of(const BenchmarkWay& way) {
  return size_t(way.ray_class - tracer::ray_classes().data());
}

}  // namespace

BenchmarkWay way_of(const tracer::BuildTiming& row) {
  return {row.builder, row.layout};
}
BenchmarkWay way_of(const tracer::RayTiming& row) {
  return {row.builder, row.layout, row.kernel, find_row(tracer::ray_classes(), row.ray_class),
          true,        !row.robust};
}

void choose(const BenchmarkWay& way, tracer::Settings& settings) {
  settings.build.builder = way.builder;
  settings.build.layout = way.layout;
  if (way.ray_class == nullptr) return;
  settings.render.kernels[class_of(way)] = way.kernel;
  settings.render.fast = way.fast;
}

Presence presence(const BenchmarkWay& way, const tracer::Settings& settings) {
  const tracer::BuildOptions& build = settings.build;
  if (build.builder != way.builder || build.layout != way.layout) return Presence::other;
  if (way.ray_class == nullptr) return Presence::chosen;
  if (settings.render.fast != way.fast) return Presence::other;
  const auto ray_class = static_cast<tracer::RayClass>(class_of(way));
  const std::string_view kernel = kernel_of(settings.render, build.layout, ray_class);
  if (kernel == tracer::automatic_kernel) return Presence::automatic;
  return kernel == way.kernel ? Presence::chosen : Presence::other;
}

std::string click_help(const BenchmarkWay& way, Presence present) {
  if (way.ray_class == nullptr) {
    return std::string(present == Presence::other
                           ? "A click builds the scene with this builder and layout"
                           : "The scene is built this way now") +
           (way.traces ? ". The picture has no such rays: its kernels stay as they are" : "");
  }
  const std::string_view rays = way.ray_class->id;
  switch (present) {
    case Presence::automatic:
      return fmt::format(
          "The scene is built this way now, and the renderer picks the kernel of its {} rays. A "
          "click chooses this one",
          rays);
    case Presence::chosen:
      return fmt::format(
          "The scene is built and its {} rays are traced this way now. 'Automatic' in the Render "
          "panel lets the renderer pick the kernel",
          rays);
    case Presence::other:
      break;
  }
  return fmt::format(
      "A click builds the scene with this builder and layout, and traces its {} rays with this "
      "kernel and all rays with {} tests",
      rays, way.fast ? "fast" : "watertight");
}

}  // namespace ui
