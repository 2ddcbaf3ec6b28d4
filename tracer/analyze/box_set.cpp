// Walks down the trees, level by level, the largest nodes first where there are too many.
#include "tracer/analyze/box_set.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "tracer/analyze/overlap.h"
#include "tracer/bvh/counters.h"
#include "tracer/choice.h"

namespace tracer {
namespace {

constexpr size_t most_followed = 1 << 16;  // nodes of a level
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

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

// What the ids say.
struct Wanted {
  const BoxSetRow& set;
  bool tlas, blases;
  uint32_t first, last;  // levels
  bool leaves;
};

struct Walked {
  NodePlace place;
  uint32_t instance = none;
  uint32_t depth = 0;
  bool inside = true;  // of what is isolated
  float area = 0.0f;
};

bool before(const Walked& a, const Walked& b) {
  if (a.area != b.area) return a.area > b.area;
  return std::tie(a.instance, a.place.mesh, a.place.node) <
         std::tie(b.instance, b.place.mesh, b.place.node);
}

void keep_largest(std::vector<Walked>& nodes, size_t most) {
  if (nodes.size() <= most) return;
  std::nth_element(nodes.begin(), nodes.begin() + ptrdiff_t(most), nodes.end(), before);
  nodes.resize(most);
}

const Bvh* tree_of(const SceneBvh& bvh, uint32_t mesh) {
  if (mesh == none) return &bvh.tlas;
  return mesh < bvh.blases.size() ? &bvh.blases[mesh]->tree : nullptr;
}

bool exists(const SceneBvh& bvh, const NodePlace& place) {
  const Bvh* tree = tree_of(bvh, place.mesh);
  return tree != nullptr && place.node < tree->nodes.size();
}

// Half the area of a box whose axes a matrix has turned and stretched.
float placed_area(const Box& box, const mat4& to_world) {
  const vec3 size = extent(box);
  const vec3 x = vec3(to_world[0]) * size.x;
  const vec3 y = vec3(to_world[1]) * size.y;
  const vec3 z = vec3(to_world[2]) * size.z;
  return glm::length(glm::cross(x, y)) + glm::length(glm::cross(y, z)) +
         glm::length(glm::cross(z, x));
}

// From the root to the node. Parents come before their children.
std::vector<uint32_t> way_to(const Bvh& tree, uint32_t node) {
  std::vector<uint32_t> way = {node};
  for (uint32_t i = node; i-- > 0;) {
    const BvhNode& parent = tree.nodes[i];
    if (is_leaf(parent) || (parent.first != node && parent.first + 1 != node)) continue;
    node = i;
    way.push_back(node);
  }
  std::reverse(way.begin(), way.end());
  return way;
}

class Walk {
 public:
  Walk(const SceneBvh& bvh, const Wanted& wanted, const BoxSources& sources)
      : bvh_(bvh), wanted_(wanted), sources_(sources) {
    if (!sources.isolated || !exists(bvh, *sources.isolated)) return;
    // What is isolated in a tree that is not drawn leaves the others as they are.
    if (sources.isolated->mesh == none ? !wanted.tlas : !wanted.blases) return;
    isolated_ = sources.isolated;
    way_ = way_to(*tree_of(bvh, isolated_->mesh), isolated_->node);
    std::sort(way_.begin(), way_.end());
  }

  bool isolates() const { return isolated_.has_value(); }

  // What is reached from `level`, whose nodes are level 0.
  void down(std::vector<Walked> level, NodeBoxes& result) {
    std::erase_if(level, [&](Walked& node) { return !enters(node); });
    for (uint32_t number = 0; !level.empty(); ++number) {
      for (const Walked& node : level) {
        if (node.inside && is_wanted(node, number)) emit(node);
      }
      if (number == wanted_.last) break;
      std::vector<Walked> next;
      for (const Walked& node : level) {
        add_children(node, next);
        if (next.size() > 4 * most_followed) cut(next);
      }
      cut(next);
      level = std::move(next);
    }
    finish(result);
  }

  // These alone.
  void take(const std::vector<Walked>& nodes, NodeBoxes& result) {
    for (Walked node : nodes) {
      if (enters(node) && node.inside) emit(node);
    }
    finish(result);
  }

