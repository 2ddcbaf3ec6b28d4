// The way from the root to the leaves that several builders share: a splitter says what becomes of
// a range of references, the rest is here.
//
// Parallel in two steps, neither of which depends on the number of threads: the top of the tree is
// split level by level, its nodes side by side and the large ones with parallel passes over their
// references, until the parts are small; then each part becomes a subtree of its own, built by one
// thread, and the subtrees are joined in order.
#pragma once

#include <algorithm>
#include <bit>
#include <cassert>
#include <optional>
#include <span>
#include <vector>

#include <tbb/parallel_for.h>

#include "tracer/bvh/build_parts.h"
#include "tracer/bvh/subtrees.h"

namespace tracer {

// What becomes of a range. Side is a function of a reference: whether it goes to the left. `clip`
// splits in space, not between references.
enum class DecisionKind { leaf, split, halve, clip };
template <class Side>
struct Decision {
  DecisionKind kind = DecisionKind::leaf;
  Side side{};    // of a split
  int axis = -1;  // of halving: by the centroids on this axis; -1: in the present order
};

// A splitter has
//   Side     the type of its decisions
//   Scratch  what one thread needs again and again
//   Decision<Side> decide(const Range&, std::span<const Reference> all, Scratch&) const
// It is asked about ranges of two references and more. A split that leaves one side empty is
// halved. A splitter that decides to clip has also
//   uint32_t spare(uint32_t references) const    how many references it may add, altogether
//   void clip(const Range&, std::span<const Reference> all, Scratch&) const
//            fills left and right of the scratch; may add range.spare references
template <class Splitter>
concept Clips = requires(const Splitter& splitter) {
  splitter.spare(1u);
};

template <class Splitter>
class TopDown {
 public:
  TopDown(const BuildInput& input, const BuildOptions& options, BuildLog* log, std::stop_token stop,
          Splitter splitter)
      : options_(options),
        log_(log),
        stop_(std::move(stop)),
        splitter_(std::move(splitter)),
        references_(references_of(input)) {
    root_ = measured(references_, 0, static_cast<uint32_t>(references_.size()));
    if constexpr (Clips<Splitter>) root_.spare = splitter_.spare(root_.size());
    references_.resize(references_.size() + root_.spare);
    if (root_.size() >= min_parallel) moved_.resize(references_.size());
  }

  Bvh build();

 private:
  using Side = typename Splitter::Side;
  struct Halves {
    Range left, right;
  };
  // A node still to be split, or a part for one thread: where it stands in which node vector.
  struct Task {
    Range range;
    uint32_t node;
    uint32_t depth;
  };
  struct Scratch {
    typename Splitter::Scratch splitter;
    std::vector<Task> stack;
  };

  bool split(const Range& range, uint32_t depth, Scratch& scratch, Halves& halves);
  Halves halved(const Range& range, int axis);
  Halves partition(const Range& range, const Side& side);
  Halves partition_parallel(const Range& range, const Side& side);
  Halves clipped(const Range& range, const typename Splitter::Scratch& pieces);
  void share_spare(const Range& range, Halves& halves);
  void make_leaf(BvhNode& node, const Range& range, std::vector<uint32_t>& placed) const;
  std::vector<Task> build_top(Bvh& bvh);
  void build_subtree(const Task& root, Subtree& subtree, Scratch& scratch);

