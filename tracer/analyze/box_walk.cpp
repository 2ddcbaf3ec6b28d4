// Walks down the trees, level by level, the largest nodes first where there are too many.
#include "tracer/analyze/box_walk.h"

#include <algorithm>
#include <compare>
#include <limits>
#include <map>
#include <tuple>

namespace tracer {
namespace {

constexpr size_t most_followed = 1 << 16;  // nodes of a level
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

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
  Walk(const PlacedTrees& trees, const WantedBoxes& wanted, const BoxSources& sources)
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
    const std::span<const uint32_t> instances = trees_.references(parent.place);
    for (size_t i = 0; i < instances.size(); ++i)
      add_entry(instances[i], trees_.entry(parent.place, i), depth, parent.inside, to);
  }

  // A node of a BLAS where rays begin, unless something above it in its tree is left out.
  void add_entry(uint32_t instance, uint32_t node, uint32_t depth, bool inside,
                 std::vector<Walked>& to) const {
    const uint32_t mesh = trees_.bvh.instances[instance].mesh;
    if (!trees_.has({mesh, node})) return;
    Walked walked;
    for (const uint32_t above : path_to(*trees_.table(mesh), node)) {
      walked = placed({mesh, above}, instance, depth, inside);
      if (!enters(walked)) return;
      inside = walked.inside;
    }
    to.push_back(walked);
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

  const PlacedTrees& trees_;
  const WantedBoxes& wanted_;
  const BoxSources& sources_;
  std::optional<NodePlace> isolated_;
  std::vector<uint32_t> way_;  // to what is isolated, in its tree
  std::vector<Walked> boxes_;
  uint64_t found_ = 0;
  bool cut_ = false;
};

// Of the selected node's tree, and of the TLAS above it where one instance is meant.
std::vector<Walked> ancestors(const PlacedTrees& trees, const Walk& walk, const WantedBoxes& wanted,
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

void collect_selected(const PlacedTrees& trees, const WantedBoxes& wanted,
                      const BoxSources& sources, Walk& walk, NodeBoxes& result) {
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

void collect_all(const PlacedTrees& trees, const WantedBoxes& wanted, Walk& walk,
                 NodeBoxes& result) {
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

// What is below a node of a tree, by the depth below it.
std::vector<uint64_t> census(const TreeTable& table, uint32_t top, bool leaves) {
  std::vector<uint64_t> counts(size_t(max_box_level) + 1, 0);
  std::vector<uint32_t> stack;
  if (top < table.nodes.size()) stack.push_back(top);
  while (!stack.empty()) {
    const uint32_t index = stack.back();
    stack.pop_back();
    const TableNode& node = table.nodes[index];
    if (!leaves || is_leaf(node)) ++counts[node.depth - table.nodes[top].depth];
    for (const uint32_t child : children_of(table, index))
      stack.push_back(child);
  }
  return counts;
}

// How many boxes of levels or leaves there are. Linear in the nodes of all trees.
uint64_t count_all(const PlacedTrees& trees, const WantedBoxes& wanted) {
  const auto part = [&](const std::vector<uint64_t>& counts, uint32_t first_level) {
    uint64_t sum = 0;
    for (uint32_t depth = 0; depth < counts.size(); ++depth) {
      const uint32_t level = depth + first_level;
      if (level >= wanted.first && level <= wanted.last) sum += counts[depth];
    }
    return sum;
  };
  const TreeTable& tlas = *trees.table(none);
  const std::vector<PlacedInstance>& instances = trees.bvh.instances;
  uint64_t sum = 0;
  if (wanted.tlas && !(wanted.leaves && wanted.blases))
    sum += part(census(tlas, 0, wanted.leaves), 0);
  if (!wanted.blases) return sum;
  struct Entry {
    uint32_t mesh, node, level;
    auto operator<=>(const Entry&) const = default;
  };
  std::map<Entry, uint64_t> placed;  // how often
  if (!wanted.tlas) {
    for (const PlacedInstance& instance : instances)
      ++placed[{instance.mesh, 0, 0}];
  }
  for (uint32_t leaf = 0; wanted.tlas && leaf < tlas.nodes.size(); ++leaf) {
    if (!is_leaf(tlas.nodes[leaf])) continue;
    const std::span<const uint32_t> references = trees.references({none, leaf});
    for (size_t i = 0; i < references.size(); ++i) {
      ++placed[{instances[references[i]].mesh, trees.entry({none, leaf}, i),
                tlas.nodes[leaf].depth + 1u}];
    }
  }
  std::vector<uint64_t> counts;
  NodePlace counted;
  for (const auto& [entry, number] : placed) {
    const NodePlace top = {entry.mesh, entry.node};
    if (top != counted) {
      counted = top;
      counts = census(*trees.table(entry.mesh), entry.node, wanted.leaves);
    }
    sum += number * part(counts, entry.level);
  }
  return sum;
}

}  // namespace

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

void collect(const PlacedTrees& trees, const WantedBoxes& wanted, const BoxSources& sources,
             NodeBoxes& result) {
  Walk walk(trees, wanted, sources);
  if (wanted.set.of_selected) {
    collect_selected(trees, wanted, sources, walk, result);
    return;
  }
  collect_all(trees, wanted, walk, result);
  if (result.at_least && !sources.isolated && sources.hidden.empty()) {
    result.found = count_all(trees, wanted);
    result.at_least = false;
  }
}

}  // namespace tracer
