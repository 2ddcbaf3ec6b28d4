// The fields of a session file, described once for both ways: an Archive is a writer or a reader.
// It has number(name, value, lo, hi), flag(name, value), text(name, value), choice(name, id, rows,
// or), color(name, value, most), point(name, value), object(name, fill), list(name, items, fill)
// and optional(name, value, fill); fill gets the archive of the inner object, and the item or
// value.
#pragma once

#include "tracer/analyze/box_set.h"
#include "tracer/bvh/counters.h"
#include "tracer/bvh/ray_kernels.h"
#include "tracer/bvh/scene_bvh.h"
#include "tracer/render/colormap.h"
#include "tracer/render/tone_map.h"
#include "tracer/render/views.h"
#include "tracer/settings.h"

namespace tracer {

inline constexpr float largest_setting = 1e30f;  // of lengths and intensities

template <class Archive>
void session_fields(Archive& archive, BuildOptions& build) {
  archive.choice("builder", build.builder, builders());
  archive.choice("optimizer", build.optimizer, optimizers());
  archive.number("search_radius", build.search_radius, 1u, max_search_radius);
  archive.flag("collapse", build.collapse);
  archive.number("reinsertion_share", build.reinsertion_share, min_reinsertion_share, 1.0f);
  archive.number("reinsertion_rounds", build.reinsertion_rounds, 1u, max_reinsertion_rounds);
  archive.flag("presplit", build.presplit);
  archive.number("split_budget", build.split_budget, 0.0f, max_split_budget);
  archive.number("min_overlap", build.min_overlap, 0.0f, 1.0f);
  archive.flag("rebraid", build.rebraid);
  archive.number("bins", build.bins, 2u, max_bins);
  archive.number("max_leaf_size", build.max_leaf_size, 1u, max_leaf_references);
  archive.number("max_depth", build.max_depth, 1u, max_tree_depth);
  archive.number("traversal_cost", build.traversal_cost, min_cost, max_cost);
  archive.number("intersection_cost", build.intersection_cost, min_cost, max_cost);
  archive.choice("layout", build.layout, layouts());
  archive.choice("widening", build.widening, widenings());
  archive.choice("occlusion_order", build.occlusion_order, occlusion_orders());
}

template <class Archive>
void session_fields(Archive& archive, Deformer& deformer) {
  archive.choice("kind", deformer.kind, deformers());
  archive.number("amount", deformer.amount, -max_amount, max_amount);
  archive.choice("axis", deformer.axis, axes());
  archive.number("speed", deformer.speed, 0.0f, max_speed);
}

template <class Archive>
void session_fields(Archive& archive, InstanceMotion& motion) {
  archive.choice("kind", motion.kind, motions());
  archive.number("speed", motion.speed, 0.0f, max_motion_speed);
}

template <class Archive>
void session_fields(Archive& archive, UpdateOptions& update) {
  archive.choice("strategy", update.strategy, updates());
  archive.number("every", update.every, 1u, max_every);
  archive.number("growth", update.growth, min_growth, max_growth);
  archive.number("frames_per_second", update.frames_per_second, 1.0f, max_frame_rate);
}

template <class Archive>
void session_fields(Archive& archive, RenderOptions& render) {
  archive.number("width", render.width, 1, max_image_size);
  archive.number("height", render.height, 1, max_image_size);
  archive.number("ray_depth", render.ray_depth, 0, max_ray_depth);
  archive.number("samples", render.samples, 1, max_samples);
  archive.flag("shadows", render.shadows);
  archive.object("kernels", [&](Archive& inner) {
    for (size_t i = 0; i < render.kernels.size(); ++i) {
      inner.choice(std::string(ray_classes()[i].id).c_str(), render.kernels[i], ray_kernels(),
                   automatic_kernel);
    }
  });
  archive.flag("fast", render.fast);
}

template <class Archive>
void session_fields(Archive& archive, Material& material) {
  archive.text("name", material.name);
  archive.color("albedo", material.albedo, 1.0f);
  archive.flag("use_texture", material.use_texture);
  archive.number("reflectivity", material.reflectivity, 0.0f, 1.0f);
  archive.number("transmission", material.transmission, 0.0f, 1.0f);
  archive.number("refraction_index", material.refraction_index, 1.0f, 3.0f);
  archive.color("specular", material.specular, 1.0f);
  archive.color("emission", material.emission, largest_setting);
}

template <class Archive>
void session_fields(Archive& archive, Light& light) {
  archive.text("name", light.name);
  archive.point("position", light.position);
  archive.color("color", light.color, largest_setting);
  archive.number("intensity", light.intensity, 0.0f, largest_setting);
  archive.flag("on", light.on);
}

template <class Archive>
void session_fields(Archive& archive, SkySettings& sky) {
  archive.flag("on", sky.on);
  archive.number("rotation_degrees", sky.rotation_degrees, -360.0f, 360.0f);
  archive.number("intensity", sky.intensity, 0.0f, largest_setting);
  archive.color("flat_color", sky.flat_color, largest_setting);
}

template <class Archive>
void session_fields(Archive& archive, Camera& camera) {
  archive.point("eye", camera.eye);
  archive.point("target", camera.target);
  archive.point("up", camera.up);
  archive.number("fov_degrees", camera.fov_degrees, 1.0f, 170.0f);
  archive.flag("orthographic", camera.orthographic);
}

template <class Archive>
void session_fields(Archive& archive, Look& look) {
  const auto all = [](Archive& inner, auto& value) { session_fields(inner, value); };
  archive.list("materials", look.materials, all);
  archive.list("lights", look.lights, all);
  archive.object("sky", [&](Archive& inner) { session_fields(inner, look.sky); });
  archive.color("ambient", look.ambient, largest_setting);
  archive.object("camera", [&](Archive& inner) { session_fields(inner, look.camera); });
}

template <class Archive>
void session_fields(Archive& archive, SceneSource& source) {
  archive.text("name", source.name);
  archive.list("parameters", source.parameters, [](Archive& inner, SceneParameter& parameter) {
    inner.text("id", parameter.id);
    inner.number("value", parameter.value, -1e15, 1e15);
  });
  archive.text("sky_file", source.sky_file);
}

template <class Archive>
void session_fields(Archive& archive, Settings& settings) {
  const auto all = [](Archive& inner, auto& value) { session_fields(inner, value); };
  archive.object("scene", [&](Archive& inner) { session_fields(inner, settings.source); });
  archive.object("build", [&](Archive& inner) { session_fields(inner, settings.build); });
  archive.number("time", settings.time, 0.0f, max_time);
  archive.object("deformer", [&](Archive& inner) { session_fields(inner, settings.deformer); });
  archive.object("motion", [&](Archive& inner) { session_fields(inner, settings.motion); });
  archive.object("update", [&](Archive& inner) { session_fields(inner, settings.update); });
  archive.optional("look", settings.look, all);
  archive.object("render", [&](Archive& inner) { session_fields(inner, settings.render); });
}

template <class Archive>
void session_fields(Archive& archive, BoxOptions& boxes) {
  archive.flag("show", boxes.show);
  archive.choice("what", boxes.what, box_sets());
  archive.choice("tree", boxes.tree, box_trees());
  archive.number("first_level", boxes.first_level, 0, max_box_level);
  archive.number("last_level", boxes.last_level, 0, max_box_level);
  archive.choice("color", boxes.color, node_measures());
  archive.choice("ray_class", boxes.ray_class, ray_classes(), "all");
  archive.flag("logarithmic", boxes.logarithmic);
  archive.flag("wire", boxes.wire);
  archive.flag("translucent", boxes.translucent);
  archive.flag("fade_hidden", boxes.fade_hidden);
  archive.flag("sibling_overlap", boxes.sibling_overlap);
  archive.number("line_width", boxes.line_width, 1.0f, max_box_line_width);
}

template <class Archive>
void session_fields(Archive& archive, ViewOptions& view) {
  archive.choice("view", view.view, views());
  archive.choice("counter", view.counter, counters());
  archive.choice("ray_class", view.ray_class, ray_classes(), "all");
  archive.choice("colormap", view.colormap, colormaps());
  archive.optional("range", view.range, [](Archive& inner, ValueRange& range) {
    inner.number("lo", range.lo, -largest_setting, largest_setting);
    inner.number("hi", range.hi, -largest_setting, largest_setting);
  });
  archive.flag("logarithmic", view.logarithmic);
  archive.number("exposure", view.exposure, -20.0f, 20.0f);
  archive.choice("tone_map", view.tone_map, tone_maps());
  archive.flag("legend", view.legend);
  archive.object("boxes", [&](Archive& inner) { session_fields(inner, view.boxes); });
}

}  // namespace tracer
