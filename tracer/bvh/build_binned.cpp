// Binned SAH builder (I. Wald, On fast Construction of SAH-based Bounding Volume Hierarchies,
// 2007). Where we differ: the number of bins shrinks with the node (4 + n/20, as Embree does), all
// three axes are tried, and a node whose centroids cannot be told apart is halved in its present
// order.
//
// Parallel in two steps, neither of which depends on the number of threads: the top of the tree is
// split node by node with parallel passes over the references, until the parts are small; then each
// part becomes a subtree of its own, built by one thread, and the subtrees are joined in order.
#include "tracer/bvh/build_binned.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>

#include <tbb/parallel_for.h>

#include "tracer/math/simd.h"

namespace tracer {

namespace {

constexpr size_t chunk_size = 16384;         // references a parallel pass hands to one task
constexpr uint32_t min_parallel = 1u << 16;  // smaller nodes are one task
constexpr uint32_t parts_wanted = 64;        // of a large tree, so that threads stay busy

// A primitive while the tree is built. The fourth lanes are free: lo carries the primitive's index.
struct Reference {
  float4 lo, hi;
};

uint32_t primitive(const Reference& reference) {
  return std::bit_cast<uint32_t>(reference.lo[3]);
}
// Twice the centroid: spares a multiplication.
float4 centroid2(const Reference& reference) {
  return reference.lo + reference.hi;
}

struct Bounds {
  float4 lo = broadcast(infinity);
  float4 hi = broadcast(-infinity);

  void grow(float4 other_lo, float4 other_hi) {
    lo = min(lo, other_lo);
    hi = max(hi, other_hi);
  }
  void grow(const Bounds& other) { grow(other.lo, other.hi); }
};

float half_area(const Bounds& bounds) {
  const float4 e = bounds.hi - bounds.lo;
  return e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
}

// References [begin, end) with their bounds and those of their (doubled) centroids.
struct Range {
  uint32_t begin = 0, end = 0;
  Bounds box, centroids;

  uint32_t size() const { return end - begin; }
};

void add(Range& range, const Reference& reference) {
  range.box.grow(reference.lo, reference.hi);
  const float4 c = centroid2(reference);
  range.centroids.grow(c, c);
}

// Maps a centroid to its bin on each axis.
struct Binning {
  float4 offset, scale;
  uint32_t bins;

  Binning(const Range& range, uint32_t bin_count) : offset(range.centroids.lo), bins(bin_count) {
    const float4 size = range.centroids.hi - range.centroids.lo;
    for (int axis = 0; axis < 3; ++axis) {
      const float s = static_cast<float>(bins) * 0.99999f / size[axis];
      scale[axis] = std::isfinite(s) ? s : 0.0f;  // flat axis: everything in bin 0
    }
    // The index in the fourth lane may be a denormal, which is slow to multiply: make it -1.
    offset[3] = 1.0f;
    scale[3] = 0.0f;
  }
  int4 bins_of(const Reference& reference) const {
    return __builtin_convertvector((centroid2(reference) - offset) * scale, int4);
  }
};

struct Bin {
  Bounds box;
  uint32_t count = 0;
};
struct Histogram {
  std::array<std::array<Bin, max_bins>, 3> axes;

