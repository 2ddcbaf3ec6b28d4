// Approximate agglomerative clustering (Y. Gu, Y. He, K. Fatahalian, G. Blelloch, Efficient BVH
// Construction via Approximate Agglomerative Clustering, 2013): a tree over the Morton curve says
// which clusters may meet; bottom-up, the two whose common box is smallest are merged until few
// enough are left for the next level. Where we differ: up to `exact` primitives all may meet, which
// is the agglomerative clustering of B. Walter et al., Fast Agglomerative Clustering for Rendering,
// 2008.
#include <atomic>
#include <cmath>

#include "tracer/bvh/build_steps.h"
#include "tracer/bvh/builders.h"
#include "tracer/bvh/morton.h"
#include "tracer/bvh/tree_edit.h"

namespace tracer {

namespace {

constexpr uint32_t exact = 1024;
// The paper's settings for quality: primitives of a leaf of the Morton tree, and the exponent that
// says how many clusters a subtree passes on.
constexpr uint32_t delta = 20;
constexpr float epsilon = 0.1f;

uint32_t clusters_kept(uint32_t count) {
  const float factor = 0.5f * std::pow(static_cast<float>(delta), 0.5f + epsilon);
  const float kept = factor * std::pow(static_cast<float>(count), 0.5f - epsilon);
  return std::max(static_cast<uint32_t>(kept), 1u);
}

// A node that has no parent yet, and what would be the best partner for it.
struct Cluster {
  BvhNode node;
  uint32_t primitives = 1;
  uint32_t nearest = 0;
  float area = infinity;  // half, of the box of both
  uint32_t both = 0;      // primitives of both: of equal areas the smaller cluster is nearer
};
using Clusters = std::vector<Cluster>;

uint32_t distance(uint32_t a, uint32_t b) {
  return a < b ? b - a : a - b;
}

// Of equally good ones the next in the list: were all equal boxes nearest to the same one, each
// merge would send all of them searching again.
void consider(Clusters& clusters, uint32_t of, uint32_t other) {
  Cluster& cluster = clusters[of];
  const float area = half_area(united(box_of(cluster.node), box_of(clusters[other].node)));
  const uint32_t both = cluster.primitives + clusters[other].primitives;
  if (area > cluster.area) return;
  if (area == cluster.area) {
    if (both > cluster.both) return;
    if (both == cluster.both && distance(of, other) >= distance(of, cluster.nearest)) return;
  }
  cluster.area = area;
  cluster.both = both;
  cluster.nearest = other;
}

void find_nearest(Clusters& clusters, uint32_t of) {
  clusters[of].area = infinity;
  clusters[of].both = none;
  for (uint32_t i = 0; i < clusters.size(); ++i) {
    if (i != of) consider(clusters, of, i);
  }
}

uint32_t closest_pair(const Clusters& clusters) {
  uint32_t best = 0;
  for (uint32_t i = 1; i < clusters.size(); ++i) {
    const Cluster &a = clusters[i], &b = clusters[best];
    if (a.area < b.area || (a.area == b.area && a.both < b.both)) best = i;
  }
  return best;
}

class Builder {
 public:
  Builder(const BuildInput& input, BuildLog* log, std::stop_token stop)
      : boxes_(input.boxes),
        log_(log),
        steps_(log != nullptr ? log->steps : nullptr),
        stop_(std::move(stop)),
        codes_(morton_order(input.boxes)),
        nodes_(2 * codes_.size() - 1),
        references_(codes_.size()),
        leaf_size_(codes_.size() <= exact ? exact : delta) {
    for (size_t i = 0; i < codes_.size(); ++i)
      references_[i] = codes_[i].primitive;
  }

  Bvh build() {
    Clusters all = clusters_of(0, static_cast<uint32_t>(codes_.size()));
    merge(all, 1);
    if (stop_.stop_requested()) return {};
    nodes_[0] = all[0].node;
    Bvh bvh = depth_first(nodes_, references_);
    if (steps_ != nullptr) {
      std::vector<uint32_t> pairs;
      for (uint32_t pair = 1; pair < nodes_.size(); pair += 2)
        pairs.push_back(pair);
      record_merges(*steps_, bvh, nodes_, pairs);
    }
    return bvh;
  }

 private:
  Clusters clusters_of(uint32_t begin, uint32_t end) {
    const uint32_t count = end - begin;
    Clusters clusters;
    if (count <= leaf_size_ || stop_.stop_requested()) {
      for (uint32_t i = begin; i < end; ++i) {
        const Box& box = boxes_[references_[i]];
        clusters.push_back({.node = {box.lo, i, box.hi, 1}});
      }
      if (log_) log_->placed += count;
    } else {
      const uint32_t middle = first_change(codes_, begin, end);
      Clusters right;
      const auto take_left = [&] { clusters = clusters_of(begin, middle); };
      const auto take_right = [&] { right = clusters_of(middle, end); };
      if (steps_ != nullptr) {
        take_left();  // one after the other: pairs are numbered as they are merged
        take_right();
      } else {
        run_both(count, take_left, take_right);
      }
      clusters.insert(clusters.end(), right.begin(), right.end());
    }
    merge(clusters, clusters_kept(count));
    return clusters;
  }

  void merge(Clusters& clusters, uint32_t wanted) {
    if (clusters.size() <= wanted) return;
    for (uint32_t i = 0; i < clusters.size(); ++i)
      find_nearest(clusters, i);
    while (clusters.size() > wanted && !stop_.stop_requested()) {
      const uint32_t from = closest_pair(clusters);
      const uint32_t a = std::min(from, clusters[from].nearest);
      const uint32_t b = std::max(from, clusters[from].nearest);
      // Pairs may take any place: depth_first orders them by the tree alone.
      const uint32_t pair = next_pair_.fetch_add(2);
      nodes_[pair] = clusters[a].node;
      nodes_[pair + 1] = clusters[b].node;
      const Box box = united(box_of(clusters[a].node), box_of(clusters[b].node));
      clusters[a] = {.node = {box.lo, pair, box.hi, 0},
                     .primitives = clusters[a].primitives + clusters[b].primitives};
      const auto last = static_cast<uint32_t>(clusters.size()) - 1;
      if (b != last) clusters[b] = clusters[last];
      clusters.pop_back();
      if (clusters.size() == 1) return;
      find_nearest(clusters, a);
      for (uint32_t i = 0; i < clusters.size(); ++i) {
        if (i == a) continue;
        uint32_t& nearest = clusters[i].nearest;
        if (nearest == a || nearest == b) {
          find_nearest(clusters, i);
        } else {
          if (nearest == last) nearest = b;
          consider(clusters, i, a);
        }
      }
    }
  }

  std::span<const Box> boxes_;
  BuildLog* log_;
  BuildSteps* steps_;
  std::stop_token stop_;
  UntouchedVector<MortonCode> codes_;
  std::vector<BvhNode> nodes_;
  std::vector<uint32_t> references_;
  uint32_t leaf_size_;  // of the Morton tree
  std::atomic<uint32_t> next_pair_{1};
};

}  // namespace

Bvh build_agglomerative(const BuildInput& input, const BuildOptions&, BuildLog* log,
                        std::stop_token stop) {
  return Builder(input, log, std::move(stop)).build();
}

}  // namespace tracer
