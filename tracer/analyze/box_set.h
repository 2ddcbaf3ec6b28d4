// Which nodes' boxes are drawn over a picture, and the values that colour them.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "tracer/analyze/inspection.h"
#include "tracer/settings.h"

namespace tracer {

struct BoxSetRow {
  std::string_view id, label, help;
  bool of_selected;  // node
  bool has_levels;   // that are chosen
};
std::span<const BoxSetRow> box_sets();

struct BoxTreeRow {
  std::string_view id, label, help;
};
std::span<const BoxTreeRow> box_trees();

inline constexpr size_t max_drawn_boxes = 20000;

// What is known beside the trees. What is missing (nullptr) or of older trees has no values.
struct BoxSources {
  std::shared_ptr<const Inspection> inspection;
  std::shared_ptr<const CountedVisits> visits;
  std::shared_ptr<const Measures> measures;
  std::optional<NodePlace> selected;
  uint32_t instance = none;  // through which a selected node is seen; none: all of its mesh
  std::optional<NodePlace> isolated;  // it and what is below it; nothing: everything
  std::vector<NodePlace> hidden;      // these and what is below them are left out
  bool operator==(const BoxSources&) const = default;
};

// Whether the measure is of visits or of EPO, which somebody has to take.
bool needs_visits(const BoxOptions& options);
bool needs_measures(const BoxOptions& options);

// Without what the options do not ask about: two that are equal then give the same boxes.
BoxSources needed(const BoxOptions& options, BoxSources sources);

struct NodeBox {
  NodePlace place;
  Box box;                   // as the layout has it, in the space of its tree
  uint32_t instance = none;  // none: of the TLAS, in the world
  uint32_t depth = 0;        // in its tree; counted through from the root of a TLAS that is walked
  float area = 0.0f;         // half of it, in the world
  float value = 0.0f;        // of the measure; NaN: none
};

// What two siblings have in common.
struct SharedBox {
  Box box;
  uint32_t instance = none;
};

struct NodeBoxes {
  // That they are of.
  std::shared_ptr<const SceneBvh> bvh;
  BoxOptions options;
  BoxSources sources;

  std::vector<NodeBox> boxes;     // the largest max_drawn_boxes in the world
  std::vector<SharedBox> shared;  // of each two children of the selected node, once an instance
  uint64_t found = 0;             // boxes that were asked for
  bool at_least = false;          // there are more, which were not counted
  ValueRange range;               // of the values
  bool has_values = false;
};

// Makes the tables of the trees if the sources lack them. Bounded: of a level the 65,536 largest
// nodes are followed down at most. Unknown ids: the default.
NodeBoxes node_boxes(const std::shared_ptr<const SceneBvh>& bvh, const BoxOptions& options,
                     const BoxSources& sources);

// Whether they would be the same ones with the same values.
bool is_of(const NodeBoxes& boxes, const std::shared_ptr<const SceneBvh>& bvh,
           const BoxOptions& options, const BoxSources& sources);

}  // namespace tracer
