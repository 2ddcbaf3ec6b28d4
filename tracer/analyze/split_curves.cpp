// One node's split candidates.
#include "tracer/analyze/split_curves.h"

#include <algorithm>
#include <limits>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_sort.h>

#include "tracer/analyze/split_node.h"
#include "tracer/analyze/tree_split.h"
#include "tracer/bvh/spatial_binning.h"

namespace tracer {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Centroids in order, and what a split costs before each: the sum of area * count of both sides.
struct Order {
  std::vector<float> centroids;  // doubled
  std::vector<double> costs;     // [0] has nothing on its left

  Order(const SplitNode& node, int axis) {
    struct Place {
      float at;
      uint32_t reference;
      bool operator<(const Place& other) const {
        return at != other.at ? at < other.at : reference < other.reference;
      }
    };
    const uint32_t count = node.range.size();
    std::vector<Place> places(count);
    for (uint32_t i = 0; i < count; ++i)
      places[i] = {centroid2(node.references[i])[axis], i};
    tbb::parallel_sort(places.begin(), places.end());
    centroids.resize(count);
    costs.assign(count, unknown);
    Bounds box;
    for (uint32_t i = count; i-- > 0;) {
      const Reference& reference = node.references[places[i].reference];
      centroids[i] = places[i].at;
      box.grow(reference.lo, reference.hi);
      if (i > 0) costs[i] = double(half_area(box)) * double(count - i);
    }
    box = {};
    for (uint32_t i = 1; i < count; ++i) {
      const Reference& reference = node.references[places[i - 1].reference];
      box.grow(reference.lo, reference.hi);
      costs[i] += double(half_area(box)) * double(i);
    }
  }

  uint32_t size() const { return uint32_t(centroids.size()); }
  uint32_t rank_of(float centroid) const {
    return uint32_t(std::lower_bound(centroids.begin(), centroids.end(), centroid) -
                    centroids.begin());
  }
  uint32_t cheapest() const {
    return uint32_t(std::min_element(costs.begin() + 1, costs.end()) - costs.begin());
  }
  SplitChoice choice(std::string_view id, const SplitNode& node, int axis, uint32_t rank) const {
    const double at = 0.25 * (double(centroids[rank - 1]) + double(centroids[rank]));
    return {id, false, axis, false, at, node.cost(costs[rank]), rank, size() - rank};
  }
};

SplitChoice midpoint(const Order& order, const SplitNode& node, int axis) {
  const float lo = node.range.centroids.lo[axis], hi = node.range.centroids.hi[axis];
  const float plane = lo + 0.5f * (hi - lo);
  const uint32_t rank = order.rank_of(plane);
  const bool halves = rank == 0 || rank == order.size();
  SplitChoice choice = order.choice("midpoint", node, axis, halves ? order.size() / 2 : rank);
  if (!halves) choice.at = 0.5 * double(plane);
  choice.leaf = order.size() <= node.options.max_leaf_size;
  return choice;
}

SplitChoice median(const Order& order, const SplitNode& node, int axis) {
  SplitChoice choice = order.choice("median", node, axis, order.size() / 2);
  choice.leaf = order.size() <= node.options.max_leaf_size;
  return choice;
}

// Of bins: the cost of a plane between two, and what is on its sides.
SplitChoice binned_choice(std::string_view id, const SplitNode& node, const Histogram& histogram,
                          const Binning& binning, const ObjectSplit& split) {
  SplitChoice choice;
  choice.id = id;
  choice.cost = unknown;
  if (split.axis >= 0) {
    choice.axis = split.axis;
    const double bin = double(split.plane) / double(binning.scale[split.axis]);
    choice.at = 0.5 * (double(binning.offset[split.axis]) + bin);
    choice.cost = node.cost(double(split.cost));
    for (uint32_t i = 0; i < split.plane; ++i)
      choice.left += histogram.axes[split.axis][i].count;
    choice.right = node.range.size() - choice.left;
  }
  choice.leaf = node.rather_leaf(choice.cost);
  return choice;
}

SplitChoice binned(const SplitNode& node) {
  const auto histogram = std::make_unique<Histogram>();
  const Binning binning(node.range, bins_for(node.range.size(), node.options));
  fill(*histogram, binning, node.range, node.references);
  return binned_choice("binned", node, *histogram, binning, best_split(*histogram, binning.bins));
}

template <uint32_t most>
std::unique_ptr<SpatialHistogram<most>> in_slabs(const SplitNode& node, const Slabs& slabs,
                                                 const Job& job) {
  using Slabbed = SpatialHistogram<most>;
  tbb::enumerable_thread_specific<std::unique_ptr<Slabbed>> threads;
  for_chunks(0, node.range.size(), [&](size_t, uint32_t begin, uint32_t end) {
    if (job.stopped()) return;
    std::unique_ptr<Slabbed>& own = threads.local();
    if (!own) {
      own = std::make_unique<Slabbed>();
      own->clear(slabs);
    }
    for (uint32_t i = begin; i < end; ++i) {
      const uint32_t triangle = primitive_of(node.input, i);
      own->add(slabs, node.references[i], corners_of(*node.input.mesh, triangle));
    }
  });
  auto all = std::make_unique<Slabbed>();
  all->clear(slabs);
  for (const std::unique_ptr<Slabbed>& own : threads)
    all->add(slabs, *own);
  return all;
}

// Its budget for more references counts as unspent.
SplitChoice sbvh(const SplitNode& node, const Bounds& root, const Job& job) {
  const uint32_t count = node.range.size();
  const auto histogram = std::make_unique<Histogram>();
  const Binning binning(node.range, std::min(node.options.bins, 4 + count / 10));
  fill(*histogram, binning, node.range, node.references);
  const ObjectSplit objects = best_split(*histogram, binning.bins);
  SplitChoice choice = binned_choice("sbvh", node, *histogram, binning, objects);
  if (node.input.mesh == nullptr) return choice;
  const float least = std::max(node.options.min_overlap * half_area(root),
                               min_space_overlap * half_area(node.range.box));
  if (!(overlap_area(*histogram, binning.bins, objects) > least)) return choice;
  const double budget =
      double(node.options.split_budget) * double(node.input.mesh->triangles.size());
  const Slabs slabs(node.range.box, slabs_for(count));
  const SpatialSplit space =
      in_slabs<max_slabs>(node, slabs, job)->best(slabs, count, uint32_t(std::min(budget, 4e9)));
  if (!(space.cost < min_space_gain * objects.cost)) return choice;
  const double cost = node.cost(double(space.cost));
  return {"sbvh", node.rather_leaf(cost), space.axis,       true, double(space.at),
          cost,   space.left_count,       space.right_count};
}

// Costs at the planes between slabs.
std::vector<double> space_costs(const SplitNode& node, std::span<const Slab> row, uint32_t slabs) {
  std::vector<double> costs(slabs - 1, unknown);
  Bounds box;
  uint32_t count = 0;
  for (uint32_t i = slabs - 1; i > 0; --i) {
    box.grow(row[i].box);
    count += row[i].ends;
    if (count > 0) costs[i - 1] = double(half_area(box)) * double(count);
  }
  box = {};
  count = 0;
  for (uint32_t i = 1; i < slabs; ++i) {
    box.grow(row[i - 1].box);
    count += row[i - 1].begins;
    const double left = count > 0 ? double(half_area(box)) * double(count) : unknown;
    costs[i - 1] = node.cost(costs[i - 1] + left);
  }
  return costs;
}

SplitCurve curve_of(const Order& order, const Slabs& slabs, const SplitNode& node, int axis) {
  SplitCurve curve;
  if (slabs.per_width[axis] == 0.0f) return curve;
  for (uint32_t i = 1; i < slabs.count; ++i) {
    const float at = slabs.plane(axis, i);
    const uint32_t rank = order.rank_of(2.0f * at);
    const bool both = rank > 0 && rank < order.size();
    curve.at.push_back(double(at));
    curve.objects.push_back(both ? node.cost(order.costs[rank]) : unknown);
  }
  return curve;
}

SplitChoice lesser(const SplitChoice& a, const SplitChoice& b) {
  return b.cost < a.cost ? b : a;
}

}  // namespace