  void clear(uint32_t bins) {
    for (auto& axis : axes)
      std::fill_n(axis.begin(), bins, Bin{});
  }
  void add(const Binning& binning, std::span<const Reference> references) {
    for (const Reference& reference : references) {
      const int4 index = binning.bins_of(reference);
      for (int axis = 0; axis < 3; ++axis) {
        Bin& bin = axes[axis][index[axis]];
        bin.box.grow(reference.lo, reference.hi);
        ++bin.count;
      }
    }
  }
  void add(const Histogram& other, uint32_t bins) {
    for (int axis = 0; axis < 3; ++axis) {
      for (uint32_t i = 0; i < bins; ++i) {
        axes[axis][i].box.grow(other.axes[axis][i].box);
        axes[axis][i].count += other.axes[axis][i].count;
      }
    }
  }
};

struct Split {
  int axis = -1;          // -1: no plane has references on both sides
  uint32_t plane = 0;     // bins below it go left
  float cost = infinity;  // sum of area * count of both sides
};

Split best_split(const Histogram& histogram, uint32_t bins) {
  Split best;
  std::array<float, max_bins> right_cost;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& row = histogram.axes[axis];
    Bounds box;
    uint32_t count = 0;
    for (uint32_t i = bins - 1; i > 0; --i) {
      box.grow(row[i].box);
      count += row[i].count;
      right_cost[i] = count > 0 ? half_area(box) * static_cast<float>(count) : infinity;
    }
    box = {};
    count = 0;
    for (uint32_t i = 1; i < bins; ++i) {
      box.grow(row[i - 1].box);
      count += row[i - 1].count;
      if (count == 0) continue;
      const float cost = half_area(box) * static_cast<float>(count) + right_cost[i];
      if (cost < best.cost) best = {axis, i, cost};
    }
  }
  return best;
}

struct Halves {
  Range left, right;
};

class Builder {
 public:
  Builder(const BuildInput& input, const BuildOptions& options, BuildLog* log, std::stop_token stop)
      : options_(options), log_(log), stop_(std::move(stop)), references_(input.boxes.size()) {
    for_chunks({0, static_cast<uint32_t>(input.boxes.size()), {}, {}}, [&](size_t, uint32_t begin,
                                                                           uint32_t end) {
      for (uint32_t i = begin; i < end; ++i) {
        const Box& box = input.boxes[i];
        references_[i].lo = float4{box.lo.x, box.lo.y, box.lo.z, std::bit_cast<float>(i)};
        references_[i].hi = float4{box.hi.x, box.hi.y, box.hi.z, 0.0f};
      }
    });
  }

  Bvh build();

 private:
  // A node still to be split, or a part for one thread: where it stands in which node vector.
  struct Task {
    Range range;
    uint32_t node;
    uint32_t depth;
  };
  // What one thread needs again and again.
  struct Scratch {
    Histogram histogram;
    std::vector<Task> stack;
  };

  template <class Function>
  void for_chunks(const Range& range, const Function& function) const;
  Range measured(uint32_t begin, uint32_t end) const;
  Split find_split(const Range& range, uint32_t bins, Scratch& scratch) const;
  bool split(const Range& range, uint32_t depth, Scratch& scratch, Halves& halves);
  Halves partition(const Range& range, const Binning& binning, const Split& split);
  Halves partition_parallel(const Range& range, const Binning& binning, const Split& split);
  void make_leaf(BvhNode& node, const Range& range) const;
  uint32_t build_subtree(const Task& root, std::vector<BvhNode>& nodes, Scratch& scratch);

