// The options that render, report, screenshot and the workspace share: which scene, how it is built
// and traced, from where it is seen, and what is shown.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace app {

// As typed; what is not given leaves the scene's, the session's or the program's own value.
struct SceneOptions {
  std::string scene = "teapots";
  std::vector<std::string> parameters;  // "name=value"
  std::optional<std::string> sky;
  std::optional<float> time;
  std::optional<std::string> deformer, axis, motion, update;
  std::optional<float> amount, speed, motion_speed, growth, frames_per_second;
  std::optional<uint32_t> every;

  std::vector<std::string> builders;
  std::optional<std::string> layout;
  std::optional<std::string> widening;
  std::optional<std::string> occlusion_order;
  std::optional<std::string> optimizer;
  std::optional<uint32_t> bins, max_leaf_size, max_tree_depth, search_radius;
  std::optional<uint32_t> reinsertion_rounds;
  bool no_collapse = false;
  bool presplit = false, rebraid = false;
  std::optional<float> split_budget, min_overlap, reinsertion_share;
  std::optional<float> traversal_cost, intersection_cost;

  std::optional<std::string> size;
  std::optional<int> samples, ray_depth, threads;
  std::optional<std::string> isa;
  bool no_shadows = false;
  std::vector<std::string> kernels;  // "class=kernel"
  bool fast = false;

  std::optional<std::string> eye, target;
  std::optional<float> fov;
  bool orthographic = false;

  std::optional<std::string> view, counter, rays, colormap, range, tone_map;
  std::optional<float> exposure;
  bool logarithmic = false;
  bool no_legend = false;

  std::optional<std::string> boxes, box_tree, box_color, box_rays;
  std::optional<float> box_width;
  bool box_fill = false, box_no_wire = false, box_show_hidden = false, box_log = false;
};

// Adds the options in groups. Ids are checked against their tables while the line is parsed.
void add_scene_options(CLI::App& command, SceneOptions& options, bool scene_required);
void add_size_option(CLI::App& command, SceneOptions& options);  // where no window decides
void add_view_options(CLI::App& command, SceneOptions& options);

}  // namespace app
