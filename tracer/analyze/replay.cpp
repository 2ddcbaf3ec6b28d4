// A build, step by step.
#include "tracer/analyze/replay.h"

#include <algorithm>
#include <bit>
#include <queue>
#include <tuple>

#include <tbb/parallel_sort.h>

#include "tracer/bvh/rebraid.h"
#include "tracer/choice.h"

namespace tracer {
namespace {

const Bvh& tree_of(const Replay& replay) {
  return replay.mesh == none ? replay.bvh->tlas : replay.bvh->blases[replay.mesh]->tree;
}

bool was_refitted(const SceneBvh& bvh, uint32_t mesh) {
  return mesh != none && bvh.blases[mesh]->built_areas != nullptr;
}

// The build of that tree once more; no nodes if it was stopped.
BuildSteps logged_build(const SceneBvh& bvh, uint32_t mesh, const Mesh* built_over,
                        const Job& job) {
  BuildSteps steps;
  BuildLog log;
  log.steps = &steps;
  if (mesh != none) {
    build_blas(*built_over, bvh.options, &log, job.stop);
  } else {
    build({tlas_input(bvh).boxes}, bvh.options, &log, job.stop);
  }
  if (job.stopped()) steps = {};
  return steps;
}

BuildSteps splits_of(const Bvh& tree) {
  BuildSteps steps;
  steps.nodes.assign(tree.nodes.begin(), tree.nodes.end());
  record_splits(steps, tree);
  return steps;
}

// Children come after their parents, in both kinds of trees.
std::vector<uint32_t> references_below(std::span<const BvhNode> nodes) {
  std::vector<uint32_t> references(nodes.size());
  for (size_t i = nodes.size(); i-- > 0;) {
    const BvhNode& node = nodes[i];
    references[i] =
        is_leaf(node) ? node.count : references[node.first] + references[node.first + 1];
  }
  return references;
}

// Equal for nodes with the same box and as much below them.
using Content = std::array<uint32_t, 7>;
Content content(const BvhNode& node, uint32_t references) {
  Content key{references};
  for (int axis = 0; axis < 3; ++axis) {
    key[1 + axis] = std::bit_cast<uint32_t>(node.lo[axis]);
    key[4 + axis] = std::bit_cast<uint32_t>(node.hi[axis]);
  }
  return key;
}

// For each node of `nodes` the one of `tree` with the same content: of several the first that is
// left, so that the order of both trees decides.
std::vector<uint32_t> same_nodes(std::span<const BvhNode> nodes,
                                 std::span<const uint32_t> references, const Bvh& tree) {
  struct Known {
    Content content;
    uint32_t node = 0;
    bool operator<(const Known& other) const {
      return std::tie(content, node) < std::tie(other.content, other.node);
    }
  };
  const auto sorted = [](std::span<const BvhNode> of, std::span<const uint32_t> below) {
    std::vector<Known> known(of.size());
    for (uint32_t i = 0; i < of.size(); ++i)
      known[i] = {content(of[i], below[i]), i};
    tbb::parallel_sort(known);
    return known;
  };
  const std::vector<Known> here = sorted(nodes, references);
  const std::vector<Known> there = sorted(tree.nodes, references_below(tree.nodes));
  std::vector<uint32_t> same(nodes.size(), none);
  for (auto a = here.begin(), b = there.begin(); a != here.end() && b != there.end();) {
    if (a->content == b->content) {
      same[(a++)->node] = (b++)->node;
    } else if (a->content < b->content) {
      ++a;
    } else {
      ++b;
    }
  }
  return same;
}

// In units of the costs.
struct Costs {
  double root = 0.0;  // half its area; 0: as if every node were as large as the root
  double traversal = 0.0, intersection = 0.0;

