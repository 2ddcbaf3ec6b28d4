// The builder of the BVH, its options, and the tree that came out.
#include <fmt/format.h>

#include "tracer/analyze/quality.h"
#include "tracer/choice.h"
#include "ui/measures.h"
#include "ui/panels.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

void draw_paper(std::string_view paper) {
  if (!paper.empty()) hint(paper);
}

void draw_options(tracer::Settings& settings) {
  tracer::BuildOptions& options = settings.build;
  combo("Builder", options.builder, tracer::builders(), "The algorithm that makes the tree");
  const tracer::BuilderRow* builder = tracer::find_row(tracer::builders(), options.builder);
  if (builder != nullptr) {
    draw_paper(builder->paper);
    if (builder->traits.bins) {
      slider("Bins", options.bins, 2, 256, "Candidates for a split along each axis, plus one");
    }
    if (builder->traits.search_radius) {
      slider("Search radius", options.search_radius, 1, 128,
             "How far along the curve a cluster looks for the nearest one");
    }
  }
  checkbox(
      "Pre-split", options.presplit,
      "Split large diagonal triangles into several references before the build; before SBVH, which "
      "cuts the others better, only those that fill little of their box");
  if (options.presplit || (builder != nullptr && builder->traits.splits_space)) {
    slider("Split budget", options.split_budget, 0.0f, tracer::max_split_budget,
           "References that splitting may add, for each triangle of the mesh", "%.2f");
  }
  if (builder != nullptr && builder->traits.splits_space) {
    slider(
        "Least overlap", options.min_overlap, 0.0f, 1.0f,
        "Space is split where the children of the best object split share more than this part of "
        "the root's area",
        "%.1e", true);
  }
  combo("Optimizer", options.optimizer, tracer::optimizers(),
        "What is done to the finished tree to lower its SAH");
  const tracer::OptimizerRow* optimizer = tracer::find_row(tracer::optimizers(), options.optimizer);
  if (optimizer != nullptr) {
    draw_paper(optimizer->paper);
    if (optimizer->reinserts) {
      slider(
          "Share", options.reinsertion_share, tracer::min_reinsertion_share, 1.0f,
          "Part of all nodes, the largest first, that a round looks at: more take longer and give "
          "a better tree",
          "%.3f");
      slider("Rounds", options.reinsertion_rounds, 1, tracer::max_reinsertion_rounds,
             "How often; ends when nothing is gained");
    }
  }
  if ((builder != nullptr && builder->traits.single_primitives) ||
      (optimizer != nullptr && optimizer->optimize != nullptr)) {
    checkbox("Collapse leaves", options.collapse,
             "Make a leaf of each subtree that costs more than one, after the optimizer");
  }
  checkbox(
      "Re-braid", options.rebraid,
      "Where parts of an instance have less surface than the whole, the tree of the instances is "
      "built over these parts: rays that reach one go on from there. Benthin et al. 2017");
  slider("Leaf size", options.max_leaf_size, 1, 64, "Most triangles in a leaf");
  slider("Depth limit", options.max_depth, 1, 96,
         "Most edges from the root to a leaf; what is deeper becomes a large leaf");
  slider("Ct", options.traversal_cost, 0.01f, 10.0f,
         "SAH: cost of an inner node (two box tests), in units of a triangle test", "%.2f");
  slider("Ci", options.intersection_cost, 0.01f, 10.0f, "SAH: cost of a triangle test", "%.2f");
  combo("Layout", options.layout, tracer::layouts(), "How the traversal stores the tree");
  const tracer::LayoutRow* layout = tracer::find_row(tracer::layouts(), options.layout);
  if (layout != nullptr && layout->width > 2) {
    combo("Widening", options.widening, tracer::widenings(),
          "Which nodes of the binary tree a wide layout keeps");
    combo("Shadow order", options.occlusion_order, tracer::occlusion_orders(),
          "Which child of a node shadow rays visit first: any hit ends them");
  }
  if (button("Default options", "The builder's options as they were at first")) {
    const std::string builder = options.builder;
    options = {};
    options.builder = builder;
  }
}

