// Quality measures of a BVH, and what its rays cost.
#include "tracer/analyze/quality.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <tbb/parallel_for.h>

namespace tracer {
namespace {

void add_to(std::vector<uint64_t>& histogram, uint32_t index) {
  if (index >= histogram.size()) histogram.resize(index + 1);
  ++histogram[index];
}

void add_to(std::vector<uint64_t>& histogram, const std::vector<uint64_t>& other) {
  if (other.size() > histogram.size()) histogram.resize(other.size());
  for (size_t i = 0; i < other.size(); ++i)
    histogram[i] += other[i];
}

uint64_t bytes_of(const Bvh& bvh) {
  return bvh.nodes.size() * sizeof(BvhNode) + bvh.references.size() * sizeof(uint32_t);
}

// A double keeps the products of extents up to 1e19 apart from infinity.
double half_area(const BvhNode& node) {
  const glm::dvec3 e = glm::dvec3(node.hi) - glm::dvec3(node.lo);
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

// Exact, by nearest rank. Bits of floats that are not negative sort like the floats, so the upper
// halves say in which bucket each rank lies, and only that bucket has to be sorted.
class RankedSamples {
 public:
  explicit RankedSamples(std::vector<float> samples)
      : samples_(std::move(samples)), buckets_(65536) {
    for (const float sample : samples_)
      ++buckets_[bucket_of(sample)];
  }

  float percentile(double percent) const {
    const double rank = std::ceil(percent / 100.0 * double(samples_.size()));
    uint64_t below = uint64_t(std::max(rank, 1.0)) - 1;  // samples before the one asked for
    uint32_t bucket = 0;
    while (below >= buckets_[bucket])
      below -= buckets_[bucket++];
    std::vector<float> inside;
    inside.reserve(buckets_[bucket]);
    for (const float sample : samples_) {
      if (bucket_of(sample) == bucket) inside.push_back(sample);
    }
    std::nth_element(inside.begin(), inside.begin() + ptrdiff_t(below), inside.end());
    return inside[below];
  }

 private:
  static uint32_t bucket_of(float sample) { return std::bit_cast<uint32_t>(sample) >> 16; }

  std::vector<float> samples_;
  std::vector<uint64_t> buckets_;
};

// Calls `visit(counters)` for every sample of the film, of one class.
template <class Visit>
void for_each_counters(const Film& film, int ray_class, const Visit& visit) {
  for (const std::shared_ptr<const FilmTile>& tile : film.tiles) {
    if (!tile || !tile->facts) continue;
    for (const ClassCounters& counters : tile->facts->counters)
      visit(counters[ray_class]);
  }
}

Percentiles percentiles(const Film& film, int ray_class, uint32_t Counters::*counter) {
  std::vector<float> samples;
  uint64_t rays = 0;
  uint64_t total = 0;
  for_each_counters(film, ray_class, [&](const Counters& counters) {
    if (counters.rays == 0) return;
    rays += counters.rays;
    total += counters.*counter;
    samples.push_back(float(counters.*counter) / float(counters.rays));
  });
  if (samples.empty()) return {};
  Percentiles result;
  result.mean = double(total) / double(rays);
  result.max = *std::max_element(samples.begin(), samples.end());
  const RankedSamples ranked(std::move(samples));
  result.p50 = ranked.percentile(50.0);
  result.p95 = ranked.percentile(95.0);
  result.p99 = ranked.percentile(99.0);
  return result;
}

}  // namespace

TreeStatistics statistics(const Bvh& bvh, float traversal_cost, float intersection_cost) {
  TreeStatistics result;
  result.traversal_cost = traversal_cost;
  result.intersection_cost = intersection_cost;
  result.nodes = bvh.nodes.size();
  result.references = bvh.references.size();
  result.bytes = bytes_of(bvh);
  if (bvh.nodes.empty()) return result;
  // Every primitive is in some leaf, those cut by spatial splits in several.
  result.primitives = uint64_t(*std::max_element(bvh.references.begin(), bvh.references.end())) + 1;

  // A root without area (one point or a line) would divide by zero: every ray that enters it then
  // enters all of it.
  const double root_area = half_area(bvh.nodes[0]);
  std::vector<uint8_t> depth(bvh.nodes.size(), 0);
  double inner_areas = 0.0;
  double leaf_areas = 0.0;  // each times its references
  uint64_t sum_of_depths = 0;
  for (size_t i = 0; i < bvh.nodes.size(); ++i) {
    const BvhNode& node = bvh.nodes[i];
    const double relative_area = root_area > 0.0 ? half_area(node) / root_area : 1.0;
    if (!is_leaf(node)) {
      inner_areas += relative_area;
      depth[node.first] = depth[node.first + 1] = uint8_t(depth[i] + 1);
      continue;
    }
    leaf_areas += relative_area * node.count;
    ++result.leaves;
    sum_of_depths += depth[i];
    result.max_depth = std::max(result.max_depth, uint32_t(depth[i]));
    result.max_leaf_size = std::max(result.max_leaf_size, node.count);
    add_to(result.leaf_size_histogram, node.count);
    add_to(result.leaf_depth_histogram, depth[i]);
  }
  result.mean_leaf_depth = double(sum_of_depths) / double(result.leaves);
  result.sah = inner_areas * traversal_cost + leaf_areas * intersection_cost;
  return result;
}

TreeStatistics blas_statistics(const SceneBvh& bvh) {
  std::vector<TreeStatistics> each(bvh.blases.size());
  tbb::parallel_for(size_t(0), each.size(), [&](size_t i) {
    each[i] =
        statistics(bvh.blases[i]->tree, bvh.options.traversal_cost, bvh.options.intersection_cost);
    each[i].bytes = bytes(*bvh.blases[i]);
  });
  TreeStatistics all;
  all.traversal_cost = bvh.options.traversal_cost;
  all.intersection_cost = bvh.options.intersection_cost;
  double sum_of_depths = 0.0;
  double weighted_sah = 0.0;
  for (const TreeStatistics& blas : each) {
    all.nodes += blas.nodes;
    all.leaves += blas.leaves;
    all.references += blas.references;
    all.primitives += blas.primitives;
    all.bytes += blas.bytes;
    all.max_depth = std::max(all.max_depth, blas.max_depth);
    all.max_leaf_size = std::max(all.max_leaf_size, blas.max_leaf_size);
    add_to(all.leaf_size_histogram, blas.leaf_size_histogram);
    add_to(all.leaf_depth_histogram, blas.leaf_depth_histogram);
    sum_of_depths += blas.mean_leaf_depth * double(blas.leaves);
    weighted_sah += blas.sah * double(blas.primitives);
  }
  if (all.leaves > 0) all.mean_leaf_depth = sum_of_depths / double(all.leaves);
  if (all.primitives > 0) all.sah = weighted_sah / double(all.primitives);
  return all;
}

TreeStatistics tlas_statistics(const SceneBvh& bvh) {
  return statistics(bvh.tlas, bvh.options.traversal_cost, bvh.options.intersection_cost);
}

std::array<RayStatistics, ray_class_count> ray_statistics(const Film& film) {
  struct Kind {
    uint32_t Counters::*counter;
    Percentiles RayStatistics::*result;
  };
  constexpr std::array<Kind, 4> kinds = {{{&Counters::nodes, &RayStatistics::nodes},
                                          {&Counters::leaves, &RayStatistics::leaves},
                                          {&Counters::triangles, &RayStatistics::triangles},
                                          {&Counters::instances, &RayStatistics::instances}}};
  std::array<RayStatistics, ray_class_count> all{};
  tbb::parallel_for(0, int(kinds.size()) * ray_class_count, [&](int i) {
    const Kind& kind = kinds[i % kinds.size()];
    const int ray_class = i / int(kinds.size());
    all[ray_class].*kind.result = percentiles(film, ray_class, kind.counter);
  });
  for (int i = 0; i < ray_class_count; ++i) {
    for_each_counters(film, i, [&](const Counters& counters) { all[i].count += counters.rays; });
  }
  return all;
}

}  // namespace tracer
