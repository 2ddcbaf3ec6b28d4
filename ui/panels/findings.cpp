// What a check of the trees has found, and facts about the selected node.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tracer/choice.h"
#include "ui/panels.h"
#include "ui/places.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::Finding;
using tracer::Validation;

constexpr Choice severities[] = {
    {"all", "All", "Errors and warnings"},
    {"error", "Errors", "What makes pictures wrong, or would"},
    {"warning", "Warnings", "What wastes time or is not as the options ask"},
};

std::string help_of(std::string_view rule) {
  if (const tracer::TreeRule* row = tracer::find_row(tracer::tree_rules(), rule)) {
    return fmt::format("{}: {}", row->label, row->help);
  }
  if (rule == tracer::instances_rule) return "Instances have a mesh, and a matrix and its inverse";
  if (rule == tracer::hits_rule) {
    return "Random rays hit through the trees what they hit when every triangle is tested";
  }
  return "";
}

std::string place_of(const Frame& frame, const Finding& finding) {
  return place_name(frame, finding.bvh, finding.node, finding.triangle);
}

bool contains(std::string_view text, std::string_view part) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) ==
           std::tolower(static_cast<unsigned char>(b));
  };
  return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

bool matches(const Frame& frame, const Finding& finding) {
  const FindingsState& state = frame.state.findings;
  if (state.severity != "all" && state.severity != name(finding.severity)) return false;
  return state.filter.empty() || contains(finding.message, state.filter) ||
         contains(finding.rule, state.filter) || contains(place_of(frame, finding), state.filter);
}

std::string summary(const Validation& validation, bool stopped) {
  const auto errors = std::count_if(
      validation.findings.begin(), validation.findings.end(),
      [](const Finding& finding) { return finding.severity == tracer::Severity::error; });
  const std::string rays =
      validation.rays_checked > 0
          ? fmt::format("{} rays checked against brute force", grouped(validation.rays_checked))
          : std::string("no rays compared");
  std::string text = stopped ? "stopped: " : "";
  if (validation.findings.empty()) {
    text += fmt::format("no findings: {} trees and {}", validation.trees_checked, rays);
  } else {
    text += fmt::format("{} errors, {} warnings in {} trees; {}", errors,
                        validation.findings.size() - static_cast<size_t>(errors),
                        validation.trees_checked, rays);
  }
  return text;
}

void draw_running(Frame& frame) {
  const auto& work = frame.work.checks;
  const std::string text = fmt::format("{}  {:.0f} %", work.doing, 100.0f * work.fraction);
  ImGui::ProgressBar(work.fraction, {22.0f * em(), 0}, text.c_str());
  mark("progress");
  tooltip("Rules for every tree, then random rays against testing every triangle");
  ImGui::SameLine();
  if (button("Cancel", "Stop; what has been found stays")) frame.requests.cancel_check = true;
}

void draw_controls(Frame& frame, bool stale) {
  const auto& work = frame.work.checks;
  if (work.running) {
    draw_running(frame);
    return;
  }
  if (button("Check the trees",
             "Hold each tree against rules (links, boxes, references, depth, SAH against random "
             "lines), and compare the hits of random rays with testing every triangle")) {
    frame.requests.check_trees = true;
  }
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  if (!work.error.empty()) {
    ImGui::TextUnformatted(work.error.c_str());
  } else if (stale) {
    ImGui::TextColored({0.98f, 0.80f, 0.36f, 1.0f},
                       "The trees have changed since: check them again.");
    mark("stale");
  } else if (work.result) {
    ImGui::TextUnformatted(summary(work.result->validation, work.stopped).c_str());
    mark("summary");
    tooltip("Rays: half random lines, the others aimed at vertices and at edges");
  }
}

void draw_row(Frame& frame, const Finding& finding, size_t index, bool stale) {
  const Scope scope("finding", index);
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  const bool error = finding.severity == tracer::Severity::error;
  const std::optional<NodePlace>& node = frame.state.selection.node;
  const bool selected =
      finding.node != tracer::none && node == NodePlace{finding.bvh, finding.node};
  ImGui::PushStyleColor(
      ImGuiCol_Text, error ? ImVec4(1.0f, 0.48f, 0.42f, 1.0f) : ImVec4(0.98f, 0.80f, 0.36f, 1.0f));
  const ImGuiSelectableFlags flags =
      ImGuiSelectableFlags_SpanAllColumns | (stale ? ImGuiSelectableFlags_Disabled : 0);
  if (ImGui::Selectable(std::string(name(finding.severity)).c_str(), selected && !stale, flags)) {
    select_place(frame, finding.bvh, finding.node, finding.triangle);
  }
  ImGui::PopStyleColor();
  mark("row");
  tooltip(fmt::format("{}\n\n{}{}", finding.message, help_of(finding.rule),
                      stale ? "" : "\n\nA click selects the node."));
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(std::string(finding.rule).c_str());
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(place_of(frame, finding).c_str());
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(finding.message.c_str());
}

