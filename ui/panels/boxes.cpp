// Which boxes of the trees are drawn in the picture, and how.
#include <algorithm>

#include <fmt/format.h>

#include "tracer/analyze/box_set.h"
#include "tracer/choice.h"
#include "ui/level_bar.h"
#include "ui/node_words.h"
#include "ui/panels.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::BoxOptions;

// Of a tree in its layout; until its nodes are listed that of the binary tree.
uint32_t depth_of(const Frame& frame, uint32_t mesh) {
  if (const auto table = newest_table(frame, mesh)) return table->depth;
  const tracer::SceneBvh& bvh = *frame.snapshot.bvh;
  return mesh == tracer::none ? bvh.tlas.depth : bvh.blases[mesh]->tree.depth;
}

// How many levels the chosen trees have.
int level_count(const Frame& frame, const BoxOptions& boxes) {
  uint32_t blas = 0;
  for (uint32_t mesh = 0; mesh < frame.snapshot.bvh->blases.size(); ++mesh)
    blas = std::max(blas, depth_of(frame, mesh));
  const uint32_t tlas = depth_of(frame, tracer::none);
  if (boxes.tree == "tlas") return int(tlas) + 1;
  if (boxes.tree == "blas") return int(blas) + 1;
  return int(tlas + blas) + 2;
}

std::string place_name(const NodePlace& place) {
  return place.mesh == tracer::none ? fmt::format("node {} of the TLAS", place.node)
                                    : fmt::format("node {} of mesh {}", place.node, place.mesh);
}

void draw_levels(Frame& frame, BoxOptions& boxes) {
  const int levels = level_count(frame, boxes);
  level_bar("Levels", boxes.first_level, boxes.last_level, levels,
            "Edges from the root; of a subtree from the selected node. A click chooses a level, a "
            "drag or a click with Shift several");
  const int length = boxes.last_level - boxes.first_level;
  if (button("Up", "The same number of levels, nearer to the root") && boxes.first_level > 0) {
    --boxes.first_level;
    boxes.last_level = boxes.first_level + length;
  }
  ImGui::SameLine();
  if (button("Down", "The same number of levels, nearer to the leaves") &&
      boxes.last_level + 1 < levels) {
    ++boxes.first_level;
    boxes.last_level = boxes.first_level + length;
  }
  ImGui::SameLine();
  if (button("All", "Every level")) {
    boxes.first_level = 0;
    boxes.last_level = levels - 1;
  }
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  hint(length == 0
           ? fmt::format("level {} of {}", boxes.first_level, levels)
           : fmt::format("levels {} to {} of {}", boxes.first_level, boxes.last_level, levels),
       "The levels whose nodes are drawn, from 0, and how many the chosen trees have");
}

// What is drawn, in words.
void draw_count(const Frame& frame) {
  if (frame.picture == nullptr || !frame.picture->boxes) {
    hint("They come with the next picture.");
    return;
  }
  const tracer::DrawnBoxes& drawn = *frame.picture->boxes;
  std::string text = fmt::format("{} boxes", grouped(drawn.drawn));
  if (drawn.at_least || drawn.found > drawn.drawn) {
    text = fmt::format("the largest {} of {}{}: choose fewer levels", grouped(drawn.drawn),
                       drawn.at_least ? "more than " : "", grouped(drawn.found));
  }
  text_row("Drawn", text,
           "Of more than 20,000 boxes those with the largest area in the world are drawn");
}

void draw_selected(Frame& frame, const BoxOptions& boxes) {
  const auto& node = frame.state.selection.node;
  if (node) {
    text_row("Selected", place_name(*node),
             "It is drawn through the selected instance, otherwise through every instance of its "
             "mesh");
  } else {
    hint(boxes.show ? "Select a node: a click in the Icicle panel or on a finding."
                    : "These boxes are of the selected node.");
  }
}

void draw_filter(Frame& frame) {
  BoxFilter& filter = frame.state.box_filter;
  if (!filter.isolated && filter.hidden.empty()) return;
  std::string text;
  if (filter.isolated) text = "only " + place_name(*filter.isolated);
  if (!filter.hidden.empty()) {
    text += fmt::format("{}{} hidden", text.empty() ? "" : ", ", filter.hidden.size());
  }
  text_row("Left out", text, "Nodes that are hidden, or outside of the isolated one");
  if (button("Show all", "Nothing is hidden or isolated any more")) filter = {};
}

void draw_values(Frame& frame, BoxOptions& boxes) {
  heading("Colours");
  combo("Colour", boxes.color, tracer::node_measures(), "What the colour of a box stands for");
  const tracer::NodeMeasureRow* measure = tracer::find_row(tracer::node_measures(), boxes.color);
  if (measure == nullptr) return;
  if (tracer::needs_visits(boxes)) {
    const std::vector<Choice> classes = ray_choices();
    combo("Rays", boxes.ray_class, std::span<const Choice>(classes), "Whose visits are counted");
  }
  if (measure->scale == tracer::MeasureScale::sequential) {
    checkbox("Logarithmic", boxes.logarithmic,
             "Colours by the logarithm of the value: for values of very different size");
  }
  const bool of_node = boxes.show && frame.picture != nullptr && frame.picture->boxes &&
                       frame.picture->boxes->drawn > 0;
  if (!of_node) return;
  const tracer::DrawnBoxes& drawn = *frame.picture->boxes;
  if (!drawn.has_range) {
    hint(tracer::is_from(tracer::MeasureSource::growth, boxes.color)
             ? "No tree has been refitted: deform the meshes in the Timeline panel."
             : "Not measured yet: boxes without a value are grey.");
  } else if (measure->scale != tracer::MeasureScale::category) {
    text_row("Range",
             fmt::format("{} to {} {}", short_number(drawn.range.lo), short_number(drawn.range.hi),
                         measure->unit),
             "Values at the ends of the colours; the legend in the picture shows them");
  }
}

void draw_style(BoxOptions& boxes) {
  heading("Drawing");
  checkbox("Lines", boxes.wire, "The edges of the boxes");
  checkbox("Translucent", boxes.translucent, "The faces that look at the camera");
  if (!boxes.wire && !boxes.translucent) hint("Neither lines nor faces are drawn.");
  checkbox("Fade hidden", boxes.fade_hidden, "What is behind the picture's surfaces is fainter");
  slider("Line width", boxes.line_width, 1.0f, tracer::max_box_line_width, "In pixels", "%.1f");
  checkbox("Sibling overlap", boxes.sibling_overlap,
           "What each two children of the selected node have in common, solid magenta: rays there "
           "have to enter both");
}

}  // namespace

void draw_boxes(Frame& frame) {
  BoxOptions& boxes = frame.edited.view.boxes;
  if (!frame.snapshot.bvh) {
    hint("Boxes can be shown once a scene is there: File > Open scene...");
    return;
  }
  checkbox("Show boxes", boxes.show, "Draw boxes of the trees into the picture");
  combo("What", boxes.what, tracer::box_sets(), "Which nodes");
  const tracer::BoxSetRow* set = tracer::find_row(tracer::box_sets(), boxes.what);
  combo("Trees", boxes.tree, tracer::box_trees(), "Whose nodes");
  if (set != nullptr && set->of_selected) draw_selected(frame, boxes);
  if (set != nullptr && set->has_levels) draw_levels(frame, boxes);
  if (boxes.show) draw_count(frame);
  draw_filter(frame);
  draw_values(frame, boxes);
  draw_style(boxes);
}

}  // namespace ui
