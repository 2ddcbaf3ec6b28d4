// The selected node: what it is, what rays make of it, and how it could be split.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tracer/choice.h"
#include "ui/actions.h"
#include "ui/node_splits.h"
#include "ui/node_words.h"
#include "ui/panels.h"
#include "ui/registry.h"

namespace ui {
namespace {

using tracer::NodeMeasureRow;
using tracer::TableNode;
using tracer::TreeFacts;
using tracer::TreeTable;

std::string numbers(const tracer::vec3& v) {
  return fmt::format("{}  {}  {}", short_number(v.x), short_number(v.y), short_number(v.z));
}

// As of a text row.
void link_label(const char* label, const char* help) {
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(0, 0));
  row_label(label, help);
  ImGui::PopStyleVar();
}

// One node as a link; the box of what is under the mouse lights up.
void node_link(Frame& frame, const char* label, const TreeTable& table, const NodePlace& place,
               const char* help) {
  if (link(label, node_name(table, place.node), help)) select_node(frame, place);
  if (ImGui::IsItemHovered()) hover_node(frame, place);
}

void draw_links(Frame& frame, const TreeTable& table, const NodePlace& place) {
  const TableNode& row = table.nodes[place.node];
  const Scope scope("links");
  link_label("Parent", "The node whose child it is");
  if (row.parent == tracer::none) {
    hint("none: the root");
  } else {
    node_link(frame, "parent", table, {place.mesh, row.parent}, "Selects the parent");
    const char* label = "Siblings";
    for (const uint32_t sibling : children_of(table, row.parent)) {
      if (sibling == place.node) continue;
      link_label(label, "The parent's other children");
      label = "";
      node_link(frame, fmt::format("sibling {}", sibling).c_str(), table, {place.mesh, sibling},
                "Selects the sibling");
    }
  }
  const std::span<const uint32_t> children = children_of(table, place.node);
  for (size_t i = 0; i < children.size(); ++i) {
    link_label(i == 0 ? "Children" : "", "The nodes below it");
    node_link(frame, fmt::format("child {}", i + 1).c_str(), table, {place.mesh, children[i]},
              "Selects the child");
    ImGui::SameLine();
    const uint32_t references = table.nodes[children[i]].references;
    hint(fmt::format("{} {}", grouped(references), references_name(table)),
         "References in the leaves below the child");
  }
}

void draw_box(const TreeTable& table, uint32_t node) {
  const TableNode& row = table.nodes[node];
  const char* space = table.tlas ? "In the world" : "In the mesh's own space";
  text_row("Lower", numbers(row.box.lo), fmt::format("{}: the box's lower corner", space).c_str());
  text_row("Upper", numbers(row.box.hi), fmt::format("{}: the box's upper corner", space).c_str());
  text_row("Extent", numbers(tracer::extent(row.box)),
           fmt::format("{}: upper minus lower corner", space).c_str());
  text_row("Surface", short_number(2.0 * double(half_area(row.box))),
           fmt::format("{}: the area of the box's six sides", space).c_str());
}

void draw_measures(const TreeFacts& facts, uint32_t node) {
  heading("Measures");
  for (const NodeMeasureRow& measure : tracer::node_measures()) {
    const double value = measure.value(facts, node);
    if (measure.id == "kind") continue;
    text_row(measure_label(measure, *facts.table).c_str(),
             std::isnan(value) ? std::string("-") : measure_text(measure, value),
             std::string(measure.help).c_str());
  }
}

uint32_t visits_of(const tracer::FrameVisits& visits, size_t ray_class, const NodePlace& place) {
  const tracer::Visits& of = visits.classes[ray_class];
  const std::vector<uint32_t>& tree = place.mesh == tracer::none ? of.tlas : of.blases[place.mesh];
  return tree[place.node];
}

struct Column {
  const char *label, *help;
};
constexpr Column ray_columns[] = {
    {"Rays", "The class of the rays"},
    {"Visits",
     "How often rays of the frame entered the node: one sample a pixel, through its "
     "centre"},
    {"Predicted",
     "Visits of the tree's root times A(node) / A(root): what SAH assumes, random "
     "lines that do not end"},
    {"Ratio", "Visits over those predicted"},
};

void draw_ray_row(std::string_view label, uint64_t visits, double predicted) {
  ImGui::TableNextRow();
  cell(label);
  cell(grouped(visits));
  cell(short_number(predicted));
  cell(predicted > 0.0 ? short_number(double(visits) / predicted) : "");
}

void draw_rays(Frame& frame, const TreeFacts& facts, const NodePlace& place) {
  heading("Rays");
  const auto& counted = frame.work.visits.result;
  if (!counted || !counted->visits || facts.visits.empty()) {
    hint("Visits are being counted ...");
    return;
  }
  const ImGuiTableFlags flags =
      ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_BordersInnerV;
  if (!ImGui::BeginTable("rays", 4, flags)) return;
  for (const Column& column : ray_columns)
    ImGui::TableSetupColumn(column.label);
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (const Column& column : ray_columns)
    header(column.label, column.help);
  const double share = area_share(*facts.table, place.node);
  uint64_t all = 0, all_roots = 0;
  for (size_t i = 0; i < tracer::ray_class_count; ++i) {
    const uint64_t visits = visits_of(*counted->visits, i, place);
    const uint64_t root = visits_of(*counted->visits, i, {place.mesh, 0});
    all += visits;
    all_roots += root;
    if (root > 0) draw_ray_row(tracer::ray_classes()[i].label, visits, share * double(root));
  }
  draw_ray_row("All", all, share * double(all_roots));
  ImGui::EndTable();
}

// Which rays are asked about: with an instance selected only those in it.
tracer::Watched watched(const Frame& frame, const NodePlace& place) {
  const uint32_t instance = frame.state.selection.instance;
  const bool shows = place.mesh != tracer::none &&
                     instance < frame.snapshot.bvh->instances.size() &&
                     frame.snapshot.bvh->instances[instance].mesh == place.mesh;
  return {place.mesh, place.node, shows ? instance : tracer::none};
}

void draw_pixels(Frame& frame, const NodePlace& place) {
  NodeState& state = frame.state.node;
  const std::vector<Choice> classes = ray_choices();
  checkbox("Show its pixels", state.show_pixels,
           "Tints the pixels of the picture with a ray that entered the node. With an instance "
           "selected: as that instance");
  if (!state.show_pixels) return;
  combo("Of", state.ray_class, std::span<const Choice>(classes), "Which rays count");
  frame.requests.node_pixels = watched(frame, place);
  const auto& result = frame.work.node_pixels.result;
  const bool known = result && result->pixels.bvh == frame.snapshot.bvh &&
                     result->film == frame.snapshot.render_generation &&
                     result->pixels.node == *frame.requests.node_pixels;
  if (!known) {
    text_row("Pixels", "looking for them ...", "How many pixels have such a ray");
    return;
  }
  const int ray_class = ray_class_index(state.ray_class);
  if (state.blocks_of != result || state.blocks_class != state.ray_class) {
    state.blocks_of = result;
    state.blocks_class = state.ray_class;
    state.blocks = blocks_of(result->pixels, ray_class);
    state.pixels = count(result->pixels, ray_class);
  }
  const double all = double(result->pixels.width) * double(result->pixels.height);
  text_row("Pixels",
           fmt::format("{}, {:.2f} %", grouped(state.pixels),
                       all > 0.0 ? 100.0 * double(state.pixels) / all : 0.0),
           "How many pixels have such a ray, and their share of the picture");
}

void draw_references(Frame& frame, const TreeTable& table, const NodePlace& place) {
  const TableNode& row = table.nodes[place.node];
  if (!is_leaf(row)) return;
  heading(table.tlas ? "Instances" : "Triangles");
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(row.references));
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const size_t reference = row.first + static_cast<size_t>(i);
      const uint32_t id = table.references[reference];
      ImGui::PushID(i);
      const std::string name =
          table.tlas ? entry_name(frame, table, reference) : fmt::format("triangle {}", id);
      const bool selected =
          table.tlas ? frame.state.selection.instance == id : frame.state.selection.triangle == id;
      const bool pressed = ImGui::Selectable(name.c_str(), selected);
      mark(fmt::format("{} {}", table.tlas ? "instance" : "triangle", id));
      if (ImGui::IsItemHovered()) {
        frame.state.hovered.instance = table.tlas ? id : instance_of(frame, place.mesh);
        if (!table.tlas) frame.state.hovered.triangle = id;
      }
      tooltip(table.tlas ? "A click selects the instance" : "A click selects the triangle");
      if (pressed && table.tlas) select_instance(frame, id);
      if (pressed && !table.tlas) select_triangle(frame, place.mesh, id);
      ImGui::PopID();
    }
  }
}

