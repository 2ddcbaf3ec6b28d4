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

// The trees as the layout has them, and where they stand.
struct Trees {
  const SceneBvh& bvh;
  const Inspection& inspection;

  const TreeTable* table(uint32_t mesh) const { return table_of(inspection, mesh); }
  bool has(const NodePlace& place) const {
    const TreeTable* of = table(place.mesh);
    return of != nullptr && place.node < of->nodes.size();
  }
  const TableNode& node(const NodePlace& place) const {
    return table(place.mesh)->nodes[place.node];
  }
  std::span<const uint32_t> children(const NodePlace& place) const {
    return children_of(*table(place.mesh), place.node);
  }
  std::span<const uint32_t> references(const NodePlace& leaf) const {
    const TableNode& row = node(leaf);
    return {table(leaf.mesh)->references.data() + row.first, row.references};
  }
};

// Half the area of a box whose axes a matrix has turned and stretched.
float placed_area(const Box& box, const mat4& to_world) {
  const vec3 size = extent(box);
  const vec3 x = vec3(to_world[0]) * size.x;
  const vec3 y = vec3(to_world[1]) * size.y;
  const vec3 z = vec3(to_world[2]) * size.z;
  return glm::length(glm::cross(x, y)) + glm::length(glm::cross(y, z)) +
         glm::length(glm::cross(z, x));
}

class Walk {
 public:
  Walk(const Trees& trees, const Wanted& wanted, const BoxSources& sources)
      : trees_(trees), wanted_(wanted), sources_(sources) {
    if (!sources.isolated || !trees.has(*sources.isolated)) return;
    // What is isolated in a tree that is not drawn leaves the others as they are.
    if (sources.isolated->mesh == none ? !wanted.tlas : !wanted.blases) return;
    isolated_ = sources.isolated;
    way_ = path_to(*trees.table(isolated_->mesh), isolated_->node);
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
    const Box& box = trees_.node(place).box;
    const float area = instance == none ? half_area(box)
                                        : placed_area(box, trees_.bvh.instances[instance].to_world);
    return {place, instance, depth, inside, area};
  }

  void add_blas(uint32_t instance, uint32_t depth, bool inside, std::vector<Walked>& to) const {
    const uint32_t mesh = trees_.bvh.instances[instance].mesh;
    if (trees_.has({mesh, 0})) to.push_back(placed({mesh, 0}, instance, depth, inside));
  }

