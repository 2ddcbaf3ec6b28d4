// What a build did, step by step: recorded where somebody asks for it (BuildLog::steps), and the
// same whatever the number of threads.
#pragma once

#include <span>
#include <vector>

#include "tracer/bvh/build.h"

namespace tracer {

// A subtree put elsewhere. Boxes are those before the step.
struct TreeMove {
  Box moved;
  Box beside;          // its new sibling; of a rotation what it changes places with
  Box left;            // the sibling that it leaves
  float saved = 0.0f;  // by how much the sum of half areas of inner nodes has shrunk
};

struct BuildSteps {
  // The tree as the builder left it: before the optimizer, before subtrees became leaves and before
  // the depth was limited. In depth-first order.
  std::vector<BvhNode> nodes;
  std::vector<uint32_t> order;  // its inner nodes, as they were made
  // How many of them there were after each round, if there are rounds in which many are made at
  // once: those are in the order of the curve.
  std::vector<uint32_t> rounds;

  std::vector<TreeMove> moves;        // of the optimizer
  std::vector<uint32_t> move_rounds;  // how many there were after each of its rounds
  uint64_t moves_left_out = 0;        // that came after most_moves
  bool finished_later = false;        // leaves were made after that, or the depth was limited
};

inline constexpr size_t most_moves = 1'000'000;  // recorded, 76 bytes each

// Of a builder that merges: `tree` is the depth-first order of `made`, whose siblings were merged
// in the order of `pairs` (the left one of each).
void record_merges(BuildSteps& steps, const Bvh& tree, std::span<const BvhNode> made,
                   std::span<const uint32_t> pairs);

// Of one that splits: a node before what is below it, the left side first, as one thread goes.
void record_splits(BuildSteps& steps, const Bvh& tree);

void record_move(BuildSteps& steps, const TreeMove& move);

}  // namespace tracer
