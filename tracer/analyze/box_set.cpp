// What the options say, and the values of the boxes; box_walk.cpp finds these.
#include "tracer/analyze/box_set.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "tracer/analyze/box_walk.h"
#include "tracer/analyze/overlap.h"
#include "tracer/bvh/counters.h"
#include "tracer/choice.h"

namespace tracer {
namespace {

constexpr BoxSetRow sets[] = {
    {"levels", "Levels", "All nodes of some levels: edges from the root", false, true},
    {"leaves", "Leaves", "All leaves", false, false},
    {"node", "Selected node", "Its box alone", true, false},
    {"children", "Node and children", "The selected node with its children", true, false},
    {"ancestors", "Ancestors", "The way from the root to the selected node", true, false},
    {"subtree", "Subtree", "Levels below the selected node, which is level 0", true, true},
};

constexpr BoxTreeRow trees[] = {
    {"scene", "Through the TLAS",
     "The TLAS and below its leaves the BLAS of each instance; levels are counted through"},
    {"blas", "BLASes", "The BLAS of each instance; levels are counted from their roots"},
    {"tlas", "TLAS only", "The tree over the instances"},
};

WantedBoxes wanted_by(const BoxOptions& options) {
  const BoxSetRow* set = find_row(box_sets(), options.what);
  if (set == nullptr) set = &sets[0];
  WantedBoxes wanted{*set,
                     options.tree != "blas",
                     options.tree != "tlas",
                     uint32_t(std::max(options.first_level, 0)),
                     uint32_t(std::max(options.last_level, 0)),
                     set->id == "leaves"};
  if (!set->has_levels) {
    wanted.first = 0;
    wanted.last = set->id == "node" ? 0 : set->id == "children" ? 1 : none;
  }
  return wanted;
}

// Of each two children of the selected node, for each instance.
void share(const PlacedTrees& trees, const BoxSources& sources, NodeBoxes& result) {
  if (!sources.selected || !trees.has(*sources.selected)) return;
  const uint32_t mesh = sources.selected->mesh;
  const std::vector<uint32_t> instances = instances_of(trees.bvh, sources);
  const std::span<const uint32_t> children = trees.children(*sources.selected);
  for (size_t a = 0; a < children.size(); ++a) {
    for (size_t b = a + 1; b < children.size(); ++b) {
      const Box& left = trees.node({mesh, children[a]}).box;
      const Box box = common(left, trees.node({mesh, children[b]}).box);
      if (is_empty(box)) continue;
      for (const uint32_t instance : instances) {
        if (result.shared.size() == max_drawn_boxes) return;
        result.shared.push_back({box, instance});
      }
    }
  }
}

// What the measure says of each box; the figures of a tree are made once.
void fill_values(const BoxOptions& options, const BoxSources& sources,
                 const std::shared_ptr<const Inspection>& inspection, NodeBoxes& result) {
  const NodeMeasureRow* measure = find_row(node_measures(), options.color);
  if (measure == nullptr) measure = &node_measures()[0];
  std::map<uint32_t, NodeFigures> figures;
  const RayClassRow* ray_class = find_row(ray_classes(), options.ray_class);
  const int index = ray_class == nullptr ? ray_class_count : int(ray_class - ray_classes().data());
  const bool of_depth = measure->id == "depth";
  std::vector<float> sizes;
  for (NodeBox& box : result.boxes) {
    if (of_depth) {
      box.value = float(box.depth);
    } else {
      auto [found, is_new] = figures.try_emplace(box.place.mesh);
      if (is_new) {
        found->second = NodeFigures(inspection, box.place.mesh, index,
                                    needs_visits(options) ? sources.visits : nullptr,
                                    needs_measures(options) ? sources.measures : nullptr);
      }
      box.value = float(measure->value(found->second.facts(), box.place.node));
    }
    if (!std::isfinite(box.value)) continue;
    result.range = result.has_values ? ValueRange{std::min(result.range.lo, box.value),
                                                  std::max(result.range.hi, box.value)}
                                     : ValueRange{box.value, box.value};
    result.has_values = true;
    sizes.push_back(std::abs(box.value));
  }
  if (measure->scale == MeasureScale::category) result.range = {0.0f, 1.0f};
  if (measure->scale != MeasureScale::diverging || sizes.empty()) return;
  // 0 in the middle; a few boxes far off do not wash the others out.
  const auto high = sizes.begin() + ptrdiff_t(0.98 * double(sizes.size() - 1));
  std::nth_element(sizes.begin(), high, sizes.end());
  const float reach = std::max(*high, 0.5f);
  result.range = {-reach, reach};
}

// Drawing options do not change which boxes there are.
BoxOptions choosing(BoxOptions options) {
  const BoxOptions usual;
  options.logarithmic = usual.logarithmic;
  options.wire = usual.wire;
  options.translucent = usual.translucent;
  options.fade_hidden = usual.fade_hidden;
  options.line_width = usual.line_width;
  return options;
}

}  // namespace

std::span<const BoxSetRow> box_sets() {
  return sets;
}
std::span<const BoxTreeRow> box_trees() {
  return trees;
}

bool needs_visits(const BoxOptions& options) {
  return is_from(MeasureSource::visits, options.color);
}
bool needs_measures(const BoxOptions& options) {
  return is_from(MeasureSource::epo, options.color);
}

BoxSources needed(const BoxOptions& options, BoxSources sources) {
  if (!needs_visits(options)) sources.visits.reset();
  if (!needs_measures(options)) sources.measures.reset();
  const BoxSetRow* set = find_row(box_sets(), options.what);
  if (!options.sibling_overlap && (set == nullptr || !set->of_selected)) {
    sources.selected.reset();
    sources.instance = none;
  }
  return sources;
}

NodeBoxes node_boxes(const std::shared_ptr<const SceneBvh>& bvh, const BoxOptions& options,
                     const BoxSources& sources) {
  NodeBoxes result;
  result.bvh = bvh;
  result.options = choosing(options);
  result.sources = needed(options, sources);
  if (!bvh) return result;
  const WantedBoxes wanted = wanted_by(options);
  std::shared_ptr<const Inspection> inspection = sources.inspection;
  if (!inspection || inspection->bvh != bvh) {
    inspection = std::make_shared<const Inspection>(inspect(bvh, inspection.get(), {}));
  }
  const PlacedTrees trees{*bvh, *inspection};
  BoxSources led = sources;  // to the nodes that the layout has
  for (std::optional<NodePlace>* place : {&led.selected, &led.isolated}) {
    if (*place && trees.has(**place))
      (*place)->node = holder(*trees.table((*place)->mesh), (*place)->node);
  }
  collect(trees, wanted, led, result);
  if (options.sibling_overlap) share(trees, led, result);
  fill_values(options, sources, inspection, result);
  return result;
}

bool is_of(const NodeBoxes& boxes, const std::shared_ptr<const SceneBvh>& bvh,
           const BoxOptions& options, const BoxSources& sources) {
  return boxes.bvh == bvh && boxes.options == choosing(options) &&
         boxes.sources == needed(options, sources);
}

}  // namespace tracer