  Walked placed(NodePlace place, uint32_t instance, uint32_t depth, bool inside = true) const {
    const Box box = box_of(tree_of(bvh_, place.mesh)->nodes[place.node]);
    const float area =
        instance == none ? half_area(box) : placed_area(box, bvh_.instances[instance].to_world);
    return {place, instance, depth, inside, area};
  }

  void add_blas(uint32_t instance, uint32_t depth, bool inside, std::vector<Walked>& to) const {
    const uint32_t mesh = bvh_.instances[instance].mesh;
    if (exists(bvh_, {mesh, 0})) to.push_back(placed({mesh, 0}, instance, depth, inside));
  }

 private:
  bool is_wanted(const Walked& node, uint32_t level) const {
    if (level < wanted_.first || level > wanted_.last) return false;
    if (!wanted_.leaves) return true;
    const bool leaf = is_leaf(tree_of(bvh_, node.place.mesh)->nodes[node.place.node]);
    return leaf && (node.place.mesh != none || !wanted_.blases);
  }

  // Whether the node or something below it may be drawn.
  bool enters(Walked& node) const {
    const std::vector<NodePlace>& hidden = sources_.hidden;
    if (std::find(hidden.begin(), hidden.end(), node.place) != hidden.end()) return false;
    if (!isolated_) return true;
    if (node.place == *isolated_) node.inside = true;
    if (node.inside) return true;
    if (node.place.mesh == isolated_->mesh) {
      return std::binary_search(way_.begin(), way_.end(), node.place.node);
    }
    return node.place.mesh == none;  // on the way to the isolated tree
  }

  void add(Walked node, std::vector<Walked>& to) const {
    if (enters(node)) to.push_back(node);
  }

  void add_children(const Walked& parent, std::vector<Walked>& to) const {
    const Bvh& tree = *tree_of(bvh_, parent.place.mesh);
    const BvhNode& node = tree.nodes[parent.place.node];
    if (!is_leaf(node)) {
      for (uint32_t child = node.first; child < node.first + 2; ++child) {
        add(placed({parent.place.mesh, child}, parent.instance, parent.depth + 1, parent.inside),
            to);
      }
    } else if (parent.place.mesh == none && wanted_.blases) {
      for (uint32_t i = node.first; i < node.first + node.count; ++i) {
        std::vector<Walked> root;
        add_blas(tree.references[i], parent.depth + 1, parent.inside, root);
        if (!root.empty()) add(root[0], to);
      }
    }
  }

  void cut(std::vector<Walked>& nodes) {
    if (nodes.size() <= most_followed) return;
    cut_ = true;
    keep_largest(nodes, most_followed);
  }

  void emit(const Walked& node) {
    ++found_;
    boxes_.push_back(node);
    if (boxes_.size() > 8 * max_drawn_boxes) keep_largest(boxes_, max_drawn_boxes);
  }

  void finish(NodeBoxes& result) {
    keep_largest(boxes_, max_drawn_boxes);
    std::sort(boxes_.begin(), boxes_.end(), before);
    result.found = found_;
    result.at_least = cut_;
    for (const Walked& node : boxes_)
      result.boxes.push_back({node.place, node.instance, node.depth, node.area, unknown});
  }

