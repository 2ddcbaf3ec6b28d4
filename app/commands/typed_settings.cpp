// Reading the shared options, group by group.
#include "app/commands/typed_settings.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/commands/command.h"
#include "app/commands/typed_numbers.h"
#include "tracer/analyze/box_set.h"
#include "tracer/bvh/ray_kernels.h"
#include "tracer/choice.h"
#include "tracer/error.h"
#include "tracer/scene/load_image.h"

namespace app {
namespace {

template <class Value>
void set_if_given(Value& target, const std::optional<Value>& given) {
  if (given) target = *given;
}

void change_source(const SceneOptions& options, tracer::SceneSource& source) {
  for (const std::string& parameter : options.parameters) {
    if (!tracer::is_builtin(source.name)) {
      throw UsageError("--set: " + source.name +
                       " is a file; only built-in scenes have parameters");
    }
    try {
      const tracer::SceneParameter added = tracer::parse_scene_parameter(parameter);
      std::erase_if(source.parameters,
                    [&](const tracer::SceneParameter& other) { return other.id == added.id; });
      source.parameters.push_back(added);
    } catch (const tracer::Error& error) {
      throw UsageError(fmt::format("--set: {}; write NAME=NUMBER", error.what()));
    }
  }
  set_if_given(source.sky_file, options.sky);
}

void change_build(const SceneOptions& options, tracer::BuildOptions& build) {
  if (!options.builders.empty()) build.builder = options.builders.front();
  set_if_given(build.optimizer, options.optimizer);
  set_if_given(build.search_radius, options.search_radius);
  if (options.no_collapse) build.collapse = false;
  set_if_given(build.reinsertion_share, options.reinsertion_share);
  set_if_given(build.reinsertion_rounds, options.reinsertion_rounds);
  if (options.presplit) build.presplit = true;
  set_if_given(build.split_budget, options.split_budget);
  set_if_given(build.min_overlap, options.min_overlap);
  if (options.rebraid) build.rebraid = true;
  set_if_given(build.bins, options.bins);
  set_if_given(build.max_leaf_size, options.max_leaf_size);
  set_if_given(build.max_depth, options.max_tree_depth);
  set_if_given(build.traversal_cost, options.traversal_cost);
  set_if_given(build.intersection_cost, options.intersection_cost);
  set_if_given(build.layout, options.layout);
  set_if_given(build.widening, options.widening);
  set_if_given(build.occlusion_order, options.occlusion_order);
  tracer::check(build);
}

void change_animation(const SceneOptions& options, tracer::Settings& settings) {
  set_if_given(settings.time, options.time);
  set_if_given(settings.deformer.kind, options.deformer);
  set_if_given(settings.deformer.amount, options.amount);
  set_if_given(settings.deformer.axis, options.axis);
  set_if_given(settings.deformer.speed, options.speed);
  set_if_given(settings.motion.kind, options.motion);
  set_if_given(settings.motion.speed, options.motion_speed);
  set_if_given(settings.update.strategy, options.update);
  set_if_given(settings.update.every, options.every);
  set_if_given(settings.update.growth, options.growth);
  set_if_given(settings.update.frames_per_second, options.frames_per_second);
}

// "primary=packet"
void choose_kernel(const std::string& typed, tracer::RenderOptions& render) {
  const std::span<const tracer::RayClassRow> classes = tracer::ray_classes();
  const size_t end = std::min(typed.find('='), typed.size());
  const std::string kernel = typed.substr(std::min(end + 1, typed.size()));
  const bool is_known = kernel == tracer::automatic_kernel ||
                        tracer::find_row(tracer::ray_kernels(), kernel) != nullptr;
  const tracer::RayClassRow* row = tracer::find_row(classes, typed.substr(0, end));
  if (row == nullptr || !is_known) {
    throw UsageError(
        fmt::format("--kernel: '{}' is not the kernel of a class; write CLASS=KERNEL, a class out "
                    "of {} and a kernel out of {}, {}",
                    typed, tracer::known_ids(classes), tracer::automatic_kernel,
                    tracer::known_ids(tracer::ray_kernels())));
  }
  render.kernels[size_t(row - classes.data())] = kernel;
}

void change_render(const SceneOptions& options, tracer::RenderOptions& render) {
  if (options.size) {
    const glm::ivec2 size = parse_size(*options.size, "--size");
    render.width = size.x;
    render.height = size.y;
  }
  set_if_given(render.samples, options.samples);
  set_if_given(render.ray_depth, options.ray_depth);
  if (options.no_shadows) render.shadows = false;
  for (const std::string& typed : options.kernels)
    choose_kernel(typed, render);
  if (options.fast) render.fast = true;
}

// "3:5" and "4" are levels; a word is the id of a set.
void change_boxes(const SceneOptions& options, tracer::BoxOptions& boxes) {
  if (options.boxes) {
    boxes.show = true;
    if (tracer::find_row(tracer::box_sets(), *options.boxes) != nullptr) {
      boxes.what = *options.boxes;
    } else {
      const std::optional<std::vector<float>> levels = parse_numbers(*options.boxes, ':');
      const bool fits = levels && levels->size() <= 2 && levels->front() <= levels->back() &&
                        levels->front() >= 0.0f && levels->back() <= tracer::max_box_level;
      if (!fits) {
        throw UsageError(fmt::format(
            "--boxes: '{}' is neither levels, as in 3:5, nor one of: {}; levels go from 0 to {}",
            *options.boxes, tracer::known_ids(tracer::box_sets()), tracer::max_box_level));
      }
      boxes.what = "levels";
      boxes.first_level = int(levels->front());
      boxes.last_level = int(levels->back());
    }
  }
  set_if_given(boxes.tree, options.box_tree);
  set_if_given(boxes.color, options.box_color);
  set_if_given(boxes.ray_class, options.box_rays);
  set_if_given(boxes.line_width, options.box_width);
  if (options.box_fill) boxes.translucent = true;
  if (options.box_no_wire) boxes.wire = false;
  if (options.box_show_hidden) boxes.fade_hidden = false;
  if (options.box_log) boxes.logarithmic = true;
  if (!boxes.wire && !boxes.translucent) {
    throw UsageError("--box-no-wire: nothing is left to draw; add --box-fill");
  }
}

void change_view(const SceneOptions& options, tracer::ViewOptions& view) {
  set_if_given(view.view, options.view);
  // A counter or ray class alone asks for the heat map.
  if ((options.counter || options.rays) && !options.view) view.view = "counter";
  set_if_given(view.counter, options.counter);
  set_if_given(view.ray_class, options.rays);
  set_if_given(view.colormap, options.colormap);
  set_if_given(view.tone_map, options.tone_map);
  set_if_given(view.exposure, options.exposure);
  if (options.range) view.range = parse_range(*options.range);
  if (options.logarithmic) view.logarithmic = true;
  if (options.no_legend) view.legend = false;
  change_boxes(options, view.boxes);
}

}  // namespace

tracer::SavedSession resolve(const SceneOptions& options) {
  tracer::SavedSession session;
  const bool saved = tracer::is_session_file(options.scene);
  if (saved) session = tracer::read_session(options.scene);
  try {
    if (!saved) session.settings.source = tracer::parse_scene_source(options.scene);
    change_source(options, session.settings.source);
    change_build(options, session.settings.build);
  } catch (const tracer::Error& wrong) {
    throw UsageError(wrong.what());
  }
  change_animation(options, session.settings);
  change_render(options, session.settings.render);
  change_view(options, session.view);
  // In a scene or session a missing sky is a warning; one that was typed must be there.
  if (options.sky) tracer::load_sky(*options.sky);
  // What was typed badly should fail now, not after the scene was loaded.
  placed(options, {});
  return session;
}

bool has_camera(const SceneOptions& options) {
  return options.eye || options.target || options.fov || options.orthographic;
}

tracer::Camera placed(const SceneOptions& options, tracer::Camera camera) {
  if (options.eye) camera.eye = parse_point(*options.eye, "--eye");
  if (options.target) camera.target = parse_point(*options.target, "--target");
  if (options.eye && options.target && camera.eye == camera.target) {
    throw UsageError("--eye and --target are the same point; move one of them");
  }
  set_if_given(camera.fov_degrees, options.fov);
  if (options.orthographic) camera.orthographic = true;
  return camera;
}

void place_camera(const SceneOptions& options, tracer::Settings& settings) {
  if (!has_camera(options)) return;
  if (!settings.look) settings.look = tracer::look_of(tracer::load_scene(settings.source, {}));
  settings.look->camera = placed(options, settings.look->camera);
}

}  // namespace app