void draw_splits(Frame& frame, const NodePlace& place) {
  heading("Splits");
  frame.requests.node_splits = place;
  const auto& work = frame.work.splits;
  const bool known = work.result && work.result->bvh == frame.snapshot.bvh &&
                     work.result->mesh == place.mesh && work.result->node == place.node;
  if (known) {
    draw_node_splits(frame, *work.result);
  } else if (!work.error.empty()) {
    hint(work.error);
  } else {
    ImGui::ProgressBar(work.fraction, {-1.0f, 0.0f}, work.doing.c_str());
    tooltip("Every plane between two centres on each axis is tried");
  }
}

// The leaves that have the selected triangle, or instance, while no node is selected.
void draw_leaves(Frame& frame) {
  NodeState& state = frame.state.node;
  const Selection& selection = frame.state.selection;
  const auto& instances = frame.snapshot.bvh->instances;
  const bool triangle = selection.triangle != tracer::none;
  if (selection.instance >= instances.size()) {
    hint(
        "Select a node: a row of the Tree panel, or a finding. A click into the picture selects a "
        "triangle, whose leaf is then offered here.");
    return;
  }
  const uint32_t mesh = triangle ? instances[selection.instance].mesh : tracer::none;
  const auto table = table_of(frame, mesh);
  if (!table) {
    hint("The nodes are being listed ...");
    return;
  }
  if (state.leaves_of != selection || state.leaves_in != frame.work.inspection.result) {
    state.leaves_of = selection;
    state.leaves_in = frame.work.inspection.result;
    state.leaves = leaves_of(*table, triangle ? selection.triangle : selection.instance);
  }
  hint(triangle ? fmt::format("Triangle {} of {} is in", selection.triangle,
                              instance_name(frame, selection.instance))
                : fmt::format("The selected {} is in the TLAS in",
                              instance_name(frame, selection.instance)),
       "Triangles by their index in the mesh, instances by theirs in the scene");
  for (const uint32_t leaf : std::vector<uint32_t>(state.leaves))
    node_link(frame, fmt::format("leaf {}", leaf).c_str(), *table, {mesh, leaf},
              "Selects this leaf");
  if (state.leaves.empty()) hint("no leaf.");
  if (mesh == tracer::none && link("go in", "root of its mesh", "Selects the root of its BLAS")) {
    select_node(frame, {instances[frame.state.selection.instance].mesh, 0});
  }
}