  double share(double half_area) const { return root > 0.0 ? half_area / root : 1.0; }
  double of_inner(const BvhNode& node) const { return share(half_area(box_of(node))) * traversal; }
  double of_leaf(const BvhNode& node, uint32_t references) const {
    return share(half_area(box_of(node))) * double(references) * intersection;
  }
};

double whole_cost(const Costs& costs, const Bvh& tree) {
  double cost = 0.0;
  for (const BvhNode& node : tree.nodes)
    cost += is_leaf(node) ? costs.of_leaf(node, node.count) : costs.of_inner(node);
  return cost;
}

void add_costs(Replay& replay) {
  const std::vector<BvhNode>& nodes = replay.log.nodes;
  const Costs costs{half_area(box_of(nodes[0])), replay.bvh->options.traversal_cost,
                    replay.bvh->options.intersection_cost};
  const auto as_leaf = [&](uint32_t node) {
    return costs.of_leaf(nodes[node], replay.references[node]);
  };
  double cost = 0.0;
  if (replay.bottom_up) {
    // Each ray tests each root: a pair of boxes is half a step.
    cost = 0.5 * costs.traversal * double(replay.log.order.size());
    for (uint32_t i = 0; i < nodes.size(); ++i)
      cost += is_leaf(nodes[i]) ? as_leaf(i) : 0.0;
  } else {
    cost = as_leaf(0);
  }
  const auto note = [&] { replay.sah.push_back(float(cost)); };
  note();
  for (const uint32_t node : replay.log.order) {
    cost += costs.of_inner(nodes[node]);
    if (replay.bottom_up) {
      cost -= 0.5 * costs.traversal;
    } else {
      const uint32_t pair = nodes[node].first;
      cost += as_leaf(pair) + as_leaf(pair + 1) - as_leaf(node);
    }
    note();
  }
  for (const TreeMove& move : replay.log.moves) {
    if (costs.root > 0.0) cost -= costs.traversal * double(move.saved) / costs.root;
    note();
  }
  if (!replay.finishes) return;
  const Bvh& tree = tree_of(replay);
  cost = whole_cost({half_area(box_of(tree.nodes[0])), costs.traversal, costs.intersection}, tree);
  note();
}

constexpr size_t most_opened = 10'000;  // nodes, to find boxes below them

std::optional<Round> round_in(std::span<const uint32_t> rounds, size_t place) {
  const auto after = std::upper_bound(rounds.begin(), rounds.end(), place);
  if (after == rounds.end()) return {};
  return Round{uint32_t(after - rounds.begin()) + 1, uint32_t(rounds.size())};
}

}  // namespace

Replay replay_build(std::shared_ptr<const SceneBvh> bvh, uint32_t mesh, const Mesh* built_over,
                    const Job& job) {
  Replay result;
  result.mesh = mesh;
  const BuilderRow* builder = find_row(builders(), bvh->options.builder);
  result.bottom_up = builder != nullptr && builder->traits.bottom_up;
  const bool is_optimized = bvh->options.optimizer != "none";
  const bool refitted = was_refitted(*bvh, mesh);
  result.bvh = std::move(bvh);
  const Bvh& tree = tree_of(result);
  if (tree.nodes.empty()) {
    result.sah = {0.0f};
    return result;
  }
  job.progress(0.0f, "building again, with a log");
  const bool again = (result.bottom_up || is_optimized) && (mesh == none || built_over != nullptr);
  result.log = again ? logged_build(*result.bvh, mesh, built_over, job) : splits_of(tree);
  if (job.stopped()) return {};
  const BuildSteps& log = result.log;
  result.finishes = again && (log.finished_later || log.moves_left_out > 0 || refitted);
  result.references = references_below(log.nodes);
  result.same = same_nodes(log.nodes, result.references, tree);
  result.step_of.assign(log.nodes.size(), none);
  for (uint32_t step = 0; step < log.order.size(); ++step)
    result.step_of[log.order[step]] = step;
  add_costs(result);
  return result;
}

BuildStep kind_of(const Replay& replay, size_t step) {
  const size_t built = replay.log.order.size();
  if (step < built) return replay.bottom_up ? BuildStep::merge : BuildStep::split;
  if (step - built >= replay.log.moves.size()) return BuildStep::finish;
  const OptimizerRow* optimizer = find_row(optimizers(), replay.bvh->options.optimizer);
  return optimizer != nullptr && optimizer->reinserts ? BuildStep::reinsertion
                                                      : BuildStep::rotation;
}

const TreeMove* move_of(const Replay& replay, size_t step) {
  const size_t built = replay.log.order.size();
  if (step < built || step - built >= replay.log.moves.size()) return nullptr;
  return &replay.log.moves[step - built];
}

uint32_t node_of(const Replay& replay, size_t step) {
  return step < replay.log.order.size() ? replay.log.order[step] : none;
}

std::optional<Round> round_of(const Replay& replay, size_t step) {
  const size_t built = replay.log.order.size();
  if (step < built) return round_in(replay.log.rounds, step);
  return round_in(replay.log.move_rounds, step - built);
}

uint32_t box_count(const Replay& replay, size_t steps) {
  const size_t built = replay.log.order.size();
  if (steps > built && replay.finishes && steps == step_count(replay)) {
    return uint32_t(tree_of(replay).nodes.size() / 2 + 1);
  }
  if (replay.bottom_up && steps <= built) return uint32_t(built + 1 - steps);
  return uint32_t(std::min(steps, built) + 1);
}

std::vector<Box> boxes_after(const Replay& replay, size_t steps, size_t most) {
  std::vector<Box> boxes;
  const size_t built = replay.log.order.size();
  const bool finished = replay.finishes && steps == step_count(replay);
  // Moves leave the leaves where they are.
  const std::span<const BvhNode> nodes =
      finished ? std::span<const BvhNode>(tree_of(replay).nodes) : replay.log.nodes;
  const bool merging = replay.bottom_up && steps <= built;
  const auto is_shown = [&](uint32_t node) {
    if (is_leaf(nodes[node])) return true;
    if (finished || steps > built) return false;
    return merging == (replay.step_of[node] < steps);
  };
  struct Waiting {
    float area = 0.0f;
    uint32_t node = 0;
    bool operator<(const Waiting& other) const {
      return area != other.area ? area < other.area : node > other.node;
    }
  };
  // What is inside a box is no larger.
  std::priority_queue<Waiting> waiting;
  const auto wait = [&](uint32_t node) { waiting.push({half_area(box_of(nodes[node])), node}); };
  if (!nodes.empty()) wait(0);
  size_t opened = 0;
  while (!waiting.empty() && boxes.size() < most && opened < most_opened) {
    const uint32_t node = waiting.top().node;
    waiting.pop();
    if (is_shown(node)) {
      boxes.push_back(box_of(nodes[node]));
    } else {
      wait(nodes[node].first);
      wait(nodes[node].first + 1);
      ++opened;
    }
  }
  for (; !waiting.empty() && boxes.size() < most; waiting.pop()) {
    const uint32_t node = waiting.top().node;
    if (is_shown(node)) boxes.push_back(box_of(nodes[node]));
  }
  return boxes;
}

double gain_of(const Replay& replay, size_t step) {
  return double(replay.sah[step]) - double(replay.sah[step + 1]);
}

}  // namespace tracer
