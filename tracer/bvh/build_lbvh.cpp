// Linear BVH: primitives along a Morton curve, split where the codes' highest bit changes
// (C. Lauterbach et al., Fast BVH Construction on GPUs, 2009; T. Karras, Maximizing Parallelism in
// the Construction of BVHs, Octrees, and k-d Trees, 2012). One walk along the codes makes a tree
// from the leaves up, as C. Apetrei, Fast and Simple Agglomerative LBVH Construction, 2014. Where
// we differ: 63-bit codes; subtrees that SAH would rather have as leaves are dropped at once.
#include <array>
#include <bit>

#include <tbb/enumerable_thread_specific.h>

#include "tracer/bvh/builders.h"
#include "tracer/bvh/morton.h"
#include "tracer/bvh/subtrees.h"

namespace tracer {

namespace {

// Nodes of a subtree, made from the last one to the first; parents come before their children, and
// name them by their distance from the end.
class BackwardNodes {
 public:
  explicit BackwardNodes(size_t most) : nodes_(most) {}

  size_t size() const { return size_; }
  void drop_to(size_t size) { size_ = size; }
  uint32_t add(const BvhNode& left, const BvhNode& right) {
    size_ += 2;
    nodes_[nodes_.size() - size_] = left;
    nodes_[nodes_.size() - size_ + 1] = right;
    return static_cast<uint32_t>(size_);
  }
  // The root first.
  void copy_to(std::vector<BvhNode>& to, const BvhNode& root) const {
    to.reserve(size_ + 1);
    to.push_back(root);
    to.insert(to.end(), nodes_.end() - ptrdiff_t(size_), nodes_.end());
    for (BvhNode& node : to)
      if (!is_leaf(node)) node.first = static_cast<uint32_t>(to.size()) - node.first;
  }

 private:
  UntouchedVector<BvhNode> nodes_;
  size_t size_ = 0;
};

class Builder {
 public:
  Builder(const BuildInput& input, const BuildOptions& options, BuildLog* log, std::stop_token stop)
      : boxes_(input.boxes),
        options_(options),
        log_(log),
        stop_(std::move(stop)),
        collapse_(options.collapse && options.optimizer == "none"),
        codes_(morton_order(input.boxes)) {}

  Bvh build() {
    const auto count = static_cast<uint32_t>(codes_.size());
    const uint32_t part_size = part_size_of(count);
    // The top of the tree, breadth first; what is small enough becomes a part.
    struct Part {
      uint32_t begin, end, node, depth;
    };
    Bvh bvh;
    bvh.nodes.resize(1, BvhNode{});
    std::vector<Part> queue{{0, count, 0, 0}}, parts;
    std::vector<uint32_t> places;
    for (size_t i = 0; i < queue.size(); ++i) {
      const Part part = queue[i];
      if (part.end - part.begin <= part_size) {
        parts.push_back(part);
        places.push_back(part.node);
        continue;
      }
      const uint32_t middle = first_change(codes_, part.begin, part.end);
      const auto pair = static_cast<uint32_t>(bvh.nodes.size());
      bvh.nodes[part.node].first = pair;
      bvh.nodes.resize(bvh.nodes.size() + 2, BvhNode{});
      queue.push_back({part.begin, middle, pair, part.depth + 1});
      queue.push_back({middle, part.end, pair + 1, part.depth + 1});
    }
    const size_t top_nodes = bvh.nodes.size();
    std::vector<Subtree> subtrees(parts.size());
    tbb::enumerable_thread_specific<BackwardNodes> buffers(2 * size_t{std::min(part_size, count)});
    tbb::parallel_for(size_t{0}, parts.size(), [&](size_t i) {
      if (stop_.stop_requested()) return;
      const Part& part = parts[i];
      subtrees[i] = subtree_over(part.begin, part.end, buffers.local());
      subtrees[i].depth += part.depth;
      if (log_) log_->placed += part.end - part.begin;
    });
    if (stop_.stop_requested()) return {};
    join(bvh, places, subtrees);
    for (size_t i = top_nodes; i-- > 0;) {
      BvhNode& node = bvh.nodes[i];
      if (is_leaf(node)) continue;
      const Box box = united(box_of(bvh.nodes[node.first]), box_of(bvh.nodes[node.first + 1]));
      node.lo = box.lo;
      node.hi = box.hi;
    }
    return bvh;
  }