  const SceneBvh& bvh_;
  const Wanted& wanted_;
  const BoxSources& sources_;
  std::optional<NodePlace> isolated_;
  std::vector<uint32_t> way_;  // to what is isolated, in its tree
  std::vector<Walked> boxes_;
  uint64_t found_ = 0;
  bool cut_ = false;
};

// The instances through which the selected node is seen; `none` for the TLAS.
std::vector<uint32_t> instances_of(const SceneBvh& bvh, const BoxSources& sources) {
  const uint32_t mesh = sources.selected->mesh;
  if (mesh == none) return {none};
  if (sources.instance < bvh.instances.size() && bvh.instances[sources.instance].mesh == mesh) {
    return {sources.instance};
  }
  std::vector<uint32_t> instances;
  for (uint32_t i = 0; i < bvh.instances.size() && instances.size() < max_drawn_boxes; ++i) {
    if (bvh.instances[i].mesh == mesh) instances.push_back(i);
  }
  return instances;
}

// Of the selected node's tree, and of the TLAS above it where one instance is meant.
std::vector<Walked> ancestors(const SceneBvh& bvh, const Walk& walk, const Wanted& wanted,
                              const BoxSources& sources, const std::vector<uint32_t>& instances) {
  std::vector<Walked> nodes;
  const NodePlace place = *sources.selected;
  const std::vector<uint32_t> way = way_to(*tree_of(bvh, place.mesh), place.node);
  for (const uint32_t instance : instances) {
    for (size_t i = 0; i < way.size(); ++i)
      nodes.push_back(walk.placed({place.mesh, way[i]}, instance, uint32_t(i)));
  }
  if (place.mesh == none || instances.size() != 1 || !wanted.tlas) return nodes;
  const Bvh& tlas = bvh.tlas;
  for (uint32_t leaf = 0; leaf < tlas.nodes.size(); ++leaf) {
    const BvhNode& node = tlas.nodes[leaf];
    if (!is_leaf(node)) continue;
    const auto begin = tlas.references.begin() + node.first;
    if (std::find(begin, begin + node.count, instances[0]) == begin + node.count) continue;
    const std::vector<uint32_t> above = way_to(tlas, leaf);
    for (size_t i = 0; i < above.size(); ++i)
      nodes.push_back(walk.placed({none, above[i]}, none, uint32_t(i)));
    break;
  }
  return nodes;
}

void collect_selected(const SceneBvh& bvh, const Wanted& wanted, const BoxSources& sources,
                      Walk& walk, NodeBoxes& result) {
  if (!sources.selected || !exists(bvh, *sources.selected)) return;
  const std::vector<uint32_t> instances = instances_of(bvh, sources);
  const std::vector<uint32_t> way =
      way_to(*tree_of(bvh, sources.selected->mesh), sources.selected->node);
  if (wanted.set.id == "ancestors") {
    walk.take(ancestors(bvh, walk, wanted, sources, instances), result);
    return;
  }
  std::vector<Walked> start;
  for (const uint32_t instance : instances)
    start.push_back(walk.placed(*sources.selected, instance, uint32_t(way.size() - 1)));
  walk.down(std::move(start), result);
}

void collect_all(const SceneBvh& bvh, const Wanted& wanted, Walk& walk, NodeBoxes& result) {
  const bool inside = !walk.isolates();
  std::vector<Walked> start;
  if (wanted.tlas) {
    if (exists(bvh, {none, 0})) start.push_back(walk.placed({none, 0}, none, 0, inside));
  } else {
    for (uint32_t i = 0; i < bvh.instances.size(); ++i)
      walk.add_blas(i, 0, inside, start);
  }
  walk.down(std::move(start), result);
}

Wanted wanted_by(const BoxOptions& options) {
  const BoxSetRow* set = find_row(box_sets(), options.what);
  if (set == nullptr) set = &sets[0];
  Wanted wanted{*set,
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

// The nodes of a tree by depth.
std::vector<uint64_t> census(const Bvh& tree, bool leaves) {
  std::vector<uint64_t> counts(size_t(max_box_level) + 1, 0);
  std::vector<uint8_t> depth(tree.nodes.size(), 0);
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const BvhNode& node = tree.nodes[i];
    if (!leaves || is_leaf(node)) ++counts[depth[i]];
    if (is_leaf(node)) continue;
    depth[node.first] = depth[node.first + 1] = uint8_t(depth[i] + 1);
  }
  return counts;
}

// How many boxes of levels or leaves there are. Linear in the nodes of all trees.
uint64_t count_all(const SceneBvh& bvh, const Wanted& wanted) {
  const auto part = [&](const std::vector<uint64_t>& counts, uint32_t root_level) {
    uint64_t sum = 0;
    for (uint32_t depth = 0; depth < counts.size(); ++depth) {
      const uint32_t level = depth + root_level;
      if (level >= wanted.first && level <= wanted.last) sum += counts[depth];
    }
    return sum;
  };
  uint64_t sum = 0;
  if (wanted.tlas && !(wanted.leaves && wanted.blases))
    sum += part(census(bvh.tlas, wanted.leaves), 0);
  if (!wanted.blases) return sum;
  std::vector<uint32_t> root_levels(bvh.instances.size(), 0);  // by instance
  if (wanted.tlas) {
    std::vector<uint32_t> level(bvh.tlas.nodes.size(), 0);
    for (size_t i = 0; i < bvh.tlas.nodes.size(); ++i) {
      const BvhNode& node = bvh.tlas.nodes[i];
      if (!is_leaf(node)) {
        level[node.first] = level[node.first + 1] = level[i] + 1;
        continue;
      }
      for (uint32_t j = node.first; j < node.first + node.count; ++j)
        root_levels[bvh.tlas.references[j]] = level[i] + 1;
    }
  }
  std::map<std::pair<uint32_t, uint32_t>, uint64_t> instances;  // by mesh and level of its root
  for (size_t i = 0; i < bvh.instances.size(); ++i)
    ++instances[{bvh.instances[i].mesh, root_levels[i]}];
  std::vector<uint64_t> counts;
  uint32_t counted = none;
  for (const auto& [place, number] : instances) {
    if (place.first != counted) {
      counted = place.first;
      counts = census(bvh.blases[counted]->tree, wanted.leaves);
    }
    sum += number * part(counts, place.second);
  }
  return sum;
}

void share(const SceneBvh& bvh, const BoxSources& sources, NodeBoxes& result) {
  if (!sources.selected || !exists(bvh, *sources.selected)) return;
  const Bvh& tree = *tree_of(bvh, sources.selected->mesh);
  const BvhNode& node = tree.nodes[sources.selected->node];
  if (is_leaf(node)) return;
  const Box box = common(box_of(tree.nodes[node.first]), box_of(tree.nodes[node.first + 1]));
  if (is_empty(box)) return;
  for (const uint32_t instance : instances_of(bvh, sources))
    result.shared.push_back({box, instance});
}

// What the measure says of each box; the figures of a tree are made once.
void fill_values(const BoxOptions& options, const BoxSources& sources, NodeBoxes& result) {
  const NodeMeasureRow* measure = find_row(node_measures(), options.color);
  if (measure == nullptr) measure = &node_measures()[0];
  std::map<uint32_t, NodeFigures> figures;
  const RayClassRow* ray_class = find_row(ray_classes(), options.ray_class);
  const int index = ray_class == nullptr ? ray_class_count : int(ray_class - ray_classes().data());
  std::shared_ptr<const Inspection> inspection = sources.inspection;
  const bool of_depth = measure->id == "depth";
  if (!of_depth && (!inspection || inspection->bvh != result.bvh)) {
    inspection = std::make_shared<const Inspection>(inspect(result.bvh, inspection.get(), {}));
  }
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
  return options.color == "visits" || options.color == "observed";
}
bool needs_measures(const BoxOptions& options) {
  return options.color == "epo";
}

BoxSources needed(const BoxOptions& options, BoxSources sources) {
  if (!needs_visits(options)) sources.visits.reset();
  if (!needs_measures(options)) sources.measures.reset();
  if (options.color == "depth") sources.inspection.reset();
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
  const Wanted wanted = wanted_by(options);
  Walk walk(*bvh, wanted, sources);
  if (wanted.set.of_selected) {
    collect_selected(*bvh, wanted, sources, walk, result);
  } else {
    collect_all(*bvh, wanted, walk, result);
    if (result.at_least && !sources.isolated && sources.hidden.empty()) {
      result.found = count_all(*bvh, wanted);
      result.at_least = false;
    }
  }
  if (options.sibling_overlap) share(*bvh, sources, result);
  fill_values(options, sources, result);
  return result;
}

bool is_of(const NodeBoxes& boxes, const std::shared_ptr<const SceneBvh>& bvh,
           const BoxOptions& options, const BoxSources& sources) {
  return boxes.bvh == bvh && boxes.options == choosing(options) &&
         boxes.sources == needed(options, sources);
}

}  // namespace tracer
