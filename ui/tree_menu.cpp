// What can be done with a row of the Tree panel.
#include "ui/tree_menu.h"

#include <algorithm>

#include "ui/actions.h"
#include "ui/registry.h"
#include "ui/tree_list.h"

namespace ui {
namespace {

using tracer::TreeFacts;

void toggle(std::vector<NodePlace>& places, const NodePlace& place) {
  const auto found = std::find(places.begin(), places.end(), place);
  if (found == places.end()) {
    places.push_back(place);
  } else {
    places.erase(found);
  }
}

void draw_node_menu(Frame& frame, const TreeFacts& facts, uint32_t node) {
  TreeState& state = frame.state.tree;
  BoxFilter& filter = frame.state.box_filter;
  const NodePlace place{state.mesh, node};
  const auto found = std::find(state.rows.rows.begin(), state.rows.rows.end(), node);
  const auto at = static_cast<size_t>(found - state.rows.rows.begin());
  if (menu_item("Focus", "F", "The camera looks at its box")) {
    select_node(frame, place);
    state.revealed = frame.state.selection;
    focus_selection(frame);
  }
  if (menu_item("Open all below", nullptr, "All nodes of this subtree, down to the leaves", false,
                found != state.rows.rows.end())) {
    open_below(state.rows, facts, sibling_order(state), at, false);
  }
  ImGui::Separator();
  const bool hidden = is_hidden(filter, place), isolated = filter.isolated == place;
  if (menu_item(isolated ? "Show others too" : "Isolate in 3D", nullptr,
                "Of the boxes in 3D, show only this one and those below it")) {
    filter.isolated = isolated ? std::nullopt : std::optional<NodePlace>(place);
  }
  if (menu_item(hidden ? "Show in 3D" : "Hide in 3D", nullptr,
                "Of the boxes in 3D, leave this one and those below it out")) {
    toggle(filter.hidden, place);
  }
  if (menu_item("Show all in 3D", nullptr, "Nothing is hidden or isolated any more", false,
                filter != BoxFilter())) {
    filter = {};
  }
  ImGui::Separator();
  if (menu_item("Copy the row", nullptr, "All that is known of the node, to the clipboard")) {
    ImGui::SetClipboardText(node_text(frame, facts, place).c_str());
  }
}

void draw_reference_menu(Frame& frame, const TreeFacts& facts, uint32_t reference) {
  TreeState& state = frame.state.tree;
  if (facts.table->tlas) {
    if (menu_item("Go into its tree", nullptr, "Shows the BLAS of the instance's mesh")) {
      go_into(frame, reference);
      state.revealed = frame.state.selection;
    }
  } else if (menu_item("Select", nullptr, "This triangle")) {
    select_triangle(frame, state.mesh, reference);
    state.revealed = frame.state.selection;
  }
  if (menu_item("Focus", "F", "The camera looks at its instance")) {
    select_instance(frame, facts.table->tlas ? reference : instance_of(frame, state.mesh));
    state.revealed = frame.state.selection;
    focus_selection(frame);
  }
}

}  // namespace

bool is_hidden(const BoxFilter& filter, const NodePlace& place) {
  return std::find(filter.hidden.begin(), filter.hidden.end(), place) != filter.hidden.end();
}

void go_into(Frame& frame, uint32_t instance) {
  if (!frame.snapshot.bvh || instance >= frame.snapshot.bvh->instances.size()) return;
  select_instance(frame, instance);
  show_tree(frame.state.tree, frame.snapshot.bvh->instances[instance].mesh);
}

void draw_tree_menu(Frame& frame, const TreeFacts& facts, bool current) {
  if (!ImGui::BeginPopup("row menu")) return;
  {
    const Scope scope("menu");
    const uint32_t row = frame.state.tree.menu_row;
    if (!current || row == tracer::none) {
      ImGui::CloseCurrentPopup();
    } else if (!is_reference(row) && row < facts.table->nodes.size()) {
      draw_node_menu(frame, facts, row);
    } else if (is_reference(row) && reference_place(row) < facts.table->references.size()) {
      draw_reference_menu(frame, facts, facts.table->references[reference_place(row)]);
    }
  }
  ImGui::EndPopup();
}

}  // namespace ui
