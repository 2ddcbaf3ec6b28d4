// The table of builders and the way into them.
#include "tracer/bvh/build.h"

#include <fmt/format.h>

#include "tracer/bvh/build_steps.h"
#include "tracer/bvh/builders.h"
#include "tracer/bvh/optimizers.h"
#include "tracer/bvh/presplit.h"
#include "tracer/bvh/tree_edit.h"
#include "tracer/choice.h"
#include "tracer/error.h"

namespace tracer {

namespace {

constexpr BuilderRow rows[] = {
    {"binned",
     "Binned SAH",
     "Sorts the centroids into bins on each axis and takes the plane between two bins with the "
     "lowest SAH cost. The usual compromise of build time and tree quality.",
     "I. Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, 2007",
     build_binned,
     {.bins = true}},
    {"midpoint", "Midpoint split",
     "Cuts the longest axis in the middle. Fast and simple; wastes levels where triangles are "
     "unevenly spread.",
     "J. Bikker, How to build a BVH, part 1, 2022", build_midpoint},
    {"median", "Object median",
     "Half of the primitives to each side, along the longest axis. A balanced tree whose boxes "
     "overlap more than they need to.",
     "T. Kay, J. Kajiya, Ray Tracing Complex Scenes, 1986", build_median},
    {"sweep", "Sweep SAH",
     "Tries the plane between any two centroids on each axis: the greedy SAH at its best, at "
     "several times the build time of bins.",
     "J. MacDonald, K. Booth, Heuristics for Ray Tracing using Space Subdivision, 1990",
     build_sweep},
    {"sbvh",
     "SBVH",
     "Binned SAH that cuts space where boxes overlap: triangles across the plane are clipped into "
     "both sides. The best tree for long, diagonal triangles, with more references.",
     "M. Stich, H. Friedrich, A. Dietrich, Spatial Splits in Bounding Volume Hierarchies, 2009",
     build_sbvh,
     {.bins = true, .splits_space = true}},
    {"lbvh",
     "LBVH",
     "Sorts the primitives along a Morton curve and splits where the codes change: the fastest "
     "build, the slowest tree.",
     "T. Karras, Maximizing Parallelism in the Construction of BVHs, Octrees, and k-d Trees, 2012",
     build_lbvh,
     {.single_primitives = true, .collapses = true}},
    {"agglomerative",
     "Agglomerative",
     "Merges the two nearest clusters again and again: exact for up to a thousand primitives, such "
     "as the instances of a scene; more are first parted along a Morton curve.",
     "Y. Gu, Y. He, K. Fatahalian, G. Blelloch, Efficient BVH Construction via Approximate "
     "Agglomerative Clustering, 2013",
     build_agglomerative,
     {.single_primitives = true, .bottom_up = true}},
    {"ploc",
     "PLOC",
     "Merges neighbours along a Morton curve bottom-up, nearest first. Close to SAH builders in "
     "quality; a larger search radius gives better trees.",
     "D. Meister, J. Bittner, Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy "
     "Construction, 2018",
     build_ploc,
     {.search_radius = true, .single_primitives = true, .bottom_up = true}},
};

constexpr OptimizerRow optimizer_rows[] = {
    {"none", "None", "The tree as the builder made it", "", nullptr},
    {"rotations", "Tree rotations",
     "Swaps a child with a grandchild where that makes a box smaller: quick, finds what is near.",
     "A. Kensler, Tree Rotations for Improving Bounding Volume Hierarchies, 2008", rotate},
    {"reinsertion", "Parallel reinsertion",
     "Takes the nodes with the largest boxes out and puts each back where the tree grows least.",
     "D. Meister, J. Bittner, Parallel Reinsertion for Bounding Volume Hierarchy Optimization, "
     "2018",
     reinsert, true},
};

template <class Value>
void check_range(std::string_view option, Value value, Value lo, Value hi) {
  // Written so that NaN is outside.
  if (!(value >= lo && value <= hi)) {
    throw Error(fmt::format("{} {} is outside {}..{}", option, value, lo, hi));
  }
}

}  // namespace

std::span<const BuilderRow> builders() {
  return rows;
}

std::span<const OptimizerRow> optimizers() {
  return optimizer_rows;
}

void check(const BuildOptions& options) {
  if (!find_row(builders(), options.builder)) {
    throw Error(fmt::format("unknown builder '{}'; known builders: {}", options.builder,
                            known_ids(builders())));
  }
  if (!find_row(optimizers(), options.optimizer)) {
    throw Error(fmt::format("unknown optimizer '{}'; known optimizers: {}", options.optimizer,
                            known_ids(optimizers())));
  }
  if (!find_row(layouts(), options.layout)) {
    throw Error(fmt::format("unknown layout '{}'; known layouts: {}", options.layout,
                            known_ids(layouts())));
  }
  if (!find_row(widenings(), options.widening)) {
    throw Error(fmt::format("unknown widening '{}'; known widenings: {}", options.widening,
                            known_ids(widenings())));
  }
  if (!find_row(occlusion_orders(), options.occlusion_order)) {
    throw Error(fmt::format("unknown occlusion order '{}'; known occlusion orders: {}",
                            options.occlusion_order, known_ids(occlusion_orders())));
  }
  check_range("search radius", options.search_radius, 1u, max_search_radius);
  check_range("bins", options.bins, 2u, max_bins);
  check_range("leaf size", options.max_leaf_size, 1u, max_leaf_references);
  check_range("depth limit", options.max_depth, 1u, max_tree_depth);
  check_range("reinsertion share", options.reinsertion_share, min_reinsertion_share, 1.0f);
  check_range("reinsertion rounds", options.reinsertion_rounds, 1u, max_reinsertion_rounds);
  check_range("split budget", options.split_budget, 0.0f, max_split_budget);
  check_range("least overlap", options.min_overlap, 0.0f, 1.0f);
  check_range("traversal cost", options.traversal_cost, min_cost, max_cost);
  check_range("intersection cost", options.intersection_cost, min_cost, max_cost);
}

namespace {

// A builder that splits space wants a part of the budget for itself, and cuts walls and floors
// better when it sees what is beside them: only thin diagonal triangles are split before.
constexpr float presplit_share = 0.8f;
constexpr float presplit_most_filled = 0.1f;

Bvh build_over(const BuildInput& input, const BuildOptions& options, BuildLog* log,
               const std::stop_token& stop) {
  const BuilderRow& builder = *find_row(builders(), options.builder);
  Bvh bvh = builder.build(input, options, log, stop);
  if (stop.stop_requested()) return {};
  BuildSteps* steps = log != nullptr ? log->steps : nullptr;
  if (steps != nullptr) {
    steps->nodes.assign(bvh.nodes.begin(), bvh.nodes.end());
    if (!builder.traits.bottom_up) record_splits(*steps, bvh);
  }
  const OptimizerRow& optimizer = *find_row(optimizers(), options.optimizer);
  if (optimizer.optimize != nullptr) optimizer.optimize(bvh, options, log, stop);
  if (stop.stop_requested()) return {};
  const bool improved = optimizer.optimize != nullptr;
  const bool has_single = builder.traits.single_primitives && !builder.traits.collapses;
  if (options.collapse && (improved || has_single)) {
    collapse_leaves(bvh, options);
  }
  const bool too_deep = bvh.depth > options.max_depth;
  limit_depth(bvh, input.boxes, options);
  const size_t references = bvh.references.size();
  if (input.mesh != nullptr) name_primitives(bvh, input);
  if (steps != nullptr) {
    steps->finished_later =
        too_deep || bvh.nodes.size() != steps->nodes.size() || bvh.references.size() != references;
  }
  return bvh;
}

}  // namespace

Bvh build(const BuildInput& input, const BuildOptions& options, BuildLog* log,
          std::stop_token stop) {
  check(options);
  if (input.boxes.empty()) return {};
  if (!options.presplit || input.mesh == nullptr) return build_over(input, options, log, stop);
  const bool splits_later = find_row(builders(), options.builder)->traits.splits_space;
  const float budget = options.split_budget * (splits_later ? presplit_share : 1.0f);
  const float most_filled = splits_later ? presplit_most_filled : 1.0f;
  const SplitBoxes parts = presplit(*input.mesh, input.boxes, budget, most_filled, stop);
  if (stop.stop_requested()) return {};
  return build_over({parts.boxes, input.mesh, parts.primitives}, options, log, stop);
}

}  // namespace tracer