void draw_tree(Frame& frame, const tracer::TreeStatistics& tree, double ms, const char* time_help,
               const char* primitive, void (*measures)(Frame&)) {
  text_row("Build time", fmt::format("{:.2f} ms", ms), time_help);
  text_row("SAH",
           fmt::format("{:.2f}   (Ct {:.2f}, Ci {:.2f})", tree.sah, tree.traversal_cost,
                       tree.intersection_cost),
           sah_help(tree.traversal_cost, tree.intersection_cost).c_str());
  measures(frame);
  text_row("Nodes", grouped(tree.nodes), "Inner nodes and leaves of the binary tree");
  text_row("Leaves", grouped(tree.leaves), "Nodes without children");
  text_row("References", grouped(tree.references),
           "Entries of all leaves: more than there are triangles if a builder splits them");
  if (tree.primitives > 0) {
    text_row("Duplication",
             fmt::format("{:.2f} references each", static_cast<double>(tree.references) /
                                                       static_cast<double>(tree.primitives)),
             "References / primitives: 1 unless a builder splits what crosses a plane");
  }
  text_row(
      "Depth", fmt::format("{} (leaves: mean {:.1f})", tree.max_depth, tree.mean_leaf_depth),
      "Edges from the root of the binary tree to the deepest leaf, and to the leaves on average");
  text_row("Largest leaf", fmt::format("{}", tree.max_leaf_size), "References in the fullest leaf");
  text_row("Memory", byte_size(tree.bytes), "Nodes, references and the triangles in the leaves");
  if (tree.primitives > 0) {
    text_row(fmt::format("Per {}", primitive).c_str(),
             fmt::format("{:.1f} bytes",
                         static_cast<double>(tree.bytes) / static_cast<double>(tree.primitives)),
             "Memory divided by how many there are");
  }
}

// How the trees came to the shape of this moment; nothing while nothing is deformed.
void draw_update(const tracer::Snapshot& snapshot) {
  const tracer::UpdateFacts& update = snapshot.update;
  if (!update.deformed) return;
  heading("Update of this moment");
  const Scope scope("Update");
  const std::string built = update.built_time < 0.0f
                                ? std::string("the shape at rest")
                                : fmt::format("the shape at {:.3f} s", update.built_time);
  text_row("Built over", built, "The shape that the trees were built for");
  text_row("Deform", fmt::format("{:.2f} ms", update.deform_ms),
           "Wall time to move the vertices and turn the normals of all meshes");
  text_row("Refit", update.refitted ? fmt::format("{:.2f} ms", update.refit_ms) : "none",
           "Wall time to give the nodes of all trees new boxes; none: they were built for this "
           "moment");
  text_row("Growth",
           fmt::format("{:.3f} mean, {:.2f} most", snapshot.growth.mean, snapshot.growth.max),
           "Area of a node's box now / when its tree was built: the mean over all nodes weighted "
           "by the area at the build, and the largest. 1: nothing has grown. The view 'Refit "
           "growth' shows where");
  if (!update.warning.empty()) ImGui::TextWrapped("%s", update.warning.c_str());
}

}  // namespace

void draw_build(Frame& frame) {
  heading("Builder");
  draw_options(frame.edited.settings);
  const tracer::Snapshot& snapshot = frame.snapshot;
  if (snapshot.stage == tracer::Stage::build) {
    ImGui::ProgressBar(snapshot.progress, {-1, 0}, snapshot.doing.c_str());
    if (button("Cancel", "Keep the tree that is there")) frame.requests.cancel = true;
  }
  if (!snapshot.bvh || !snapshot.blas_statistics || !snapshot.tlas_statistics) {
    hint("The figures appear when the first tree has been built.");
    return;
  }
  heading("Trees of the meshes (BLAS)");
  {
    const Scope scope("BLAS");
    draw_tree(frame, *snapshot.blas_statistics, snapshot.bvh->blas_ms,
              "Wall time for the trees of all meshes together", "triangle", draw_blas_measures);
  }
  draw_update(snapshot);
  heading("Tree of the instances (TLAS)");
  const Scope scope("TLAS");
  draw_tree(frame, *snapshot.tlas_statistics, snapshot.bvh->tlas_ms,
            "Wall time; made anew whenever an instance moves", "instance", draw_tlas_measures);
}

}  // namespace ui
