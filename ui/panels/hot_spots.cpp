// The nodes that cost most beyond their prediction, and why.
#include <algorithm>

#include <fmt/format.h>

#include "ui/node_words.h"
#include "ui/panels.h"
#include "ui/places.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::HotSpot;
using tracer::HotSpots;

std::string status(const Frame& frame) {
  const auto& work = frame.work.hot_spots;
  if (!work.error.empty()) return work.error;
  if (frame.work.visits.running) return "counting the visits of the picture's rays ...";
  if (frame.work.inspection.running) return "listing the nodes ...";
  if (work.running) return work.doing + " ...";
  if (!work.result || !work.result->counted) return "waiting for the picture";
  const auto& counted = *work.result->counted->visits;
  return fmt::format("visits of the last picture, counted in {:.0f} ms", counted.milliseconds);
}

void draw_controls(Frame& frame) {
  HotState& state = frame.state.hot;
  ImGui::BeginChild("options", {17.0f * em(), ImGui::GetFrameHeight()});
  const std::vector<Choice> classes = ray_choices();
  combo("Rays", state.ray_class, std::span<const Choice>(classes),
        "Whose visits are counted: those of the picture, one sample a pixel");
  ImGui::EndChild();
  ImGui::SameLine();
  checkbox("With a cause", state.with_cause,
           "Only nodes with something wrong about them; without it, also those that the view just "
           "comes by more often than random lines would");
  ImGui::SameLine(0.0f, 2.0f * em());
  ImGui::AlignTextToFramePadding();
  hint(status(frame), "The visits of all rays of a frame, one sample a pixel, are counted by node");
  mark("status");
}

void draw_row(Frame& frame, const HotSpot& spot, size_t index, bool stale) {
  const Scope scope("spot", index);
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  const NodePlace place{spot.mesh, spot.node};
  const bool selected = frame.state.selection.node == place;
  const ImGuiSelectableFlags flags =
      ImGuiSelectableFlags_SpanAllColumns | (stale ? ImGuiSelectableFlags_Disabled : 0);
  const std::string share = fmt::format("{:.2f} %", 100.0 * spot.excess);
  if (ImGui::Selectable(share.c_str(), selected && !stale, flags)) {
    select_place(frame, spot.mesh, spot.node, spot.triangle);
  }
  mark("row");
  if (ImGui::IsItemHovered() && !stale) frame.state.hovered.node = place;
  tooltip(fmt::format(
      "{}\n\nVisits {:.0f}, predicted {:.1f}: visits of the root times the node's share "
      "of its area.{}",
      spot.text, spot.visits, spot.predicted, stale ? "" : "\n\nA click selects the node."));
  cell(spot.predicted > 0.0 ? short_number(spot.visits / spot.predicted) + " x" : "");
  cell(std::string(name(spot.cause)));
  cell(place_name(frame, spot.mesh, spot.node, spot.triangle));
  cell(spot.text);
}

void draw_table(Frame& frame, const HotSpots& found, bool stale) {
  const ImGuiTableFlags flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY |
                                ImGuiTableFlags_ScrollX | ImGuiTableFlags_SizingFixedFit |
                                ImGuiTableFlags_BordersInnerV;
  if (!ImGui::BeginTable("spots", 5, flags, ImGui::GetContentRegionAvail())) return;
  ImGui::TableSetupScrollFreeze(0, 1);
  for (const char* column : {"Excess", "Ratio", "Cause", "Where", "Why, and what to do"})
    ImGui::TableSetupColumn(column);
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  header("Excess",
         "Cost of the visits beyond the prediction, as a share of the cost of all visits of the "
         "picture: Ct an inner node, count * Ci a leaf");
  header(
      "Ratio",
      "Measured visits / predicted: visits of the root * A(node) / A(root), for a leaf the area of "
      "its triangles / A(root)");
  header("Cause", "What makes the node expensive, as its boxes tell");
  header("Where", "Tree, node, and the triangle or instance that makes the node what it is");
  header("Why, and what to do", "In words");
  if (stale) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.5f);
  for (size_t i = 0; i < found.spots.size(); ++i) {
    const bool of_view = found.spots[i].cause == tracer::HotCause::view;
    if (!of_view || !frame.state.hot.with_cause) draw_row(frame, found.spots[i], i, stale);
  }
  if (stale) ImGui::PopStyleVar();
  ImGui::EndTable();
}

}  // namespace

void draw_hot_spots(Frame& frame) {
  if (!frame.snapshot.bvh) {
    hint("Visits are counted once a picture is there: File > Open scene...");
    return;
  }
  HotState& state = frame.state.hot;
  draw_controls(frame);
  frame.requests.inspect = true;
  frame.requests.count_visits = true;
  frame.requests.hot_spots = ray_class_index(state.ray_class);
  const auto& found = frame.work.hot_spots.result;
  if (!found || !found->inspection) return;
  const auto with_cause =
      std::count_if(found->spots.begin(), found->spots.end(),
                    [](const HotSpot& spot) { return spot.cause != tracer::HotCause::view; });
  if (found->spots.empty()) {
    hint("No node costs more than its surface predicts.");
  } else if (with_cause == 0 && state.with_cause) {
    hint(
        "Nothing is wrong with the nodes that cost more than their surface predicts; untick \"With "
        "a "
        "cause\" to see them.");
  } else {
    draw_table(frame, *found, found->inspection->bvh != frame.snapshot.bvh);
  }
}

}  // namespace ui
