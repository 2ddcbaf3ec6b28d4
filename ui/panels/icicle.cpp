// A whole tree at once: which tree, how wide its nodes are, and what their colour says.
#include "ui/icicle.h"

#include <algorithm>

#include <fmt/format.h>

#include "tracer/choice.h"
#include "ui/node_words.h"
#include "ui/panels.h"
#include "ui/places.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::Icicle;
using tracer::IcicleOptions;

constexpr Choice drawings[] = {
    {"icicle", "Icicle", "Levels below each other, the root on top"},
    {"treemap", "Treemap", "The nodes of one level as areas, each inside that of its parent"},
};

void show_all(IcicleState& state) {
  state.from = 0.0;
  state.to = 1.0;
  state.scroll = 0.0f;
  state.view = {};
}

// A node that was selected elsewhere brings its tree with it.
void follow_selection(Frame& frame) {
  IcicleState& state = frame.state.icicle;
  const auto& node = frame.state.selection.node;
  if (node == state.selected) return;
  state.selected = node;
  if (!node || node->mesh == state.mesh) return;
  state.mesh = node->mesh;
  show_all(state);
}

void draw_tree_choice(Frame& frame) {
  IcicleState& state = frame.state.icicle;
  row_label("Tree", "The TLAS, or the BLAS of a mesh");
  if (!tree_combo(frame, "Tree", state.mesh, "The TLAS, or the BLAS of a mesh")) return;
  show_all(state);
}

IcicleOptions options_of(const IcicleState& state) {
  IcicleOptions options;
  options.mesh = state.mesh;
  options.width = state.width;
  options.color = state.color;
  options.ray_class = ray_class_index(state.ray_class);
  return options;
}

void draw_ray_choice(IcicleState& state) {
  const std::vector<Choice> classes = ray_choices();
  combo("Rays", state.ray_class, std::span<const Choice>(classes), "Whose visits are counted");
}

// Which part of the tree is shown.
void draw_part(IcicleState& state, const Icicle* icicle) {
  const bool map = state.drawing == "treemap";
  if (map && icicle != nullptr) {
    slider("Level", state.level, 0, static_cast<int>(icicle->levels.size()) - 1,
           "The treemap shows the nodes of this level, and leaves above it; where it is zoomed in, "
           "deeper ones");
  }
  if (button("Show all", "The whole tree; a double click on a node fills the picture with it")) {
    show_all(state);
  }
  const double part = map ? state.view.length : state.to - state.from;
  if (part >= 1.0) return;
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  hint(fmt::format("{} times as {}", short_number(1.0 / part), map ? "large" : "wide"),
       "The whole width over the part of it that is shown");
}

// What is not known, and the selected node.
void draw_notes(const Frame& frame, const Icicle& icicle) {
  const IcicleState& state = frame.state.icicle;
  if (!icicle.has_values) {
    hint(tracer::is_from(tracer::MeasureSource::growth, state.color)
             ? "Growth is known of trees that were refitted: deform the mesh in the Timeline panel."
             : "This colour is not measured yet.");
  }
  if (!icicle.has_width && state.width == "visits") {
    hint("No visits are known: the widths are those of the triangles.");
  }
  const auto& selected = frame.state.selection.node;
  if (!selected || selected->mesh != icicle.options.mesh ||
      !tracer::icicle_place(icicle, selected->node)) {
    return;
  }
  ImGui::PushTextWrapPos(0.0f);
  text(node_text(icicle, selected->node),
       fmt::format("The selected node: its index in the tree, edges from the root, what is below "
                   "it, and its colour, {}: {}",
                   icicle.measure->label, icicle.measure->help));
  ImGui::PopTextWrapPos();
}

// The controls, in a column on the left.
void draw_controls(Frame& frame, const Icicle* icicle) {
  IcicleState& state = frame.state.icicle;
  combo("Drawing", state.drawing, std::span<const Choice>(drawings), "How the tree is drawn");
  draw_tree_choice(frame);
  combo("Width", state.width, tracer::icicle_widths(),
        "What the width of a node stands for, in a treemap its area");
  combo("Colour", state.color, tracer::node_measures(), "What a node's colour stands for");
  if (needs_visits(options_of(state))) draw_ray_choice(state);
  const tracer::NodeMeasureRow* measure = tracer::find_row(tracer::node_measures(), state.color);
  if (measure != nullptr && measure->scale == tracer::MeasureScale::sequential) {
    checkbox("Logarithmic", state.logarithmic,
             "Colours by the logarithm of the value: for values of very different size");
  }
  draw_part(state, icicle);
  if (icicle != nullptr) draw_notes(frame, *icicle);
}

// Whether the icicle is of the tree that the picture was made with.
bool is_current(const Icicle& icicle, const tracer::SceneBvh& bvh) {
  const tracer::SceneBvh& of = *icicle.inspection->bvh;
  const uint32_t mesh = icicle.options.mesh;
  if (mesh == tracer::none) return &of == &bvh;
  return mesh < of.blases.size() && mesh < bvh.blases.size() && of.blases[mesh] == bvh.blases[mesh];
}

void request(Frame& frame) {
  const IcicleState& state = frame.state.icicle;
  frame.requests.inspect = true;
  frame.requests.icicle = options_of(state);
  if (needs_visits(*frame.requests.icicle)) frame.requests.count_visits = true;
}

}  // namespace

void draw_icicle(Frame& frame) {
  if (!frame.snapshot.bvh || !frame.snapshot.scene) {
    hint("The trees appear here once a scene is there: File > Open scene...");
    return;
  }
  IcicleState& state = frame.state.icicle;
  if (state.mesh != tracer::none && state.mesh >= frame.snapshot.scene->meshes.size()) {
    state.mesh = 0;
  }
  follow_selection(frame);
  request(frame);
  std::shared_ptr<const Icicle> icicle = frame.work.icicle.result;
  if (icicle && (icicle->levels.empty() || !icicle->inspection)) icicle.reset();

  const ImVec2 area = ImGui::GetContentRegionAvail();
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float side = std::min(19.0f * em(), 0.35f * area.x);
  const float scale = 5.0f * em();
  if (ImGui::BeginChild("controls", {side, area.y})) draw_controls(frame, icicle.get());
  ImGui::EndChild();
  ImGui::SameLine();
  const ImVec2 size = {std::max(area.x - side - scale - 2.0f * gap, 1.0f), area.y};
  if (ImGui::BeginChild("canvas", size, false,
                        ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse)) {
    if (icicle) {
      const bool stale = !is_current(*icicle, *frame.snapshot.bvh);
      const bool map = state.drawing == "treemap";
      (map ? draw_treemap : draw_icicle_cells)(frame, icicle, size, stale);
    } else {
      hint(frame.work.icicle.error.empty() ? "The tree is being laid out, once the first picture "
                                             "is complete."
                                           : frame.work.icicle.error);
    }
  }
  ImGui::EndChild();
  ImGui::SameLine();
  if (!icicle) return;
  const std::string help =
      fmt::format("{}{}{}: {}", icicle->measure->label, icicle->measure->unit.empty() ? "" : ", ",
                  icicle->measure->unit, icicle->measure->help);
  draw_color_scale("colours", *icicle, state.logarithmic, {scale, area.y}, help.c_str());
}

}  // namespace ui
