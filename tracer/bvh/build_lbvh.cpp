// Linear BVH: primitives along a Morton curve, split where the codes' highest bit changes
// (C. Lauterbach et al., Fast BVH Construction on GPUs, 2009; T. Karras, Maximizing Parallelism in
// the Construction of BVHs, Octrees, and k-d Trees, 2012). Where we differ: 63-bit codes, and equal
// codes are halved; subtrees that SAH would rather have as leaves are dropped at once.
#include <bit>

#include "tracer/bvh/builders.h"
#include "tracer/bvh/morton.h"
#include "tracer/bvh/subtrees.h"

namespace tracer {

namespace {

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
      if (part.end - part.begin <= part_size || part.depth >= options_.max_depth) {
        parts.push_back(part);
        places.push_back(part.node);
        continue;
      }
      const uint32_t middle = split_at(part.begin, part.end, part.depth);
      const auto pair = static_cast<uint32_t>(bvh.nodes.size());
      bvh.nodes[part.node].first = pair;
      bvh.nodes.resize(bvh.nodes.size() + 2, BvhNode{});
      queue.push_back({part.begin, middle, pair, part.depth + 1});
      queue.push_back({middle, part.end, pair + 1, part.depth + 1});
    }
    const size_t top_nodes = bvh.nodes.size();
    std::vector<Subtree> subtrees(parts.size());
    tbb::parallel_for(size_t{0}, parts.size(), [&](size_t i) {
      Subtree& subtree = subtrees[i];
      subtree.nodes.reserve(parts[i].end - parts[i].begin);
      subtree.references.reserve(parts[i].end - parts[i].begin);
      subtree.nodes.resize(1);
      subtree.depth = split(subtree, 0, parts[i].begin, parts[i].end, parts[i].depth).depth;
      if (log_) log_->placed += parts[i].end - parts[i].begin;
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
  uint32_t split_at(uint32_t begin, uint32_t end, uint32_t depth) const {
    const uint32_t count = end - begin;
    const bool must_halve = options_.max_depth - depth <= std::bit_width(count);
    return must_halve ? begin + count / 2 : first_change(codes_, begin, end);
  }

  struct Done {
    float cost = 0.0f;   // SAH of the subtree, times the area of the root
    uint32_t depth = 0;  // of its deepest leaf
  };

  // Makes `node` of the codes [begin, end) and appends what is below it. Where SAH would rather
  // have a leaf, the subtree is dropped again.
  Done split(Subtree& out, uint32_t node, uint32_t begin, uint32_t end, uint32_t depth) {
    const uint32_t count = end - begin;
    if (count == 1 || depth >= options_.max_depth || stop_.stop_requested()) {
      Box box;
      for (uint32_t i = begin; i < end; ++i)
        box = united(box, boxes_[codes_[i].primitive]);
      make_leaf(out, node, box, begin, end);
      return {leaf_cost(options_, count, half_area(box)), depth};
    }
    if (count == 2 && collapse_ && options_.max_leaf_size >= 2) {
      // Half of all subtrees: no nodes are made to be dropped again.
      const Box &left = boxes_[codes_[begin].primitive],
                &right = boxes_[codes_[begin + 1].primitive];
      const Box box = united(left, right);
      const float as_leaf = leaf_cost(options_, 2, half_area(box));
      const float children = half_area(left) + half_area(right);
      if (as_leaf <= split_cost(options_, half_area(box), children)) {
        make_leaf(out, node, box, begin, end);
        return {as_leaf, depth};
      }
    }
    const uint32_t middle = split_at(begin, end, depth);
    const auto pair = static_cast<uint32_t>(out.nodes.size());
    const auto first_reference = static_cast<uint32_t>(out.references.size());
    out.nodes.resize(out.nodes.size() + 2);
    const Done left = split(out, pair, begin, middle, depth + 1);
    const Done right = split(out, pair + 1, middle, end, depth + 1);
    const Box box = united(box_of(out.nodes[pair]), box_of(out.nodes[pair + 1]));
    const float area = half_area(box);
    const float cost = options_.traversal_cost * area + left.cost + right.cost;
    const float as_leaf = leaf_cost(options_, count, area);
    if (collapse_ && count <= options_.max_leaf_size && as_leaf <= cost) {
      out.nodes.resize(pair);
      out.nodes[node] = {box.lo, first_reference, box.hi, count};
      return {as_leaf, depth};
    }
    out.nodes[node] = {box.lo, pair, box.hi, 0};
    return {cost, std::max(left.depth, right.depth)};
  }

  void make_leaf(Subtree& out, uint32_t node, const Box& box, uint32_t begin, uint32_t end) const {
    out.nodes[node] = {box.lo, static_cast<uint32_t>(out.references.size()), box.hi, end - begin};
    for (uint32_t i = begin; i < end; ++i)
      out.references.push_back(codes_[i].primitive);
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