  const BuildOptions& options_;
  BuildLog* log_;
  std::stop_token stop_;
  std::vector<Reference> references_;
  std::vector<Reference> moved_;  // target of the parallel partition
};

// function(chunk, begin, end) for consecutive pieces of the range, in parallel.
template <class Function>
void Builder::for_chunks(const Range& range, const Function& function) const {
  const size_t chunks = (range.size() + chunk_size - 1) / chunk_size;
  tbb::parallel_for(size_t{0}, chunks, [&](size_t chunk) {
    const uint32_t begin = range.begin + static_cast<uint32_t>(chunk * chunk_size);
    function(chunk, begin, std::min<uint32_t>(range.end, begin + chunk_size));
  });
}

Range Builder::measured(uint32_t begin, uint32_t end) const {
  Range whole{begin, end, {}, {}};
  std::vector<Range> pieces((whole.size() + chunk_size - 1) / chunk_size);
  for_chunks(whole, [&](size_t chunk, uint32_t from, uint32_t to) {
    for (uint32_t i = from; i < to; ++i)
      add(pieces[chunk], references_[i]);
  });
  for (const Range& piece : pieces) {
    whole.box.grow(piece.box);
    whole.centroids.grow(piece.centroids);
  }
  return whole;
}

Split Builder::find_split(const Range& range, uint32_t bins, Scratch& scratch) const {
  const Binning binning(range, bins);
  scratch.histogram.clear(bins);
  const std::span<const Reference> all(references_);
  if (range.size() < min_parallel) {
    scratch.histogram.add(binning, all.subspan(range.begin, range.size()));
  } else {
    std::vector<Histogram> pieces((range.size() + chunk_size - 1) / chunk_size);
    for_chunks(range, [&](size_t chunk, uint32_t begin, uint32_t end) {
      pieces[chunk].clear(bins);
      pieces[chunk].add(binning, all.subspan(begin, end - begin));
    });
    for (const Histogram& piece : pieces)
      scratch.histogram.add(piece, bins);
  }
  return best_split(scratch.histogram, bins);
}

Halves Builder::partition(const Range& range, const Binning& binning, const Split& split) {
  const int plane = static_cast<int>(split.plane);
  Halves halves;
  uint32_t left = range.begin;
  uint32_t right = range.end;
  while (left < right) {
    if (binning.bins_of(references_[left])[split.axis] < plane) {
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
Halves Builder::partition_parallel(const Range& range, const Binning& binning, const Split& split) {
  const int plane = static_cast<int>(split.plane);
  const size_t chunks = (range.size() + chunk_size - 1) / chunk_size;
  std::vector<uint32_t> left_counts(chunks);
  for_chunks(range, [&](size_t chunk, uint32_t begin, uint32_t end) {
    uint32_t count = 0;
    for (uint32_t i = begin; i < end; ++i) {
      count += binning.bins_of(references_[i])[split.axis] < plane ? 1u : 0u;
    }
    left_counts[chunk] = count;
  });
  std::vector<uint32_t> left_begin(chunks);
  uint32_t middle = range.begin;
  for (size_t chunk = 0; chunk < chunks; ++chunk) {
    left_begin[chunk] = middle;
    middle += left_counts[chunk];
  }

  moved_.resize(references_.size());
  std::vector<Halves> pieces(chunks);
  for_chunks(range, [&](size_t chunk, uint32_t begin, uint32_t end) {
    Halves piece;
    uint32_t left = left_begin[chunk];
    uint32_t right = middle + (begin - range.begin) - (left - range.begin);
    for (uint32_t i = begin; i < end; ++i) {
      const Reference& reference = references_[i];
      const bool goes_left = binning.bins_of(reference)[split.axis] < plane;
      add(goes_left ? piece.left : piece.right, reference);
      moved_[goes_left ? left++ : right++] = reference;
    }
    pieces[chunk] = piece;
  });
  for_chunks(range, [&](size_t, uint32_t begin, uint32_t end) {
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

// False: the range is to be a leaf.
bool Builder::split(const Range& range, uint32_t depth, Scratch& scratch, Halves& halves) {
  const uint32_t count = range.size();
  if (count <= 1 || depth >= options_.max_depth) return false;

  // Close to the depth limit only halving still ends in small leaves.
  const bool must_halve = options_.max_depth - depth <= std::bit_width(count);
  if (!must_halve) {
    const uint32_t bins = std::min(options_.bins, 4 + count / 20);
    const Split best = find_split(range, bins, scratch);
    const float area = half_area(range.box);
    const float leaf_cost = options_.intersection_cost * static_cast<float>(count) * area;
    const float split_cost =
        options_.traversal_cost * area + options_.intersection_cost * best.cost;
    if (count <= options_.max_leaf_size && !(split_cost < leaf_cost)) return false;
    if (best.axis >= 0) {
      const Binning binning(range, bins);
      halves = count < min_parallel ? partition(range, binning, best)
                                    : partition_parallel(range, binning, best);
      return true;
    }
  }
  if (count <= options_.max_leaf_size) return false;
  const uint32_t middle = range.begin + count / 2;
  halves = {measured(range.begin, middle), measured(middle, range.end)};
  return true;
}

void Builder::make_leaf(BvhNode& node, const Range& range) const {
  node.first = range.begin;
  node.count = range.size();
  if (log_) log_->placed += range.size();
}

void set_box(BvhNode& node, const Bounds& box) {
  node.lo = xyz(box.lo);
  node.hi = xyz(box.hi);
}

// Appends the subtree below root to `nodes`, whose entry root.node is there already. Returns the
// depth of its deepest leaf.
uint32_t Builder::build_subtree(const Task& root, std::vector<BvhNode>& nodes, Scratch& scratch) {
  uint32_t deepest = 0;
  scratch.stack.assign(1, root);
  while (!scratch.stack.empty() && !stop_.stop_requested()) {
    const Task task = scratch.stack.back();
    scratch.stack.pop_back();
    set_box(nodes[task.node], task.range.box);
    Halves halves;
    if (!split(task.range, task.depth, scratch, halves)) {
      make_leaf(nodes[task.node], task.range);
      deepest = std::max(deepest, task.depth);
      continue;
    }
    const auto child = static_cast<uint32_t>(nodes.size());
    nodes[task.node].first = child;
    nodes.resize(nodes.size() + 2);
    scratch.stack.push_back({halves.right, child + 1, task.depth + 1});
    scratch.stack.push_back({halves.left, child, task.depth + 1});
  }
  return deepest;
}

Bvh Builder::build() {
  Bvh bvh;
  const auto count = static_cast<uint32_t>(references_.size());
  const uint32_t part_size = std::max(min_parallel / 4, count / parts_wanted);

  // The top of the tree, breadth first; what is small enough becomes a part.
  std::vector<Task> parts;
  std::vector<Task> queue{{measured(0, count), 0, 0}};
  bvh.nodes.resize(1);
  Scratch scratch;
  for (size_t i = 0; i < queue.size() && !stop_.stop_requested(); ++i) {
    const Task task = queue[i];
    if (task.range.size() <= part_size) {
      parts.push_back(task);
      continue;
    }
    set_box(bvh.nodes[task.node], task.range.box);
    Halves halves;
    if (!split(task.range, task.depth, scratch, halves)) {
      make_leaf(bvh.nodes[task.node], task.range);
      bvh.depth = std::max(bvh.depth, task.depth);
      continue;
    }
    const auto child = static_cast<uint32_t>(bvh.nodes.size());
    bvh.nodes[task.node].first = child;
    bvh.nodes.resize(bvh.nodes.size() + 2);
    queue.push_back({halves.left, child, task.depth + 1});
    queue.push_back({halves.right, child + 1, task.depth + 1});
  }

  struct Subtree {
    std::vector<BvhNode> nodes;  // its root is entry 0
    uint32_t depth = 0;
  };
  std::vector<Subtree> subtrees(parts.size());
  tbb::parallel_for(size_t{0}, parts.size(), [&](size_t i) {
    Scratch own;
    Task root = parts[i];
    root.node = 0;
    subtrees[i].nodes.reserve(root.range.size());
    subtrees[i].nodes.resize(1);
    subtrees[i].depth = build_subtree(root, subtrees[i].nodes, own);
  });
  if (stop_.stop_requested()) return {};

  // Entry k > 0 of a subtree becomes node base + k - 1; its root takes the place kept for it.
  std::vector<uint32_t> base(parts.size());
  auto total = static_cast<uint32_t>(bvh.nodes.size());
  for (size_t i = 0; i < parts.size(); ++i) {
    base[i] = total;
    total += static_cast<uint32_t>(subtrees[i].nodes.size()) - 1;
    bvh.depth = std::max(bvh.depth, subtrees[i].depth);
  }
  bvh.nodes.resize(total);
  bvh.references.resize(count);
  tbb::parallel_for(size_t{0}, parts.size(), [&](size_t i) {
    const auto& nodes = subtrees[i].nodes;
    for (size_t k = 0; k < nodes.size(); ++k) {
      BvhNode node = nodes[k];
      if (!is_leaf(node)) node.first += base[i] - 1;
      bvh.nodes[k == 0 ? parts[i].node : base[i] + k - 1] = node;
    }
  });
  for_chunks({0, count, {}, {}}, [&](size_t, uint32_t begin, uint32_t end) {
    for (uint32_t i = begin; i < end; ++i)
      bvh.references[i] = primitive(references_[i]);
  });
  return bvh;
}

}  // namespace

Bvh build_binned(const BuildInput& input, const BuildOptions& options, BuildLog* log,
                 std::stop_token stop) {
  return Builder(input, options, log, std::move(stop)).build();
}

}  // namespace tracer
