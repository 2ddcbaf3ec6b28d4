// The nodes of the trees, TLAS and BLAS, down to triangles: choose a tree, search it, follow the
// selection. The list itself is in tree_list.h.
#include <algorithm>
#include <cctype>
#include <charconv>

#include <fmt/format.h>
#include <imgui.h>
#if __has_include(<imgui_stdlib.h>)
#include <imgui_stdlib.h>
#else
#include <misc/cpp/imgui_stdlib.h>
#endif

#include "tracer/choice.h"
#include "ui/panels.h"
#include "ui/places.h"
#include "ui/registry.h"
#include "ui/tree_list.h"

namespace ui {
namespace {

using tracer::TreeFacts;

constexpr Choice search_kinds[] = {
    {"node", "Node", "A bare number is a node's index in the tree, as in 'n 12'"},
    {"triangle", "Triangle", "A bare number is a triangle's index in the mesh, as in 't 12'"},
    {"instance", "Instance", "A bare number is an instance's index in the scene, as in 'i 12'"},
};

bool needs_visits(const TreeState& state) {
  const auto counts = [](std::string_view id) {
    return tracer::is_from(tracer::MeasureSource::visits, id);
  };
  return counts(state.sort) || std::any_of(state.columns.begin(), state.columns.end(), counts);
}

// The one tree of a scene of one instance, or the TLAS.
void choose_tree(Frame& frame) {
  TreeState& state = frame.state.tree;
  const tracer::SceneBvh& bvh = *frame.snapshot.bvh;
  const bool gone = state.mesh != tracer::none && state.mesh >= bvh.blases.size();
  if (state.scene_generation == frame.snapshot.scene_generation && !gone) return;
  state.scene_generation = frame.snapshot.scene_generation;
  state.revealed = {};
  show_tree(state, bvh.instances.size() == 1 ? bvh.instances[0].mesh : tracer::none);
}

// Shows a row, with some of what is above it.
void scroll_to(TreeState& state, size_t row) {
  const auto at = static_cast<double>(row);
  if (at < state.top || at >= state.top + state.page) {
    state.top = std::max(at - std::floor(0.4 * state.page), 0.0);
  }
}

// Takes over a new table, and what is known of its nodes. False: there is nothing to show yet.
bool make_rows(Frame& frame) {
  TreeState& state = frame.state.tree;
  const auto table = newest_table(frame, state.mesh);
  if (!table || table->nodes.empty()) return false;
  const Work& work = frame.work;
  const int ray_class = ray_class_index(state.ray_class);
  const bool stale = !state.figures.is_of(work.inspection.result, state.mesh, ray_class,
                                          work.visits.result, work.measures.result);
  if (stale) {
    state.figures = {work.inspection.result, state.mesh, ray_class, work.visits.result,
                     work.measures.result};
  }
  if (state.table != table) {
    const bool same_shape =
        state.table && state.table->tlas == table->tlas &&
        state.rows.open.size() == table->nodes.size() &&
        std::equal(table->nodes.begin(), table->nodes.end(), state.table->nodes.begin(),
                   [](auto& a, auto& b) { return a.first == b.first && a.children == b.children; });
    state.table = table;  // refitted boxes leave open what is open
    if (same_shape) {
      sort_rows(state.rows, state.figures.facts(), sibling_order(state));
    } else {
      state.rows = tree_rows(state.figures.facts(), sibling_order(state));
    }
  } else if (stale && !state.sort.empty()) {
    sort_rows(state.rows, state.figures.facts(), sibling_order(state));
  }
  return true;
}

// Opens the list to what another panel has selected.
void follow_selection(Frame& frame) {
  TreeState& state = frame.state.tree;
  const Selection& selection = frame.state.selection;
  const auto& instances = frame.snapshot.bvh->instances;
  const bool has_instance = selection.instance < instances.size();
  if (selection.node == state.revealed.node && selection.instance == state.revealed.instance &&
      selection.triangle == state.revealed.triangle) {
    return;
  }
  const bool has_triangle = has_instance && selection.triangle != tracer::none;
  if (!selection.node && !has_instance) {
    state.revealed = selection;
    return;
  }
  const bool new_node = selection.node && selection.node != state.revealed.node;
  const uint32_t mesh = new_node         ? selection.node->mesh
                        : has_triangle   ? instances[selection.instance].mesh
                        : selection.node ? selection.node->mesh
                                         : tracer::none;
  if (mesh != state.mesh) show_tree(state, mesh);
  const auto table = table_of(frame, mesh);
  if (!table || !make_rows(frame) || state.table != table) return;  // it comes
  state.revealed = selection;
  const TreeFacts& facts = state.figures.facts();
  const SiblingOrder order = sibling_order(state);
  if (new_node || (selection.node && !has_triangle)) {
    if (selection.node->node >= table->nodes.size()) return;
    scroll_to(state, reveal_node(state.rows, facts, order, selection.node->node));
    return;
  }
  const uint32_t reference = has_triangle ? selection.triangle : selection.instance;
  const std::vector<uint32_t> leaves = leaves_of(*table, reference);
  if (leaves.empty()) return;
  scroll_to(state, reveal_reference(state.rows, facts, order, leaves[0], reference));
}

// The tree and what is above it.
void draw_choice(Frame& frame) {
  TreeState& state = frame.state.tree;
  const tracer::SceneBvh& bvh = *frame.snapshot.bvh;
  ImGui::SetNextItemWidth(-1.0f);
  uint32_t chosen = state.mesh;
  if (tree_combo(frame, "Tree", chosen,
                 "Which tree is shown: the TLAS over the instances, or the BLAS of one mesh")) {
    show_tree(state, chosen);
  }
  if (state.mesh == tracer::none) return;
  if (link("TLAS", "TLAS", "Up to the tree over the instances")) {
    show_tree(state, tracer::none);
    return;
  }
  const uint32_t instance = frame.state.selection.instance;
  if (instance < bvh.instances.size() && bvh.instances[instance].mesh == state.mesh) {
    ImGui::SameLine();
    hint(">");
    ImGui::SameLine();
    if (link("instance", instance_name(frame, instance),
             "Up to the leaf of the TLAS that has this instance")) {
      show_tree(state, tracer::none);
      select_instance(frame, instance);
      state.revealed = {};
    }
  }
  ImGui::SameLine();
  hint("> " + tree_name(frame, state.mesh), "The tree that is shown");
}

struct Wanted {
  std::string kind;
  uint32_t id = 0;
};

// "n 12", "t12", "12"; nothing if it is none of these.
std::optional<Wanted> parsed(const TreeSearch& search) {
  std::string_view text = search.text;
  const auto space = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && space(text.front()))
    text.remove_prefix(1);
  while (!text.empty() && space(text.back()))
    text.remove_suffix(1);
  Wanted wanted{search.kind};
  const size_t letters = static_cast<size_t>(
      std::find_if(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; }) -
      text.begin());
  std::string word;
  for (const char c : text.substr(0, letters)) {
    if (!space(c)) word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (!word.empty()) {
    wanted.kind.clear();
    for (const Choice& kind : search_kinds) {
      if (kind.id.starts_with(word)) wanted.kind = kind.id;
    }
    if (word == "leaf") wanted.kind = "node";
  }
  text.remove_prefix(letters);
  const auto end = std::from_chars(text.data(), text.data() + text.size(), wanted.id);
  if (wanted.kind.empty() || text.empty() || end.ec != std::errc() ||
      end.ptr != text.data() + text.size()) {
    return {};
  }
  return wanted;
}

// Shows one of the leaves that were found.
void show_found(Frame& frame) {
  TreeState& state = frame.state.tree;
  const TreeSearch& search = state.search;
  const std::optional<Wanted> wanted = parsed(search);
  if (!wanted || search.at >= search.leaves.size()) return;
  if (wanted->kind == "instance") {
    select_instance(frame, wanted->id);
  } else {
    select_triangle(frame, state.mesh, wanted->id);
    frame.state.selection.node.reset();
  }
  state.revealed = frame.state.selection;
  scroll_to(state, reveal_reference(state.rows, state.figures.facts(), sibling_order(state),
                                    search.leaves[search.at], wanted->id));
}

void search_tree(Frame& frame) {
  TreeState& state = frame.state.tree;
  TreeSearch& search = state.search;
  search.leaves.clear();
  search.at = 0;
  search.answer.clear();
  if (search.text.empty()) return;
  const std::optional<Wanted> wanted = parsed(search);
  if (!wanted) {
    search.answer = "Type n 12 for a node, t 12 for a triangle, i 12 for an instance.";
    return;
  }
  if (wanted->kind == "instance" && !state.table->tlas) {
    show_tree(state, tracer::none);
    if (!make_rows(frame)) return;
  }
  const tracer::TreeTable& table = *state.table;
  if (wanted->kind == "node") {
    if (wanted->id < table.nodes.size()) {
      const uint32_t shown = holder(table, wanted->id);
      if (shown != wanted->id) {
        search.answer = fmt::format("This layout does not have node {}: it is in {}.", wanted->id,
                                    node_name(table, shown));
      }
      select_node(frame, {state.mesh, shown});
    } else {
      search.answer = fmt::format("There is no node {}: the last one is {}.", wanted->id,
                                  table.nodes.size() - 1);
    }
    return;
  }
  if (wanted->kind == "triangle" && table.tlas) {
    search.answer = "The TLAS has instances: go into the tree of a mesh to find a triangle.";
    return;
  }
  search.leaves = leaves_of(table, wanted->id);
  if (search.leaves.empty()) {
    search.answer = fmt::format("No leaf has {} {}.", wanted->kind, wanted->id);
  }
  show_found(frame);
}

void draw_search(Frame& frame) {
  TreeSearch& search = frame.state.tree.search;
  const float kind_width = 6.5f * em();
  ImGui::SetNextItemWidth(
      std::max(ImGui::GetContentRegionAvail().x - kind_width - 0.5f * em(), 4.0f * em()));
  if (ImGui::InputTextWithHint("##find", "find: 12, n 12, t 42, i 7", &search.text,
                               ImGuiInputTextFlags_EnterReturnsTrue)) {
    search_tree(frame);
  }
  mark("Find");
  tooltip("A node (n 12), triangle (t 42) or instance (i 7); Enter opens the tree to it");
  ImGui::SameLine(0.0f, 0.5f * em());
  ImGui::SetNextItemWidth(kind_width);
  std::string shown;
  for (const Choice& kind : search_kinds) {
    if (kind.id == search.kind) shown = kind.label;
  }
  if (ImGui::BeginCombo("##kind", shown.c_str())) {
    {
      const Scope scope("Kind");
      for (const Choice& kind : search_kinds) {
        if (ImGui::Selectable(std::string(kind.label).c_str(), kind.id == search.kind)) {
          search.kind = kind.id;
        }
        mark(kind.id);
        tooltip(kind.help);
      }
    }
    ImGui::EndCombo();
  } else {
    mark("Kind");
    tooltip("What a bare number is");
  }
  if (!search.answer.empty()) hint(search.answer, "What the search has found");
  if (search.leaves.size() < 2) return;
  hint(fmt::format("leaf {}, {} of {}", search.leaves[search.at], search.at + 1,
                   search.leaves.size()),
       "The leaf by its index in the tree, and how many refer to it");
  ImGui::SameLine();
  if (link("Next", "next", "The triangle was cut: the next leaf that refers to it")) {
    search.at = (search.at + 1) % search.leaves.size();
    show_found(frame);
  }
}

void draw_columns(Frame& frame, const TreeFacts& facts) {
  TreeState& state = frame.state.tree;
  if (!ImGui::BeginPopup("columns")) return;
  {
    const Scope scope("columns");
    for (const tracer::NodeMeasureRow& measure : tracer::node_measures()) {
      const auto found = std::find(state.columns.begin(), state.columns.end(), measure.id);
      bool shown = found != state.columns.end();
      const std::string label(measure.label), help(measure.help);
      ImGui::PushID(&measure);
      const bool changed = ImGui::Checkbox(label.c_str(), &shown);
      mark(measure.id);
      tooltip(help);
      ImGui::PopID();
      if (changed && shown) {
        state.columns.emplace_back(measure.id);
      } else if (changed) {
        state.columns.erase(found);
      }
    }
    ImGui::Dummy({16.0f * em(), 0});
    combo("Rays", state.ray_class, std::span<const Choice>(ray_choices()),
          "Whose visits are counted");
    if (facts.visits.empty()) hint("Visits are counted while a column shows them.");
  }
  ImGui::EndPopup();
}

void draw_buttons(Frame& frame) {
  TreeState& state = frame.state.tree;
  const TreeFacts& facts = state.figures.facts();
  if (button("Columns...", "Which measures are shown, and of which rays")) {
    ImGui::OpenPopup("columns");
  }
  draw_columns(frame, facts);
  ImGui::SameLine();
  if (button("Open all", "Every inner node")) {
    open_below(state.rows, facts, sibling_order(state), 0, false);
  }
  ImGui::SameLine();
  if (button("Close all", "All but the root")) {
    state.rows = tree_rows(facts, sibling_order(state));
    state.top = 0.0;
  }
  hint(fmt::format("{} nodes, depth {}, {} {}", grouped(node_count(*facts.table)),
                   facts.table->depth, grouped(facts.table->references.size()),
                   facts.table->tlas ? references_name(*facts.table) : "references"),
       "Inner nodes and leaves; edges from the root to the deepest leaf; what all leaves refer to: "
       "more than the mesh has triangles where some were split");
}

}  // namespace

void draw_tree(Frame& frame) {
  if (!frame.snapshot.bvh || !frame.snapshot.scene) {
    hint("The trees are listed here once a scene is there: File > Open scene...");
    return;
  }
  TreeState& state = frame.state.tree;
  frame.requests.inspect = true;
  if (needs_visits(state)) frame.requests.count_visits = true;
  choose_tree(frame);
  follow_selection(frame);
  draw_choice(frame);
  if (!make_rows(frame)) {
    hint(newest_table(frame, state.mesh) ? "This tree is empty."
                                         : "The nodes are being listed ...");
    return;
  }
  draw_search(frame);
  if (!make_rows(frame)) return;
  draw_buttons(frame);
  draw_tree_list(frame, table_of(frame, state.mesh) == state.table);
}

}  // namespace ui