void draw_selected(Frame& frame, const TreeTable& table, const NodePlace& place) {
  NodeState& state = frame.state.node;
  const Work& work = frame.work;
  if (!state.figures.is_of(work.inspection.result, place.mesh, tracer::ray_class_count,
                           work.visits.result, work.measures.result)) {
    state.figures = {work.inspection.result, place.mesh, tracer::ray_class_count,
                     work.visits.result, work.measures.result};
  }
  const TreeFacts& facts = state.figures.facts();
  const TableNode& row = table.nodes[place.node];
  heading(
      fmt::format("{} of {}", node_name(table, place.node), tree_name(frame, place.mesh)).c_str());
  text_row("Kind",
           row.parent == tracer::none ? "the root"
           : is_leaf(row)             ? "leaf"
                                      : "inner node",
           "The root is entered first; an inner node has children, a leaf triangles or instances");
  draw_links(frame, table, place);
  draw_box(table, place.node);
  draw_measures(facts, place.node);
  draw_rays(frame, facts, place);
  draw_pixels(frame, place);
  draw_references(frame, table, place);
  draw_splits(frame, place);
}

}  // namespace

void draw_node_panel(Frame& frame) {
  if (!frame.snapshot.bvh || !frame.snapshot.scene) {
    hint("A node can be selected once a scene is there: File > Open scene...");
    return;
  }
  frame.requests.inspect = true;
  frame.requests.count_visits = true;
  if (!frame.state.selection.node) {
    draw_leaves(frame);
    return;
  }
  const NodePlace place = *frame.state.selection.node;
  const auto table = table_of(frame, place.mesh);
  if (!table) {
    hint("The nodes are being listed ...");
  } else if (place.node >= table->nodes.size()) {
    hint("The tree has no such node any more.");
  } else if (!table->nodes[place.node].in_layout) {
    hint(fmt::format("Node {} is one of the binary tree that this layout does not have.",
                     place.node));
    link_label("It is in", "The node of the layout that has taken it in");
    node_link(frame, "holder", *table, {place.mesh, holder(*table, place.node)},
              "Selects the node of the layout");
  } else {
    draw_selected(frame, *table, place);
  }
}

}  // namespace ui
