// Parallel reinsertion (D. Meister, J. Bittner, Parallel Reinsertion for Bounding Volume Hierarchy
// Optimization, 2018): the largest nodes look for the place where putting them back would lower the
// sum of areas most, all at once and without changing the tree; then the moves that do not touch
// each other are made, best first. Where we differ: candidates are the largest share of all nodes
// instead of every k-th, and a node that finds no better place rests for some rounds.
#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include "tracer/bvh/build_parts.h"
#include "tracer/bvh/build_steps.h"
#include "tracer/bvh/optimizers.h"
#include "tracer/bvh/tree_edit.h"

namespace tracer {

namespace {

constexpr uint32_t min_candidates = 32;
constexpr uint32_t rest_rounds = 2;

struct Move {
  uint32_t node = 0, to = 0;
  float gain = 0.0f;  // of half area; 0: stay
};

class Optimizer {
 public:
  Optimizer(Bvh& bvh, float share, BuildSteps* steps)
      : share_(share),
        steps_(steps),
        nodes_(bvh.nodes.begin(), bvh.nodes.end()),
        parents_(nodes_.size()),
        awake_(nodes_.size()) {
    areas_.resize(nodes_.size());
    tbb::parallel_for(uint32_t{0}, static_cast<uint32_t>(nodes_.size()), [&](uint32_t i) {
      areas_[i] = half_area(box_of(nodes_[i]));
      if (is_leaf(nodes_[i])) return;
      parents_[nodes_[i].first] = parents_[nodes_[i].first + 1] = i;
    });
  }

  // False: nothing was gained for as long as nodes rest.
  bool round() {
    ++round_;
    std::vector<Move> moves = find_moves();
    std::erase_if(moves, [](const Move& move) { return move.gain <= 0.0f; });
    if (!moves.empty()) gained_ = round_;
    tbb::parallel_sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) {
      return a.gain != b.gain ? a.gain > b.gain : a.node < b.node;
    });
    std::vector<uint8_t> touched(nodes_.size());
    for (const Move& move : moves) {
      const std::array<uint32_t, 5> used{move.to, move.node, sibling(move.node), parents_[move.to],
                                         parents_[move.node]};
      if (std::any_of(used.begin(), used.end(), [&](uint32_t i) { return touched[i]; })) continue;
      // An earlier move may have brought the target below the node.
      if (is_below(move.to, move.node)) continue;
      for (const uint32_t i : used) {
        touched[i] = 1;
        awake_[i] = 0;
      }
      if (steps_) {
        make_and_record(move);
      } else {
        make(move);
      }
    }
    if (steps_) steps_->move_rounds.push_back(static_cast<uint32_t>(steps_->moves.size()));
    return round_ - gained_ < rest_rounds;
  }

  std::span<const BvhNode> nodes() const { return nodes_; }

 private:
  struct Waiting {
    float saved;  // by taking the node out, less what the way down to here and this would grow
    uint32_t node;
  };

  static uint32_t sibling(uint32_t node) { return ((node - 1) ^ 1) + 1; }

  std::vector<Move> find_moves() {
    const std::vector<uint32_t> candidates = largest();
    std::vector<Move> moves(candidates.size());
    tbb::enumerable_thread_specific<std::vector<Waiting>> stacks;
    tbb::parallel_for(size_t{0}, candidates.size(), [&](size_t i) {
      moves[i] = find(candidates[i], stacks.local());
      if (moves[i].gain <= 0.0f) awake_[candidates[i]] = round_ + rest_rounds + 1;
    });
    return moves;
  }

  // A share of all nodes, if so many are awake.
  std::vector<uint32_t> largest() const {
    const auto count = static_cast<uint32_t>(nodes_.size());
    // Only nodes above a step of the areas, which has enough of them, need be put in order.
    constexpr int ignored_bits = 20;  // a step is an eighth of an octave
    const auto step = [&](uint32_t node) {
      return std::bit_cast<uint32_t>(areas_[node]) >> ignored_bits;
    };
    std::vector<uint32_t> counts(1u << (32 - ignored_bits));
    uint32_t awake = 0;
    for (uint32_t node = 1; node < count; ++node) {
      if (awake_[node] > round_) continue;
      ++counts[step(node)];
      ++awake;
    }
    const auto share = static_cast<uint32_t>(share_ * static_cast<float>(count));
    const uint32_t wanted = std::min(std::max(share, min_candidates), awake);
    auto least = static_cast<uint32_t>(counts.size());
    for (uint32_t found = 0; found < wanted;)
      found += counts[--least];
    std::vector<uint32_t> nodes;
    for (uint32_t node = 1; node < count; ++node) {
      if (step(node) >= least && awake_[node] <= round_) nodes.push_back(node);
    }
    std::nth_element(nodes.begin(), nodes.begin() + wanted, nodes.end(),
                     [&](uint32_t a, uint32_t b) {
                       return areas_[a] != areas_[b] ? areas_[a] > areas_[b] : a < b;
                     });
    nodes.resize(wanted);
    return nodes;
  }

