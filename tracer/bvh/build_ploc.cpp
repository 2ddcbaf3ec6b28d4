// Parallel locally-ordered clustering (D. Meister, J. Bittner, Parallel Locally-Ordered Clustering
// for Bounding Volume Hierarchy Construction, 2018): clusters along a Morton curve look for the
// nearest one, in terms of the area of the common box, within a radius; mutual pairs are merged,
// until one is left.
#include <tbb/parallel_for.h>

#include "tracer/bvh/build_steps.h"
#include "tracer/bvh/builders.h"
#include "tracer/bvh/morton.h"
#include "tracer/bvh/tree_edit.h"

namespace tracer {

namespace {

constexpr uint32_t few = 64;  // a round that merges less than this part of the clusters is no use

// A node that has no parent yet.
using Clusters = std::vector<BvhNode>;

float area_of_both(const BvhNode& a, const BvhNode& b) {
  return half_area(united(box_of(a), box_of(b)));
}

// Of each cluster the one nearest to it. Of equally near ones the closest along the curve, then up
// and down by turns: both see it alike, so that equal boxes find partners all at once.
void find_nearest(const Clusters& clusters, uint32_t radius, std::vector<uint32_t>& nearest) {
  const auto count = static_cast<uint32_t>(clusters.size());
  for_chunks(0, count, [&](size_t, uint32_t begin, uint32_t end) {
    for (uint32_t i = begin; i < end; ++i) {
      float least = infinity;
      uint32_t best = 0;
      const auto consider = [&](uint32_t k) {
        const float area = area_of_both(clusters[i], clusters[k]);
        if (area >= least) return;
        least = area;
        best = k;
      };
      for (uint32_t step = 1; step <= radius; ++step) {
        const bool up_first = (i / step & 1) == 0;
        const bool up = i + step < count, down = i >= step;
        if (up && up_first) consider(i + step);
        if (down) consider(i - step);
        if (up && !up_first) consider(i + step);
      }
      nearest[i] = best;
    }
  });
}

class Builder {
 public:
  Builder(const BuildInput& input, const BuildOptions& options, BuildLog* log, std::stop_token stop)
      : options_(options), log_(log), stop_(std::move(stop)) {
    const UntouchedVector<MortonCode> codes = morton_order(input.boxes);
    const auto count = static_cast<uint32_t>(codes.size());
    references_.resize(count);
    clusters_.resize(count);
    for_chunks(0, count, [&](size_t, uint32_t begin, uint32_t end) {
      for (uint32_t i = begin; i < end; ++i) {
        const Box& box = input.boxes[codes[i].primitive];
        references_[i] = codes[i].primitive;
        clusters_[i] = {box.lo, i, box.hi, 1};
      }
    });
    nodes_.resize(2 * size_t{count} - 1);
    free_ = count * 2 - 1;
  }

  Bvh build() {
    while (clusters_.size() > 1 && !stop_.stop_requested())
      merge();
    if (stop_.stop_requested()) return {};
    nodes_[0] = clusters_[0];
    if (log_) log_->placed += references_.size() - placed_;
    Bvh bvh = depth_first(nodes_, references_);
    if (log_ && log_->steps) record(*log_->steps, bvh);
    return bvh;
  }

 private:
  // The first pair is the last one in nodes_.
  void record(BuildSteps& steps, const Bvh& bvh) const {
    std::vector<uint32_t> pairs;
    for (size_t pair = nodes_.size(); pair >= 3;)
      pairs.push_back(static_cast<uint32_t>(pair -= 2));
    record_merges(steps, bvh, nodes_, pairs);
  }

  // One round. Children are stored behind their parents, from the last node on.
  void merge() {
    const auto count = static_cast<uint32_t>(clusters_.size());
    nearest_.resize(count);
    find_nearest(clusters_, options_.search_radius, nearest_);
    const size_t chunks = (count + chunk_size - 1) / chunk_size;
    struct Counts {
      uint32_t merged = 0, kept = 0;
    };
    std::vector<Counts> counts(chunks);
    const auto is_merged = [&](uint32_t i) { return nearest_[nearest_[i]] == i; };
    const auto count_all = [&] {
      for_chunks(0, count, [&](size_t chunk, uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
          const bool merged = is_merged(i);
          if (merged && i < nearest_[i]) ++counts[chunk].merged;
          if (!merged || i < nearest_[i]) ++counts[chunk].kept;
        }
      });
      Counts sum;
      for (Counts& chunk : counts) {
        const Counts before = sum;
        sum.merged += chunk.merged;
        sum.kept += chunk.kept;
        chunk = before;
      }
      return sum;
    };
    Counts sum = count_all();
    if (sum.merged < count / few) {
      // Boxes inside boxes: each wants the next smaller one, and only the smallest are mutual.
      for (uint32_t i = 0; i < count; ++i)
        nearest_[i] = (i ^ 1) < count ? i ^ 1 : i - 1;
      std::fill(counts.begin(), counts.end(), Counts{});
      sum = count_all();
    }
    kept_.resize(sum.kept);
    for_chunks(0, count, [&](size_t chunk, uint32_t begin, uint32_t end) {
      uint32_t pair = free_ - 2 * counts[chunk].merged;
      uint32_t place = counts[chunk].kept;
      for (uint32_t i = begin; i < end; ++i) {
        const uint32_t other = nearest_[i];
        if (!is_merged(i)) {
          kept_[place++] = clusters_[i];
        } else if (i < other) {
          pair -= 2;
          nodes_[pair] = clusters_[i];
          nodes_[pair + 1] = clusters_[other];
          const Box box = united(box_of(clusters_[i]), box_of(clusters_[other]));
          kept_[place++] = {box.lo, pair, box.hi, 0};
        }
      }
    });
    free_ -= 2 * sum.merged;
    clusters_.swap(kept_);
    const uint64_t placed = references_.size() - clusters_.size();
    if (log_) log_->placed += placed - placed_;
    if (log_ && log_->steps) log_->steps->rounds.push_back(static_cast<uint32_t>(placed));
    placed_ = placed;
  }

  const BuildOptions& options_;
  BuildLog* log_;
  std::stop_token stop_;
  std::vector<uint32_t> references_, nearest_;
  Clusters clusters_, kept_;
  std::vector<BvhNode> nodes_;
  uint32_t free_ = 0;  // nodes from here on are in use
  uint64_t placed_ = 0;
};

}  // namespace

Bvh build_ploc(const BuildInput& input, const BuildOptions& options, BuildLog* log,
               std::stop_token stop) {
  return Builder(input, options, log, std::move(stop)).build();
}

}  // namespace tracer