NodeSplits node_splits(const Scene& scene, std::shared_ptr<const SceneBvh> bvh,
                       const TreeTable& table, uint32_t mesh, uint32_t node_id, const Job& job) {
  job.progress(0.0f, "collecting what is below the node");
  const NodeParts parts = parts_below(scene, *bvh, table, mesh, node_id);
  SplitNode node{bvh->options, {parts.boxes, nullptr, parts.primitives}, {}, {}, 0.0};
  if (mesh != none) node.input.mesh = &scene.meshes[mesh];
  node.references = references_of(node.input);
  node.range = measured(node.references, 0, uint32_t(node.references.size()));
  node.area = double(half_area(node.range.box));

  NodeSplits result;
  result.mesh = mesh;
  result.node = node_id;
  result.references = node.range.size();
  result.max_leaf_size = node.options.max_leaf_size;
  result.leaf_cost = double(node.options.intersection_cost) * double(result.references);
  result.tree = tree_split(table, node_id, node);
  if (result.references < 2) {
    result.bvh = std::move(bvh);
    return result;
  }
  const Slabs slabs(node.range.box, split_places + 1);
  const int longest = longest_axis(node.range.centroids);
  SplitChoice sweep, in_the_middle, halves;
  for (int axis = 0; axis < 3 && !job.stopped(); ++axis) {
    job.progress(0.2f + 0.2f * float(axis), "sweeping planes");
    const Order order(node, axis);
    const SplitChoice best = order.choice("sweep", node, axis, order.cheapest());
    sweep = axis == 0 ? best : lesser(sweep, best);
    result.axes[axis] = curve_of(order, slabs, node, axis);
    if (axis != longest) continue;
    in_the_middle = midpoint(order, node, axis);
    halves = median(order, node, axis);
  }
  sweep.leaf = node.rather_leaf(sweep.cost);
  result.builders = {in_the_middle, halves, binned(node), sweep,
                     sbvh(node, as_bounds(table.nodes[0].box), job)};
  if (mesh != none) {
    job.progress(0.8f, "cutting triangles");
    const auto histogram = in_slabs<split_places + 1>(node, slabs, job);
    for (int axis = 0; axis < 3; ++axis) {
      if (result.axes[axis].at.empty()) continue;
      result.axes[axis].space = space_costs(node, histogram->axis(axis), slabs.count);
    }
  }
  if (!job.stopped()) result.bvh = std::move(bvh);
  return result;
}

}  // namespace tracer