  // Branch and bound: the search climbs to the root and looks into the subtree beside each step.
  Move find(uint32_t node, std::vector<Waiting>& stack) const {
    Move best{node, 0, 0.0f};
    const uint32_t parent = parents_[node];
    if (parent == 0) return best;
    const Bounds box = bounds_of(nodes_[node]);
    const float area = areas_[node];
    Bounds rest = bounds_of(nodes_[sibling(node)]);  // of the ancestor climbed to, without the node
    float saved = areas_[parent];
    uint32_t pivot = parent, beside = sibling(node);
    // Takes the place beside a node if it is the best one; returns what is saved by the way down to
    // the node's children.
    const auto look = [&](float before, uint32_t at) {
      const BvhNode& place = nodes_[at];
      Bounds both = bounds_of(place);
      both.grow(box);
      const float gain = before - half_area(both);
      if (gain > best.gain && at != sibling(node)) best = {node, at, gain};
      return is_leaf(place) ? -infinity : gain + areas_[at];
    };
    while (true) {
      if (saved - area > best.gain) {
        stack.push_back({look(saved, beside), beside});
        while (!stack.empty()) {
          const Waiting here = stack.back();
          stack.pop_back();
          if (!(here.saved - area > best.gain)) continue;  // nor where an area is not a number
          const uint32_t child = nodes_[here.node].first;
          Waiting left{look(here.saved, child), child};
          Waiting right{look(here.saved, child + 1), child + 1};
          if (left.saved > right.saved) std::swap(left, right);
          if (left.saved - area > best.gain) stack.push_back(left);
          if (right.saved - area > best.gain) stack.push_back(right);
        }
      }
      if (pivot != parent) {
        rest.grow(bounds_of(nodes_[beside]));
        saved += areas_[pivot] - half_area(rest);
      }
      if (pivot == 0) return best;
      beside = sibling(pivot);
      pivot = parents_[pivot];
    }
  }

  // The fourth lanes mean nothing.
  static Bounds bounds_of(const BvhNode& node) { return {load4(&node.lo.x), load4(&node.hi.x)}; }

  bool is_below(uint32_t node, uint32_t ancestor) const {
    while (node != 0 && node != ancestor)
      node = parents_[node];
    return node == ancestor;
  }

  // The pair of the node and its sibling gets free where it stands and serves at the new place.
  void make(const Move& move) {
    const uint32_t from = parents_[move.node];
    const uint32_t kept = sibling(move.node);
    const uint32_t pair = std::min(move.node, kept);
    const BvhNode node = nodes_[move.node];
    put(from, nodes_[kept]);
    const BvhNode target = nodes_[move.to];
    put(pair, node);
    put(pair + 1, target);
    parents_[pair] = parents_[pair + 1] = move.to;
    nodes_[move.to].first = pair;
    nodes_[move.to].count = 0;
    refit(move.to);
    refit(parents_[from]);
  }

  void make_and_record(const Move& move) {
    TreeMove made{box_of(nodes_[move.node]), box_of(nodes_[move.to]),
                  box_of(nodes_[sibling(move.node)])};
    const double before = shrunk_;
    make(move);
    made.saved = static_cast<float>(shrunk_ - before);
    record_move(*steps_, made);
  }

  void set_area(uint32_t place, float area) {
    shrunk_ += double(areas_[place]) - double(area);
    areas_[place] = area;
  }

  void put(uint32_t place, const BvhNode& node) {
    nodes_[place] = node;
    set_area(place, half_area(box_of(node)));
    if (!is_leaf(node)) parents_[node.first] = parents_[node.first + 1] = place;
  }

  // An inner node and those above it, as far as that changes them.
  void refit(uint32_t node) {
    for (bool changed = true; changed; node = parents_[node]) {
      const Box old = box_of(nodes_[node]);
      const uint32_t child = nodes_[node].first;
      const Box box = united(box_of(nodes_[child]), box_of(nodes_[child + 1]));
      changed = node != 0 && (box.lo != old.lo || box.hi != old.hi);
      nodes_[node].lo = box.lo;
      nodes_[node].hi = box.hi;
      set_area(node, half_area(box));
    }
  }

  float share_;                      // of the nodes that move in a round
  BuildSteps* steps_;                // nullptr: not recorded
  uint32_t round_ = 0, gained_ = 0;  // the present one, and the last with a move
  double shrunk_ = 0.0;              // the sum of all areas, since the begin
  decltype(Bvh::nodes) nodes_;
  std::vector<uint32_t> parents_;
  std::vector<uint32_t> awake_;  // from which round on
  std::vector<float> areas_;
};

}  // namespace

void reinsert(Bvh& bvh, const BuildOptions& options, BuildLog* log, const std::stop_token& stop) {
  if (bvh.nodes.size() < 7) return;
  Optimizer optimizer(bvh, options.reinsertion_share, log != nullptr ? log->steps : nullptr);
  const uint32_t rounds = options.reinsertion_rounds;
  for (uint32_t round = 0; round < rounds && !stop.stop_requested(); ++round) {
    if (!optimizer.round()) break;
    if (log) log->optimized += bvh.references.size() / rounds;
  }
  bvh = depth_first(optimizer.nodes(), bvh.references);
}

}  // namespace tracer