 private:
  // A subtree without a parent yet.
  struct Open {
    Bounds box;
    float cost = 0.0f;        // SAH, times the area of the root
    uint32_t first = 0;       // reference
    uint32_t count = 1;       // of references
    uint32_t pair = 0;        // the children, from the end of the nodes; 0: a leaf
    uint32_t depth = 0;       // of its deepest leaf, from here
    size_t nodes_before = 0;  // there were without its own
    int level = 0;            // to its left neighbour
  };
  static constexpr int most_levels = 64 + 32;  // bits of a code and of a place

  // Neighbours of a low level are merged first.
  int level_between(uint32_t left, uint32_t right) const {
    const uint64_t differ = codes_[left].code ^ codes_[right].code;
    return differ != 0 ? 32 + std::bit_width(differ) : std::bit_width(left ^ right);
  }

  Subtree subtree_over(uint32_t begin, uint32_t end, BackwardNodes& nodes) const {
    nodes.drop_to(0);
    std::array<Open, most_levels + 1> open;  // from right to left, levels fall
    size_t waiting = 0;
    for (uint32_t i = end; i-- > begin;) {
      constexpr uint32_t ahead = 8;
      if (i >= begin + ahead) __builtin_prefetch(&boxes_[codes_[i - ahead].primitive]);
      Open here = single(i, i - begin, nodes.size());
      here.level = i > begin ? level_between(i - 1, i) : most_levels;
      while (waiting > 0 && open[waiting - 1].level < here.level)
        merge(here, open[--waiting], nodes);
      open[waiting++] = here;
    }
    Subtree subtree;
    nodes.copy_to(subtree.nodes, node_of(open[0]));
    subtree.depth = open[0].depth;
    subtree.references.reserve(end - begin);
    for (uint32_t i = begin; i < end; ++i)
      subtree.references.push_back(codes_[i].primitive);
    return subtree;
  }

  Open single(uint32_t i, uint32_t reference, size_t nodes_before) const {
    const Box& box = boxes_[codes_[i].primitive];
    Open leaf;
    leaf.box = {float4{box.lo.x, box.lo.y, box.lo.z, 0.0f},
                float4{box.hi.x, box.hi.y, box.hi.z, 0.0f}};
    leaf.cost = leaf_cost(options_, 1, half_area(leaf.box));
    leaf.first = reference;
    leaf.nodes_before = nodes_before;
    return leaf;
  }

  static BvhNode node_of(const Open& subtree) {
    const bool leaf = subtree.pair == 0;
    return {xyz(subtree.box.lo), leaf ? subtree.first : subtree.pair, xyz(subtree.box.hi),
            leaf ? subtree.count : 0};
  }

  // Their parent takes the place of the left one; a leaf where SAH would rather have that.
  void merge(Open& left, const Open& right, BackwardNodes& nodes) const {
    Open parent = left;
    parent.box.grow(right.box);
    parent.count += right.count;
    parent.nodes_before = right.nodes_before;
    const float area = half_area(parent.box);
    const float as_leaf = leaf_cost(options_, parent.count, area);
    parent.cost = options_.traversal_cost * area + left.cost + right.cost;
    if (collapse_ && parent.count <= options_.max_leaf_size && as_leaf <= parent.cost) {
      nodes.drop_to(parent.nodes_before);
      parent.cost = as_leaf;
      parent.pair = parent.depth = 0;
    } else {
      parent.pair = nodes.add(node_of(left), node_of(right));
      parent.depth = 1 + std::max(left.depth, right.depth);
    }
    left = parent;
  }

  std::span<const Box> boxes_;
  const BuildOptions& options_;
  BuildLog* log_;
  std::stop_token stop_;
  bool collapse_;
  UntouchedVector<MortonCode> codes_;
};

}  // namespace

Bvh build_lbvh(const BuildInput& input, const BuildOptions& options, BuildLog* log,
               std::stop_token stop) {
  return Builder(input, options, log, std::move(stop)).build();
}

}  // namespace tracer
