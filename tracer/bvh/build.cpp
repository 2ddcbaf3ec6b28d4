// The table of builders and the way into them.
#include "tracer/bvh/build.h"

#include <fmt/format.h>

#include "tracer/bvh/build_binned.h"
#include "tracer/choice.h"
#include "tracer/error.h"

namespace tracer {

namespace {

constexpr BuilderRow rows[] = {
    {"binned", "Binned SAH",
     "Sorts the centroids into bins on each axis and takes the plane between two bins with the "
     "lowest SAH cost. The usual compromise of build time and tree quality.",
     "I. Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, 2007", build_binned},
};

template <class Value>
void check_range(std::string_view option, Value value, Value lo, Value hi) {
  // Written so that NaN is outside.
  if (!(value >= lo && value <= hi)) {
    throw Error(fmt::format("{} {} is outside {}..{}", option, value, lo, hi));
  }
}

}  // namespace

std::span<const BuilderRow> builders() {
  return rows;
}

void check(const BuildOptions& options) {
  if (!find_row(builders(), options.builder)) {
    throw Error(fmt::format("unknown builder '{}'; known builders: {}", options.builder,
                            known_ids(builders())));
  }
  check_range("bins", options.bins, 2u, max_bins);
  check_range("leaf size", options.max_leaf_size, 1u, max_leaf_references);
  check_range("depth limit", options.max_depth, 1u, max_tree_depth);
  check_range("traversal cost", options.traversal_cost, min_cost, max_cost);
  check_range("intersection cost", options.intersection_cost, min_cost, max_cost);
}

Bvh build(const BuildInput& input, const BuildOptions& options, BuildLog* log,
          std::stop_token stop) {
  check(options);
  if (input.boxes.empty()) return {};
  Bvh bvh = find_row(builders(), options.builder)->build(input, options, log, stop);
  if (stop.stop_requested()) return {};
  return bvh;
}

}  // namespace tracer
