// A build, step by step: what the builder made in its own order, what the optimizer moved, and what
// the tree was worth on the way.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "tracer/bvh/build_steps.h"
#include "tracer/bvh/scene_bvh.h"
#include "tracer/progress.h"

namespace tracer {

enum class BuildStep { split, merge, reinsertion, rotation, finish };

struct Replay {
  std::shared_ptr<const SceneBvh> bvh;  // whose tree it is
  uint32_t mesh = none;                 // of the BLAS; none: the TLAS
  bool bottom_up = false;               // the builder merges boxes instead of splitting them
  // First one step for each of log.order, then one for each of log.moves, then perhaps one that
  // finishes the tree. All node ids are those of log.nodes.
  BuildSteps log;
  bool finishes = false;             // the last step leads to the tree of `bvh`
  std::vector<uint32_t> step_of;     // by node: the step that makes an inner one; none for a leaf
  std::vector<uint32_t> references;  // by node: below it
  std::vector<uint32_t> same;  // by node: the one of `bvh` with as much in the same box, or none
  std::vector<float> sah;      // before the first step and after each, in units of the costs
};

// Builds the tree again, with a log, where a builder or an optimizer does more than splitting;
// splits are read off the tree itself. `mesh`: what its BLAS was built over, unless a refit has
// changed it since; the TLAS needs none. Stopped: without a tree.
Replay replay_build(std::shared_ptr<const SceneBvh> bvh, uint32_t mesh, const Mesh* built_over,
                    const Job& job);

inline size_t step_count(const Replay& replay) {
  return replay.sah.size() - 1;
}

BuildStep kind_of(const Replay& replay, size_t step);

// The move of an optimizer's step; nullptr for the others.
const TreeMove* move_of(const Replay& replay, size_t step);

// The node that a builder's step has made; none for the others.
uint32_t node_of(const Replay& replay, size_t step);

// Round of the builder or the optimizer that a step belongs to, from 1 on, and how many there are;
// none of builders that have no rounds.
struct Round {
  uint32_t number = 0, of = 0;
};
std::optional<Round> round_of(const Replay& replay, size_t step);

// How many boxes there are after so many steps that still are to be split or merged: while the
// builder merges, those without a parent; else those that are not split.
uint32_t box_count(const Replay& replay, size_t steps);

// These boxes: at most `most`, those of the largest area first. In a large tree no more than the
// largest 10,000 nodes are looked below, so that it takes a few milliseconds: boxes that are too
// small to be seen may be missing.
std::vector<Box> boxes_after(const Replay& replay, size_t steps, size_t most);

// Of the tree's SAH: what the step has saved. Splitting a box saves its being one leaf; merging two
// saves half a Ct, since every ray tests each box that has no parent.
double gain_of(const Replay& replay, size_t step);

}  // namespace tracer