 private:
  bool is_wanted(const Walked& node, uint32_t level) const {
    if (level < wanted_.first || level > wanted_.last) return false;
    if (!wanted_.leaves) return true;
    return is_leaf(trees_.node(node.place)) && (node.place.mesh != none || !wanted_.blases);
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
    const uint32_t depth = parent.depth + 1;
    for (const uint32_t child : trees_.children(parent.place))
      add(placed({parent.place.mesh, child}, parent.instance, depth, parent.inside), to);
    if (parent.place.mesh != none || !wanted_.blases || !is_leaf(trees_.node(parent.place))) return;
    for (const uint32_t instance : trees_.references(parent.place)) {
      std::vector<Walked> root;
      add_blas(instance, depth, parent.inside, root);
      if (!root.empty()) add(root[0], to);
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
      result.boxes.push_back(
          {node.place, trees_.node(node.place).box, node.instance, node.depth, node.area, unknown});
  }

  const Trees& trees_;
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
std::vector<Walked> ancestors(const Trees& trees, const Walk& walk, const Wanted& wanted,
                              const NodePlace& place, const std::vector<uint32_t>& instances) {
  std::vector<Walked> nodes;
  const auto append = [&](const NodePlace& last, uint32_t instance) {
    const std::vector<uint32_t> way = path_to(*trees.table(last.mesh), last.node);
    for (size_t i = 0; i < way.size(); ++i)
      nodes.push_back(walk.placed({last.mesh, way[i]}, instance, uint32_t(i)));
  };
  for (const uint32_t instance : instances)
    append(place, instance);
  if (place.mesh == none || instances.size() != 1 || !wanted.tlas) return nodes;
  const std::vector<uint32_t> leaves = leaves_of(*trees.table(none), instances[0]);
  if (!leaves.empty()) append({none, leaves[0]}, none);
  return nodes;
}

void collect_selected(const Trees& trees, const Wanted& wanted, const BoxSources& sources,
                      Walk& walk, NodeBoxes& result) {
  if (!sources.selected || !trees.has(*sources.selected)) return;
  const std::vector<uint32_t> instances = instances_of(trees.bvh, sources);
  if (wanted.set.id == "ancestors") {
    walk.take(ancestors(trees, walk, wanted, *sources.selected, instances), result);
    return;
  }
  const uint32_t depth = trees.node(*sources.selected).depth;
  std::vector<Walked> start;
  start.reserve(instances.size());
  for (const uint32_t instance : instances)
    start.push_back(walk.placed(*sources.selected, instance, depth));
  walk.down(std::move(start), result);
}

void collect_all(const Trees& trees, const Wanted& wanted, Walk& walk, NodeBoxes& result) {
  const bool inside = !walk.isolates();
  std::vector<Walked> start;
  if (wanted.tlas) {
    if (trees.has({none, 0})) start.push_back(walk.placed({none, 0}, none, 0, inside));
  } else {
    for (uint32_t i = 0; i < trees.bvh.instances.size(); ++i)
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
std::vector<uint64_t> census(const TreeTable& table, bool leaves) {
  std::vector<uint64_t> counts(size_t(max_box_level) + 1, 0);
  for (const TableNode& node : table.nodes) {
    if (node.in_layout && (!leaves || is_leaf(node))) ++counts[node.depth];
  }
  return counts;
}

// How many boxes of levels or leaves there are. Linear in the nodes of all trees.
uint64_t count_all(const Trees& trees, const Wanted& wanted) {
  const auto part = [&](const std::vector<uint64_t>& counts, uint32_t root_level) {
    uint64_t sum = 0;
    for (uint32_t depth = 0; depth < counts.size(); ++depth) {
      const uint32_t level = depth + root_level;
      if (level >= wanted.first && level <= wanted.last) sum += counts[depth];
    }
    return sum;
  };
  const TreeTable& tlas = *trees.table(none);
  const std::vector<PlacedInstance>& instances = trees.bvh.instances;
  uint64_t sum = 0;
  if (wanted.tlas && !(wanted.leaves && wanted.blases)) sum += part(census(tlas, wanted.leaves), 0);
  if (!wanted.blases) return sum;
  std::vector<uint32_t> root_levels(instances.size(), 0);  // by instance
  for (uint32_t leaf = 0; wanted.tlas && leaf < tlas.nodes.size(); ++leaf) {
    if (!is_leaf(tlas.nodes[leaf])) continue;
    for (const uint32_t instance : trees.references({none, leaf}))
      root_levels[instance] = tlas.nodes[leaf].depth + 1u;
  }
  std::map<std::pair<uint32_t, uint32_t>, uint64_t> placed;  // by mesh and level of its root
  for (size_t i = 0; i < instances.size(); ++i)
    ++placed[{instances[i].mesh, root_levels[i]}];
  std::vector<uint64_t> counts;
  uint32_t counted = none;
  for (const auto& [place, number] : placed) {
    if (place.first != counted) {
      counted = place.first;
      counts = census(*trees.table(counted), wanted.leaves);
    }
    sum += number * part(counts, place.second);
  }
  return sum;
}

// Of each two children of the selected node, for each instance.
void share(const Trees& trees, const BoxSources& sources, NodeBoxes& result) {
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
  return options.color == "visits" || options.color == "observed";
}
bool needs_measures(const BoxOptions& options) {
  return options.color == "epo";
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
  const Wanted wanted = wanted_by(options);
  std::shared_ptr<const Inspection> inspection = sources.inspection;
  if (!inspection || inspection->bvh != bvh) {
    inspection = std::make_shared<const Inspection>(inspect(bvh, inspection.get(), {}));
  }
  const Trees trees{*bvh, *inspection};
  BoxSources led = sources;  // to the nodes that the layout has
  for (std::optional<NodePlace>* place : {&led.selected, &led.isolated}) {
    if (*place && trees.has(**place))
      (*place)->node = holder(*trees.table((*place)->mesh), (*place)->node);
  }
  Walk walk(trees, wanted, led);
  if (wanted.set.of_selected) {
    collect_selected(trees, wanted, led, walk, result);
  } else {
    collect_all(trees, wanted, walk, result);
    if (result.at_least && !led.isolated && led.hidden.empty()) {
      result.found = count_all(trees, wanted);
      result.at_least = false;
    }
  }
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