  const BuildOptions& options_;
  BuildLog* log_;
  std::stop_token stop_;
  Splitter splitter_;
  UntouchedVector<Reference> references_;
  Range root_;
  UntouchedVector<Reference> moved_;  // target of the parallel partition
};

template <class Splitter>
auto TopDown<Splitter>::partition(const Range& range, const Side& side) -> Halves {
  Halves halves;
  uint32_t left = range.begin;
  uint32_t right = range.end;
  while (left < right) {
    if (side(references_[left])) {
      add(halves.left, references_[left++]);
    } else {
      std::swap(references_[left], references_[--right]);
      add(halves.right, references_[right]);
    }
  }
  halves.left.begin = range.begin;
  halves.left.end = halves.right.begin = left;
  halves.right.end = range.end;
  return halves;
}

// Stable: each chunk knows from the counts of those before it where its references go.
template <class Splitter>
auto TopDown<Splitter>::partition_parallel(const Range& range, const Side& side) -> Halves {
  const size_t chunks = (range.size() + chunk_size - 1) / chunk_size;
  std::vector<uint32_t> left_counts(chunks);
  for_chunks(range.begin, range.end, [&](size_t chunk, uint32_t begin, uint32_t end) {
    uint32_t count = 0;
    for (uint32_t i = begin; i < end; ++i) {
      count += side(references_[i]) ? 1u : 0u;
    }
    left_counts[chunk] = count;
  });
  std::vector<uint32_t> left_begin(chunks);
  uint32_t middle = range.begin;
  for (size_t chunk = 0; chunk < chunks; ++chunk) {
    left_begin[chunk] = middle;
    middle += left_counts[chunk];
  }

  std::vector<Halves> pieces(chunks);
  for_chunks(range.begin, range.end, [&](size_t chunk, uint32_t begin, uint32_t end) {
    Halves piece;
    uint32_t left = left_begin[chunk];
    uint32_t right = middle + (begin - range.begin) - (left - range.begin);
    for (uint32_t i = begin; i < end; ++i) {
      const Reference& reference = references_[i];
      const bool goes_left = side(reference);
      add(goes_left ? piece.left : piece.right, reference);
      moved_[goes_left ? left++ : right++] = reference;
    }
    pieces[chunk] = piece;
  });
  for_chunks(range.begin, range.end, [&](size_t, uint32_t begin, uint32_t end) {
    std::copy(moved_.begin() + begin, moved_.begin() + end, references_.begin() + begin);
  });

  Halves halves;
  halves.left.begin = range.begin;
  halves.left.end = halves.right.begin = middle;
  halves.right.end = range.end;
  for (const Halves& piece : pieces) {
    halves.left.box.grow(piece.left.box);
    halves.left.centroids.grow(piece.left.centroids);
    halves.right.box.grow(piece.right.box);
    halves.right.centroids.grow(piece.right.centroids);
  }
  return halves;
}

template <class Splitter>
auto TopDown<Splitter>::halved(const Range& range, int axis) -> Halves {
  const uint32_t middle = range.begin + range.size() / 2;
  if (axis >= 0) {
    const auto at = references_.begin();
    std::nth_element(at + range.begin, at + middle, at + range.end,
                     [axis](const Reference& a, const Reference& b) {
                       const float x = centroid2(a)[axis], y = centroid2(b)[axis];
                       return x != y ? x < y : primitive(a) < primitive(b);
                     });
  }
  return {measured(references_, range.begin, middle), measured(references_, middle, range.end)};
}

// The range's references are replaced by their pieces.
template <class Splitter>
auto TopDown<Splitter>::clipped(const Range& range, const typename Splitter::Scratch& pieces)
    -> Halves {
  const auto middle = range.begin + static_cast<uint32_t>(pieces.left.size());
  const auto end = middle + static_cast<uint32_t>(pieces.right.size());
  assert(end <= range.end + range.spare);
  std::copy(pieces.left.begin(), pieces.left.end(), references_.begin() + range.begin);
  std::copy(pieces.right.begin(), pieces.right.end(), references_.begin() + middle);
  return {measured(references_, range.begin, middle), measured(references_, middle, end)};
}

// What places are left go to both sides, by what they cost as leaves: the right one moves up.
template <class Splitter>
void TopDown<Splitter>::share_spare(const Range& range, Halves& halves) {
  const uint32_t used = halves.left.size() + halves.right.size();
  const uint32_t spare = range.size() + range.spare - used;
  if (spare == 0) return;
  Range& right = halves.right;
  const double left_cost = halves.left.size() * double{half_area(halves.left.box)};
  const double right_cost = right.size() * double{half_area(right.box)};
  const double left_share =
      left_cost + right_cost > 0.0 ? left_cost / (left_cost + right_cost) : 0.5;
  halves.left.spare = static_cast<uint32_t>(spare * left_share);
  right.spare = spare - halves.left.spare;
  const auto at = references_.begin();
  std::copy_backward(at + right.begin, at + right.end, at + right.end + halves.left.spare);
  right.begin += halves.left.spare;
  right.end += halves.left.spare;
}

// False: the range is to be a leaf.
template <class Splitter>
bool TopDown<Splitter>::split(const Range& range, uint32_t depth, Scratch& scratch,
                              Halves& halves) {
  const uint32_t count = range.size();
  if (count <= 1 || depth >= options_.max_depth) return false;
  // Close to the depth limit only halving still ends in small leaves.
  Decision<Side> decision{.kind = DecisionKind::halve};
  if (options_.max_depth - depth > std::bit_width(count)) {
    decision = splitter_.decide(range, references_, scratch.splitter);
    if (decision.kind == DecisionKind::leaf) return false;
  } else if (count <= options_.max_leaf_size) {
    return false;
  }
  if constexpr (Clips<Splitter>) {
    if (decision.kind == DecisionKind::clip) {
      splitter_.clip(range, references_, scratch.splitter);
      halves = clipped(range, scratch.splitter);
    }
  }
  if (decision.kind == DecisionKind::split) {
    halves = count < min_parallel ? partition(range, decision.side)
                                  : partition_parallel(range, decision.side);
    if (halves.left.size() == 0 || halves.right.size() == 0) decision.kind = DecisionKind::halve;
  }
  if (decision.kind == DecisionKind::halve) halves = halved(range, decision.axis);
  share_spare(range, halves);
  return true;
}

template <class Splitter>
void TopDown<Splitter>::make_leaf(BvhNode& node, const Range& range,
                                  std::vector<uint32_t>& placed) const {
  node.first = static_cast<uint32_t>(placed.size());
  node.count = range.size();
  for (uint32_t i = range.begin; i < range.end; ++i)
    placed.push_back(primitive(references_[i]));
  if (log_) log_->placed += range.size();
}

// Appends the subtree below root to subtree.nodes, whose entry root.node is there already.
template <class Splitter>
void TopDown<Splitter>::build_subtree(const Task& root, Subtree& subtree, Scratch& scratch) {
  std::vector<BvhNode>& nodes = subtree.nodes;
  scratch.stack.assign(1, root);
  while (!scratch.stack.empty() && !stop_.stop_requested()) {
    const Task task = scratch.stack.back();
    scratch.stack.pop_back();
    set_box(nodes[task.node], task.range.box);
    Halves halves;
    if (!split(task.range, task.depth, scratch, halves)) {
      make_leaf(nodes[task.node], task.range, subtree.references);
      subtree.depth = std::max(subtree.depth, task.depth);
      continue;
    }
    const auto child = static_cast<uint32_t>(nodes.size());
    nodes[task.node].first = child;
    nodes.resize(nodes.size() + 2);
    scratch.stack.push_back({halves.right, child + 1, task.depth + 1});
    scratch.stack.push_back({halves.left, child, task.depth + 1});
  }
}

// The top of the tree, level by level; what is small enough becomes a part.
template <class Splitter>
auto TopDown<Splitter>::build_top(Bvh& bvh) -> std::vector<Task> {
  const uint32_t part_size = part_size_of(root_.size());
  bvh.nodes.resize(1, BvhNode{});
  std::vector<Task> parts;
  std::vector<Task> level{{root_, 0, 0}};
  while (!level.empty()) {
    std::vector<Task> large;
    for (const Task& task : level)
      (task.range.size() <= part_size ? parts : large).push_back(task);
    std::vector<std::optional<Halves>> halves(large.size());
    tbb::parallel_for(size_t{0}, large.size(), [&](size_t i) {
      if (stop_.stop_requested()) return;
      Scratch own;
      if (Halves found; split(large[i].range, large[i].depth, own, found)) halves[i] = found;
    });
    if (stop_.stop_requested()) return {};
    level.clear();
    for (size_t i = 0; i < large.size(); ++i) {
      const Task& task = large[i];
      set_box(bvh.nodes[task.node], task.range.box);
      if (!halves[i]) {
        make_leaf(bvh.nodes[task.node], task.range, bvh.references);
        bvh.depth = std::max(bvh.depth, task.depth);
        continue;
      }
      const auto child = static_cast<uint32_t>(bvh.nodes.size());
      bvh.nodes[task.node].first = child;
      bvh.nodes.resize(bvh.nodes.size() + 2, BvhNode{});
      level.push_back({halves[i]->left, child, task.depth + 1});
      level.push_back({halves[i]->right, child + 1, task.depth + 1});
    }
  }
  return parts;
}

template <class Splitter>
Bvh TopDown<Splitter>::build() {
  Bvh bvh;
  const std::vector<Task> parts = build_top(bvh);

  std::vector<Subtree> subtrees(parts.size());
  tbb::parallel_for(
      size_t{0}, parts.size(),
      [&](size_t i) {
        Scratch own;
        Task root = parts[i];
        root.node = 0;
        subtrees[i].nodes.reserve(root.range.size());
        subtrees[i].nodes.resize(1);
        subtrees[i].references.reserve(root.range.size());
        build_subtree(root, subtrees[i], own);
      },
      tbb::simple_partitioner());
  if (stop_.stop_requested()) return {};

  std::vector<uint32_t> places;
  places.reserve(parts.size());
  for (const Task& part : parts)
    places.push_back(part.node);
  join(bvh, places, subtrees);
  return bvh;
}

}  // namespace tracer
