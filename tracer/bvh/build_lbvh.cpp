// Linear BVH: primitives along a Morton curve, split where the codes' highest bit changes
// (C. Lauterbach et al., Fast BVH Construction on GPUs, 2009; T. Karras, Maximizing Parallelism in
// the Construction of BVHs, Octrees, and k-d Trees, 2012). Where we differ: 63-bit codes, and equal
// codes are halved.
#include <bit>

#include "tracer/bvh/builders.h"
#include "tracer/bvh/morton.h"
#include "tracer/bvh/tree_edit.h"

namespace tracer {

namespace {

class Builder {
 public:
  Builder(const BuildInput& input, const BuildOptions& options, BuildLog* log, std::stop_token stop)
      : boxes_(input.boxes),
        options_(options),
        log_(log),
        stop_(std::move(stop)),
        codes_(morton_order(references_of(input))) {}

  Bvh build() {
    const auto count = static_cast<uint32_t>(codes_.size());
    bvh_.nodes.resize(2 * size_t{count} - 1);
    bvh_.references.resize(count);
    for_chunks(0, count, [&](size_t, uint32_t begin, uint32_t end) {
      for (uint32_t i = begin; i < end; ++i)
        bvh_.references[i] = codes_[i].primitive;
    });
    bvh_.depth = split(0, 0, count, 1, 0);
    // Large leaves at the depth limit leave gaps.
    if (bvh_.depth == options_.max_depth) return depth_first(bvh_.nodes, bvh_.references);
    return std::move(bvh_);
  }

 private:
  // Makes `node` of the codes [begin, end). Below it is room for 2 (end - begin - 1) nodes from
  // `room` on, in depth-first order. Returns the depth of its deepest leaf.
  uint32_t split(uint32_t node, uint32_t begin, uint32_t end, uint32_t room, uint32_t depth) {
    const uint32_t count = end - begin;
    if (count == 1 || depth >= options_.max_depth || stop_.stop_requested()) {
      make_leaf(bvh_.nodes[node], begin, end);
      return depth;
    }
    const bool must_halve = options_.max_depth - depth <= std::bit_width(count);
    const uint32_t middle = must_halve ? begin + count / 2 : first_change(codes_, begin, end);
    const uint32_t right_room = room + 2 * (middle - begin);
    uint32_t left_depth = 0, right_depth = 0;
    const auto left = [&] { left_depth = split(room, begin, middle, room + 2, depth + 1); };
    const auto right = [&] { right_depth = split(room + 1, middle, end, right_room, depth + 1); };
    run_both(count, left, right);
    const Box box = united(box_of(bvh_.nodes[room]), box_of(bvh_.nodes[room + 1]));
    bvh_.nodes[node] = {box.lo, room, box.hi, 0};
    return std::max(left_depth, right_depth);
  }

  void make_leaf(BvhNode& node, uint32_t begin, uint32_t end) const {
    Box box;
    for (uint32_t i = begin; i < end; ++i)
      box = united(box, boxes_[codes_[i].primitive]);
    node = {box.lo, begin, box.hi, end - begin};
    if (log_) log_->placed += end - begin;
  }

  std::span<const Box> boxes_;
  const BuildOptions& options_;
  BuildLog* log_;
  std::stop_token stop_;
  std::vector<MortonCode> codes_;
  Bvh bvh_;
};

}  // namespace

Bvh build_lbvh(const BuildInput& input, const BuildOptions& options, BuildLog* log,
               std::stop_token stop) {
  return Builder(input, options, log, std::move(stop)).build();
}

}  // namespace tracer