void draw_list(Frame& frame, bool stale) {
  const auto& findings = frame.work.checks.result->validation.findings;
  const ImGuiTableFlags flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY |
                                ImGuiTableFlags_ScrollX | ImGuiTableFlags_SizingFixedFit |
                                ImGuiTableFlags_BordersInnerV;
  if (!ImGui::BeginTable("findings", 4, flags, ImGui::GetContentRegionAvail())) return;
  ImGui::TableSetupScrollFreeze(0, 1);
  for (const char* column : {"Severity", "Rule", "Where", "What is wrong"})
    ImGui::TableSetupColumn(column);
  ImGui::TableHeadersRow();
  if (stale) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.5f);
  for (size_t i = 0; i < findings.size(); ++i) {
    if (matches(frame, findings[i])) draw_row(frame, findings[i], i, stale);
  }
  if (stale) ImGui::PopStyleVar();
  ImGui::EndTable();
}

void draw_filters(Frame& frame) {
  FindingsState& state = frame.state.findings;
  const float left = ImGui::GetCursorPosX();
  ImGui::BeginChild("filters", {15.0f * em(), ImGui::GetFrameHeight()});
  combo("Show", state.severity, std::span<const Choice>(severities), "Which findings are listed");
  ImGui::EndChild();
  ImGui::SameLine(left + 16.0f * em());
  input("Filter", state.filter, "part of a rule, place or message",
        "Lists only what has this text");
}

const tracer::Bvh* tree_at(const tracer::SceneBvh& bvh, const NodePlace& place) {
  if (place.mesh == tracer::none) return &bvh.tlas;
  return place.mesh < bvh.blases.size() ? &bvh.blases[place.mesh]->tree : nullptr;
}

const std::optional<tracer::NodeFacts>& facts(Frame& frame, const NodePlace& place) {
  FindingsState& state = frame.state.findings;
  if (state.facts_of == frame.snapshot.bvh && state.facts_at == place) return state.facts;
  state.facts_of = frame.snapshot.bvh;
  state.facts_at = place;
  const tracer::Bvh* tree = tree_at(*state.facts_of, place);
  state.facts = tree != nullptr ? tracer::node_facts(*tree, place.node) : std::nullopt;
  return state.facts;
}

std::string numbers(const tracer::vec3& v) {
  return fmt::format("{}  {}  {}", short_number(v.x), short_number(v.y), short_number(v.z));
}

void draw_node(Frame& frame) {
  heading("Selected node");
  if (!frame.state.selection.node) {
    hint("A click on a finding selects its node; the viewport shows its box.");
    return;
  }
  const NodePlace place = *frame.state.selection.node;
  const std::optional<tracer::NodeFacts>& known = facts(frame, place);
  if (!known) {
    hint("The tree has no such node any more.");
    return;
  }
  const bool top = place.mesh == tracer::none;
  text_row(
      "Node",
      fmt::format("{} of {}{}", place.node, top ? "the TLAS" : fmt::format("mesh {}", place.mesh),
                  known->leaf ? ", a leaf" : ""),
      "Index in the binary tree");
  text_row("Parent", known->parent == tracer::none ? "none" : fmt::format("{}", known->parent),
           "Index of the node whose child it is in the binary tree");
  text_row("Depth", fmt::format("{}", known->depth), "Edges from the root of the binary tree");
  text_row("References", grouped(known->references),
           top ? "Instances in the leaves below" : "Entries of the leaves below: triangles");
  text_row("Area share", fmt::format("{:.3g} %", 100.0 * known->area_share),
           "A(node) / A(root), the surface areas of the boxes: how often a random line through the "
           "root meets the node");
  text_row("Lower", numbers(known->box.lo),
           top ? "Corner of the box, in the world" : "Corner of the box, in the mesh's own space");
  text_row("Upper", numbers(known->box.hi),
           top ? "Corner of the box, in the world" : "Corner of the box, in the mesh's own space");
}

}  // namespace

void draw_findings(Frame& frame) {
  if (!frame.snapshot.bvh) {
    hint("Trees can be checked once a scene is there: File > Open scene...");
    return;
  }
  const auto& result = frame.work.checks.result;
  const bool stale = result && result->bvh != frame.snapshot.bvh;
  draw_controls(frame, stale);
  const ImVec2 area = ImGui::GetContentRegionAvail();
  const float side = std::min(22.0f * em(), 0.4f * area.x);
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  if (ImGui::BeginChild("list", {area.x - side - gap, area.y})) {
    if (!result && !frame.work.checks.running) {
      hint(
          "Check the trees: every rule that the traversal relies on, and random rays against brute "
          "force. It takes a few seconds, beside the picture.");
    } else if (result && result->validation.findings.empty()) {
      if (!stale && !frame.work.checks.running) hint("Everything is as it should be.");
    } else if (result) {
      draw_filters(frame);
      draw_list(frame, stale);
    }
  }
  ImGui::EndChild();
  ImGui::SameLine();
  if (ImGui::BeginChild("node", {side, area.y})) draw_node(frame);
  ImGui::EndChild();
}

}  // namespace ui
