// Declaring the shared options, group by group; typed_settings.cpp reads them.
#include "app/commands/scene_options.h"

#include "app/commands/number_from.h"
#include "app/commands/one_of.h"
#include "tracer/analyze/box_set.h"
#include "tracer/bvh/ray_kernels.h"
#include "tracer/render/colormap.h"
#include "tracer/render/tone_map.h"
#include "tracer/render/views.h"

namespace app {
namespace {

void add_animation_options(CLI::App& command, SceneOptions& options) {
  command.add_option("--deform", options.deformer, "Deform the meshes, see 'list deformers'")
      ->type_name("D")
      ->check(one_of(tracer::deformers(), "deformer"))
      ->group("Animation");
  command.add_option("--amount", options.amount, "How far, see 'list deformers'")
      ->type_name("A")
      ->check(number_from(-tracer::max_amount, tracer::max_amount))
      ->group("Animation");
  command.add_option("--axis", options.axis, "Axis of the deformer: x, y or z")
      ->type_name("AXIS")
      ->check(one_of(tracer::axes(), "axis"))
      ->group("Animation");
  command
      .add_option("--speed", options.speed,
                  "Swings of the deformer a second; 0 holds it at its amount")
      ->type_name("S")
      ->check(number_from(0.0f, tracer::max_speed))
      ->group("Animation");
  command.add_option("--motion", options.motion, "How all instances move, see 'list motions'")
      ->type_name("M")
      ->check(one_of(tracer::motions(), "motion"))
      ->group("Animation");
  command.add_option("--motion-speed", options.motion_speed, "Turns or bounces a second")
      ->type_name("S")
      ->check(number_from(0.0f, tracer::max_motion_speed))
      ->group("Animation");
  command
      .add_option("--update", options.update,
                  "How the trees follow deformed meshes, see 'list updates'")
      ->type_name("U")
      ->check(one_of(tracer::updates(), "update strategy"))
      ->group("Animation");
  command.add_option("--every", options.every, "N of --update every: frames between builds")
      ->type_name("N")
      ->check(number_from(1, int(tracer::max_every)))
      ->group("Animation");
  command
      .add_option("--growth", options.growth, "F of --update growth: SAH against the last build")
      ->type_name("F")
      ->check(number_from(tracer::min_growth, tracer::max_growth))
      ->group("Animation");
  command.add_option("--fps", options.frames_per_second, "Frames of the animation a second")
      ->type_name("N")
      ->check(number_from(1.0f, tracer::max_frame_rate))
      ->group("Animation");
}

void add_build_choices(CLI::App& command, SceneOptions& options) {
  command.add_option("-b,--builder", options.builders, "Builder of the BVH, see 'list builders'")
      ->type_name("B")
      ->check(one_of(tracer::builders(), "builder"))
      ->group("BVH");
  command.add_option("--layout", options.layout, "How the tree is stored, see 'list layouts'")
      ->type_name("L")
      ->check(one_of(tracer::layouts(), "layout"))
      ->group("BVH");
  command
      .add_option("--widening", options.widening,
                  "Which nodes a wide layout keeps, see 'list widenings'")
      ->type_name("W")
      ->check(one_of(tracer::widenings(), "widening"))
      ->group("BVH");
  command
      .add_option("--occlusion-order", options.occlusion_order,
                  "Which child of a wide node shadow rays visit first, see 'list "
                  "occlusion-orders'")
      ->type_name("O")
      ->check(one_of(tracer::occlusion_orders(), "occlusion order"))
      ->group("BVH");
  command
      .add_option("--optimizer", options.optimizer,
                  "What is done to the tree afterwards, see 'list optimizers'")
      ->type_name("O")
      ->check(one_of(tracer::optimizers(), "optimizer"))
      ->group("BVH");
}

void add_build_numbers(CLI::App& command, SceneOptions& options) {
  command.add_option("--search-radius", options.search_radius, "Of PLOC, in clusters")
      ->type_name("N")
      ->check(number_from(1, int(tracer::max_search_radius)))
      ->group("BVH");
  command
      .add_flag("--no-collapse", options.no_collapse,
                "Keep subtrees that SAH would rather have as leaves")
      ->group("BVH");
  command
      .add_option("--reinsertion-share", options.reinsertion_share,
                  "Of reinsertion: the share of all nodes that a round looks at")
      ->type_name("X")
      ->check(number_from(tracer::min_reinsertion_share, 1.0f))
      ->group("BVH");
  command.add_option("--reinsertion-rounds", options.reinsertion_rounds, "Of reinsertion")
      ->type_name("N")
      ->check(number_from(1, int(tracer::max_reinsertion_rounds)))
      ->group("BVH");
  command
      .add_flag(
          "--presplit", options.presplit,
          "Split large diagonal triangles into several references before the build; before SBVH "
          "only those that fill little of their box")
      ->group("BVH");
  command
      .add_option("--split-budget", options.split_budget,
                  "References that splitting may add, a triangle")
      ->type_name("X")
      ->check(number_from(0.0f, tracer::max_split_budget))
      ->group("BVH");
  command
      .add_option(
          "--min-overlap", options.min_overlap,
          "Of SBVH: split space where children share more than this part of the root's area")
      ->type_name("X")
      ->check(number_from(0.0f, 1.0f))
      ->group("BVH");
  command
      .add_flag("--rebraid", options.rebraid,
                "Where parts of an instance have less surface than the whole, build the TLAS over "
                "nodes of its tree in place of it")
      ->group("BVH");
  command.add_option("--bins", options.bins, "Bins on each axis, for the SAH builders")
      ->type_name("N")
      ->check(number_from(2, int(tracer::max_bins)))
      ->group("BVH");
  command.add_option("--leaf-size", options.max_leaf_size, "Most triangles in a leaf")
      ->type_name("N")
      ->check(number_from(1, int(tracer::max_leaf_references)))
      ->group("BVH");
  command.add_option("--tree-depth", options.max_tree_depth, "Deepest leaf, edges from the root")
      ->type_name("N")
      ->check(number_from(1, int(tracer::max_tree_depth)))
      ->group("BVH");
  command.add_option("--ct", options.traversal_cost, "SAH's cost of an inner node")
      ->type_name("COST")
      ->check(number_from(tracer::min_cost, tracer::max_cost))
      ->group("BVH");
  command.add_option("--ci", options.intersection_cost, "SAH's cost of a triangle test")
      ->type_name("COST")
      ->check(number_from(tracer::min_cost, tracer::max_cost))
      ->group("BVH");
}

void add_ray_options(CLI::App& command, SceneOptions& options) {
  command.add_option("--spp", options.samples, "Samples a pixel")
      ->type_name("N")
      ->check(number_from(1, tracer::max_samples))
      ->group("Rays");
  command.add_option("--depth", options.ray_depth, "Bounces after the primary ray")
      ->type_name("N")
      ->check(number_from(0, tracer::max_ray_depth))
      ->group("Rays");
  command.add_option("--threads", options.threads, "Threads to work with; the result is the same")
      ->type_name("N")
      ->check(number_from(1, 1024))
      ->group("Rays");
  command
      .add_option("--isa", options.isa,
                  "Vector instructions of the kernels, see 'list isas'; the best ones of the "
                  "processor if not given; the result is the same")
      ->type_name("ISA")
      ->check(one_of(tracer::isas(), "instruction set, or this processor lacks it:"))
      ->group("Rays");
  command.add_flag("--no-shadows", options.no_shadows, "Cast no shadow rays")->group("Rays");
  command
      .add_option(
          "--kernel", options.kernels,
          "How rays of a class share the work, as in primary=packet; see 'list ray-classes' "
          "and 'list kernels'; 'automatic' if not given, or if the layout lacks it; the "
          "result is the same")
      ->type_name("CLASS=KERNEL")
      ->group("Rays");
  command
      .add_flag("--fast", options.fast,
                "Quicker tests that rays may slip through at edges, for what counts nothing: the "
                "passes of a picture after the first (--spp), and 'bench', which measures them "
                "beside the watertight ones; all else stays watertight")
      ->group("Rays");
}

void add_camera_options(CLI::App& command, SceneOptions& options) {
  command.add_option("--eye", options.eye, "Where the camera stands")
      ->type_name("X,Y,Z")
      ->group("Camera");
  command.add_option("--target", options.target, "What it looks at")
      ->type_name("X,Y,Z")
      ->group("Camera");
  command.add_option("--fov", options.fov, "Vertical opening in degrees")
      ->type_name("DEG")
      ->check(number_from(1.0f, 170.0f))
      ->group("Camera");
  command.add_flag("--orthographic", options.orthographic, "Parallel rays")->group("Camera");
}

void add_box_options(CLI::App& command, SceneOptions& options) {
  command
      .add_option("--boxes", options.boxes,
                  "Draw the boxes of the trees: levels LO:HI, leaves, or what is meant by "
                  "--box-node: node, children, ancestors, subtree")
      ->type_name("WHICH")
      ->group("Boxes");
  command.add_option("--box-tree", options.box_tree, "scene, blas or tlas; see 'list box-trees'")
      ->type_name("T")
      ->check(one_of(tracer::box_trees(), "choice of trees"))
      ->group("Boxes");
  command.add_option("--box-color", options.box_color, "Colour by this, see 'list node-measures'")
      ->type_name("M")
      ->check(one_of(tracer::node_measures(), "measure of nodes"))
      ->group("Boxes");
  command.add_option("--box-rays", options.box_rays, "Count visits of these rays only")
      ->type_name("CLASS")
      ->check(one_of(tracer::ray_classes(), "ray class", "all"))
      ->group("Boxes");
  command.add_option("--box-width", options.box_width, "Width of the lines in pixels")
      ->type_name("W")
      ->check(number_from(1.0f, tracer::max_box_line_width))
      ->group("Boxes");
  command.add_flag("--box-fill", options.box_fill, "Translucent faces")->group("Boxes");
  command.add_flag("--box-no-wire", options.box_no_wire, "No lines")->group("Boxes");
  command
      .add_flag("--box-show-hidden", options.box_show_hidden, "Do not fade what is behind surfaces")
      ->group("Boxes");
  command.add_flag("--box-log", options.box_log, "Logarithmic colours")->group("Boxes");
}

}  // namespace

void add_scene_options(CLI::App& command, SceneOptions& options, bool scene_required) {
  CLI::Option* scene = command.add_option(
      "scene", options.scene,
      "A built-in scene (see 'list scenes'), a .obj file or a .bvhscope session");
  scene->type_name("SCENE")->required(scene_required);

  command.add_option("--set", options.parameters, "A parameter of a built-in scene")
      ->type_name("NAME=NUMBER")
      ->group("Scene");
  command.add_option("--sky", options.sky, "Sky picture: .hdr, or one of 8 bits")
      ->type_name("FILE")
      ->group("Scene");
  command.add_option("--time", options.time, "Moment of the animation, seconds")
      ->type_name("T")
      ->check(number_from(0.0f, tracer::max_time))
      ->group("Animation");

  add_animation_options(command, options);
  add_build_choices(command, options);
  add_build_numbers(command, options);
  add_ray_options(command, options);
  add_camera_options(command, options);
}

void add_size_option(CLI::App& command, SceneOptions& options) {
  command.add_option("--size", options.size, "Size of the picture in pixels")
      ->type_name("WxH")
      ->group("Rays");
}

void add_view_options(CLI::App& command, SceneOptions& options) {
  command.add_option("--view", options.view, "What a pixel shows, see 'list views'")
      ->type_name("V")
      ->check(one_of(tracer::views(), "view"))
      ->group("View");
  command.add_option("--counter", options.counter, "Heat map of this, see 'list counters'")
      ->type_name("C")
      ->check(one_of(tracer::counters(), "counter"))
      ->group("View");
  command.add_option("--rays", options.rays, "Count these only, see 'list ray-classes'")
      ->type_name("CLASS")
      ->check(one_of(tracer::ray_classes(), "ray class", "all"))
      ->group("View");
  command.add_option("--colormap", options.colormap, "See 'list colormaps'")
      ->type_name("M")
      ->check(one_of(tracer::colormaps(), "colour map"))
      ->group("View");
  command.add_option("--range", options.range, "Values at the ends of the colour map")
      ->type_name("LO:HI")
      ->group("View");
  command.add_flag("--log", options.logarithmic, "Logarithmic colour map")->group("View");
  command.add_flag("--no-legend", options.no_legend, "No colour bar in the picture")->group("View");
  command.add_option("--exposure", options.exposure, "Of the shaded view, in stops")
      ->type_name("STOPS")
      ->check(number_from(-20.0f, 20.0f))
      ->group("View");
  command.add_option("--tone-map", options.tone_map, "See 'list tone-maps'")
      ->type_name("M")
      ->check(one_of(tracer::tone_maps(), "tone map"))
      ->group("View");
  add_box_options(command, options);
}

}  // namespace app
